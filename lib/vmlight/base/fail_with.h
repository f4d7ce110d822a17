// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/base/text_format.h>

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight {

/// Reset `dst` and set its geterror() to `reason`, on one line. Returns false: `return fail_with(dst, "...");`
inline bool fail_with(OIIO::ImageBuf& dst, const std::string& reason)
{
    dst.reset();
    dst.errorfmt("{}", printable_line(reason));
    return false;
}

} // namespace vmlight
