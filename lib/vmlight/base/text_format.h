// SPDX-License-Identifier: Apache-2.0
/// Text formatting for messages.
#pragma once

#include <OpenImageIO/string_view.h>

#include <cstdint>
#include <string>

namespace vmlight {

/// `one` for 1, else `many`.
inline const char* plural(int64_t count, const char* one, const char* many)
{
    return count == 1 ? one : many;
}

/// "1 texel", "2 texels".
inline std::string count_text(int64_t count, const char* one, const char* many)
{
    return std::to_string(count) + " " + plural(count, one, many);
}

/// 0 of nothing.
inline double percent_of(int64_t part, int64_t whole)
{
    return whole ? 100.0 * double(part) / double(whole) : 0.0;
}

/// `text` as one printable line of UTF-8: control characters and invalid bytes are escaped as \xNN. For messages that
/// quote files and users.
std::string printable_line(OIIO::string_view text);
/// The same, cut after 500 bytes: for messages with text from a file.
std::string shortened_line(OIIO::string_view reason);

} // namespace vmlight
