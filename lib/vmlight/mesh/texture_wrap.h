// SPDX-License-Identifier: Apache-2.0
/// What a texture shows beyond [0, 1].
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

namespace vmlight {

enum class TextureWrap
{
    clamp,
    periodic,
    mirror
};

/// Of the words of MaterialTexture.
inline TextureWrap wrap_of(const std::string& word)
{
    return word == "clamp" ? TextureWrap::clamp : word == "mirror" ? TextureWrap::mirror : TextureWrap::periodic;
}

/// The texel, of `n` in a row, that is seen at place `i` of the endless row.
inline int wrapped_texel(int64_t i, int n, TextureWrap wrap)
{
    if (wrap == TextureWrap::clamp)
        return int(std::clamp<int64_t>(i, 0, n - 1));
    const int64_t period = wrap == TextureWrap::mirror ? 2 * int64_t(n) : n;
    i %= period;
    i = i < 0 ? i + period : i;
    return int(i < n ? i : period - 1 - i);
}

} // namespace vmlight
