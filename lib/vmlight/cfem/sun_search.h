// SPDX-License-Identifier: Apache-2.0
/// Where the suns of a small lat-long map are.
#pragma once

#include <vmlight/cfem/suns.h>

#include <OpenImageIO/imagebuf.h>

#include <vector>

namespace vmlight {

/// The cuts that take the suns out of `map`, a lat-long map of R, G, B floats in memory, the strongest first, and
/// of wide lights after them; each is found in what those before it leave. See SunSplit::find().
std::vector<SunSplit::Cut> search_suns(const OIIO::ImageBuf& map);

} // namespace vmlight
