// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/text_format.h>

#include <vmlight/base/format.h>
#include <vmlight/base/utf8.h>

namespace vmlight {

std::string printable_line(OIIO::string_view text)
{
    std::string line;
    size_t count = 0;
    for (; !text.empty(); text.remove_prefix(count)) {
        uint32_t code = 0;
        count = decode_utf8(text, code);
        if (count == 0 || code < 0x20 || code == 0x7f) {
            line += format("\\x{:02x}", static_cast<unsigned char>(text[0]));
            count = 1;
        } else {
            line.append(text.data(), count);
        }
    }
    return line;
}

std::string shortened_line(OIIO::string_view reason)
{
    constexpr size_t kMaxBytes = 500;
    return printable_line(reason.substr(0, kMaxBytes)) + (reason.size() > kMaxBytes ? "..." : "");
}

} // namespace vmlight
