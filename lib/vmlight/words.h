// SPDX-License-Identifier: Apache-2.0
/// Words of messages.
#pragma once

#include <cstdint>

namespace vmlight {

/// "1 texel", but "0 texels" and "2 texels".
inline const char* plural(int64_t count, const char* one, const char* many)
{
    return count == 1 ? one : many;
}

} // namespace vmlight
