// SPDX-License-Identifier: Apache-2.0
/// Words of messages.
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
inline std::string counted(int64_t count, const char* one, const char* many)
{
    return std::to_string(count) + " " + plural(count, one, many);
}

/// `text` on one line of UTF-8, with \x for control characters and for bytes that are none: names and texts of files
/// and users come back in messages.
std::string one_line(OIIO::string_view text);
/// The same of a reason with a file's own words in it, which may be many: cut after 500 bytes.
std::string reason_line(OIIO::string_view reason);

} // namespace vmlight
