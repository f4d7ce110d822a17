// SPDX-License-Identifier: Apache-2.0
#include <vmlight/words.h>

#include <OpenImageIO/strutil.h>

namespace vmlight {

std::string one_line(OIIO::string_view text)
{
    std::string line;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        line += byte < 0x20 || byte == 0x7f ? OIIO::Strutil::fmt::format("\\x{:02x}", byte) : std::string(1, c);
    }
    return line;
}

std::string reason_line(OIIO::string_view reason)
{
    constexpr size_t kLongest = 500;
    return one_line(reason.substr(0, kLongest)) + (reason.size() > kLongest ? "..." : "");
}

} // namespace vmlight
