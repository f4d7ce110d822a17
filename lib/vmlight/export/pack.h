// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/export/target.h>

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight {

/// Put occlusion into the channel that an engine reads it from.
///
/// @param dst          set to floats
/// @param occlusion    one channel
/// @param base         nullptr, or the texture whose other channels are kept
/// @returns false, with the reason in `error`, if `base` is of another size, or lacks the channel
bool pack_occlusion(OIIO::ImageBuf& dst, const OIIO::ImageBuf& occlusion, const OcclusionLayout& layout,
                    const OIIO::ImageBuf* base, std::string& error);

} // namespace vmlight
