// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/format_checks.h>

#include <OpenImageIO/strutil.h>

namespace vmlight {

bool is_stl(const FileHead& head)
{
    constexpr size_t kHeader = 80, kTriangle = 50; // bytes; a count of 4 bytes is between them
    OIIO::string_view text = first_text(head);
    if (OIIO::Strutil::parse_word(text) == "solid")
        return true;
    if (head.bytes.size() < kHeader + 4)
        return false;
    uint64_t count = 0;
    for (size_t i = 0; i < 4; ++i)
        count |= uint64_t(uint8_t(head.bytes[kHeader + i])) << (8 * i);
    return head.size == kHeader + 4 + kTriangle * count;
}

} // namespace vmlight
