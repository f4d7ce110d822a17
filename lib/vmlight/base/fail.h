// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/base/words.h>

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight {

/// Leave `dst` without pixels, with `reason`, made one line, in its geterror(). Returns false, for the caller to
/// return.
inline bool fail(OIIO::ImageBuf& dst, const std::string& reason)
{
    dst.reset();
    dst.errorfmt("{}", one_line(reason));
    return false;
}

} // namespace vmlight
