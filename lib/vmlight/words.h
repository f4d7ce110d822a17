// SPDX-License-Identifier: Apache-2.0
/// Words of messages.
#pragma once

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

} // namespace vmlight
