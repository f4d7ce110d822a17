// SPDX-License-Identifier: Apache-2.0
/// UTF-8 as in RFC 3629: shortest forms only, no surrogates, nothing above U+10FFFF.
#pragma once

#include <OpenImageIO/string_view.h>

#include <array>
#include <cstdint>

namespace vmlight {

/// Decode the first character of `text`, which must not be empty, to its code point. Returns its length in bytes, 0 if
/// it is not valid UTF-8.
inline size_t decode_utf8(OIIO::string_view text, uint32_t& code)
{
    const auto lead = static_cast<unsigned char>(text[0]);
    const size_t count = lead < 0x80 ? 1 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
    constexpr std::array<uint32_t, 5> kSmallest { 0, 0, 0x80, 0x800, 0x10000 };
    if (count > text.size() || (count > 1 && lead < 0xc2) || lead > 0xf4)
        return 0;
    code = count == 1 ? lead : lead & (0xffu >> (count + 1));
    for (size_t i = 1; i < count; ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        if ((byte & 0xc0) != 0x80)
            return 0;
        code = code << 6 | (byte & 0x3f);
    }
    const bool valid = code >= kSmallest[count] && code <= 0x10ffff && !(code >= 0xd800 && code < 0xe000);
    return valid ? count : 0;
}

/// Whether `text` is valid UTF-8.
inline bool is_utf8(OIIO::string_view text)
{
    uint32_t code = 0;
    while (!text.empty()) {
        const size_t count = decode_utf8(text, code);
        if (count == 0)
            return false;
        text.remove_prefix(count);
    }
    return true;
}

} // namespace vmlight
