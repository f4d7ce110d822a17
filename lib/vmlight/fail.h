// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight {

/// Leave `dst` without pixels, with `reason` in its geterror(). Returns false, for the caller to return.
inline bool fail(OIIO::ImageBuf& dst, const std::string& reason)
{
    dst.reset();
    dst.errorfmt("{}", reason);
    return false;
}

} // namespace vmlight
