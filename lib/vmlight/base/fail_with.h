// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight {

/// Reset `dst` and set its geterror() to `reason`, on one line. Returns false: `return fail_with(dst, "...");`
bool fail_with(OIIO::ImageBuf& dst, const std::string& reason);

} // namespace vmlight
