// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/fail_with.h>

#include <vmlight/base/text_format.h>

namespace vmlight {

bool fail_with(OIIO::ImageBuf& dst, const std::string& reason)
{
    dst.reset();
    dst.errorfmt("{}", printable_line(reason));
    return false;
}

} // namespace vmlight
