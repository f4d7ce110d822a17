// SPDX-License-Identifier: Apache-2.0
/// UTF-8 as RFC 3629 has it: the shortest form of each character, no surrogates, nothing above U+10FFFF.
#pragma once

#include <OpenImageIO/string_view.h>

#include <array>
#include <cstdint>

namespace vmlight {

/// Bytes of the character at the start of `text`, which is not empty, or 0 if they are no UTF-8. `code` is set to its
/// code point.
inline size_t read_character(OIIO::string_view text, uint32_t& code)
{
    const auto lead = static_cast<unsigned char>(text[0]);
    const size_t count = lead < 0x80 ? 1 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
    constexpr std::array<uint32_t, 5> kLeast { 0, 0, 0x80, 0x800, 0x10000 };
    if (count > text.size() || (count > 1 && lead < 0xc2) || lead > 0xf4)
        return 0;
    code = count == 1 ? lead : lead & (0xffu >> (count + 1));
    for (size_t i = 1; i < count; ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        if ((byte & 0xc0) != 0x80)
            return 0;
        code = code << 6 | (byte & 0x3f);
    }
    const bool good = code >= kLeast[count] && code <= 0x10ffff && !(code >= 0xd800 && code < 0xe000);
    return good ? count : 0;
}

/// Whether all of `text` is.
inline bool is_utf8(OIIO::string_view text)
{
    uint32_t code = 0;
    while (!text.empty()) {
        const size_t count = read_character(text, code);
        if (count == 0)
            return false;
        text.remove_prefix(count);
    }
    return true;
}

} // namespace vmlight
