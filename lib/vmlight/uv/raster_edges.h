// SPDX-License-Identifier: Apache-2.0
/// The edge functions of a triangle in UV space, in integers.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace vmlight {

/// Texture coordinates are rounded to this many steps per texel.
constexpr int64_t kSubtexels = 256;

/// std::llround(), which the standard library does not inline, of numbers between -2^52 and 2^52.
inline int64_t rounded_subtexel(double x)
{
    const auto whole = int64_t(x);
    const double rest = x - double(whole);
    return whole + (rest >= 0.5) - (rest <= -0.5);
}

/// std::round() likewise, of any number.
inline double rounded(double x)
{
    return std::abs(x) < double(int64_t(1) << 52) ? double(rounded_subtexel(x)) : x;
}

struct UvCorner
{
    int64_t x, y; ///< in subtexels, y down
};

/// Twice the area, positive if clockwise in (u, v): y points down.
inline int64_t doubled_area(const std::array<UvCorner, 3>& c)
{
    return (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[2].x - c[0].x) * (c[1].y - c[0].y);
}

/// Edge k runs from corner k+1 to corner k+2 of the triangle, flipped to positive area if needed. Its edge function is
/// the barycentric weight of corner k times twice the area: positive inside. A texel is inside if all three are at
/// least `least`, which includes centres on left edges (that run up) and top edges.
struct UvEdges
{
    explicit UvEdges(std::array<UvCorner, 3> corners)
        : flipped(doubled_area(corners) < 0)
    {
        if (flipped)
            std::swap(corners[1], corners[2]);
        for (int k = 0; k < 3; ++k) {
            const UvCorner &a = corners[(k + 1) % 3], &b = corners[(k + 2) % 3];
            const int64_t dx = b.x - a.x, dy = b.y - a.y;
            step_x[k] = -dy * kSubtexels;
            step_y[k] = dx * kSubtexels;
            first[k] = dx * (kSubtexels / 2 - a.y) - dy * (kSubtexels / 2 - a.x);
            least[k] = dy < 0 || (dy == 0 && dx > 0) ? 0 : 1;
        }
    }
    /// The edge functions at the centre of texel (x, y). They grow by step_x and step_y per texel.
    std::array<int64_t, 3> at(int64_t x, int64_t y) const
    {
        std::array<int64_t, 3> e;
        for (int k = 0; k < 3; ++k)
            e[k] = first[k] + step_x[k] * x + step_y[k] * y;
        return e;
    }

    bool flipped;
    std::array<int64_t, 3> step_x, step_y, first, least;
};

} // namespace vmlight
