// SPDX-License-Identifier: Apache-2.0
#include <vmlight/uv/unwrap_bounds.h>

#include <algorithm>
#include <vector>

namespace vmlight {

using Imath::V2d;

namespace {

// The corners of the convex hull, counter-clockwise. Source: A. Andrew, "Another Efficient Algorithm for Convex Hulls
// in Two Dimensions", IPL 9(5), 1979.
std::vector<V2d> convex_hull(std::vector<V2d> points)
{
    std::sort(points.begin(), points.end(),
              [](const V2d& a, const V2d& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    std::vector<V2d> hull;
    for (int pass = 0; pass < 2; ++pass) {
        const size_t first = hull.size();
        for (const V2d& p : points) {
            while (hull.size() >= first + 2 && (hull.back() - hull[hull.size() - 2]).cross(p - hull.back()) <= 0)
                hull.pop_back();
            hull.push_back(p);
        }
        hull.pop_back();
        std::reverse(points.begin(), points.end());
    }
    return hull;
}

V2d turned(const V2d& p, const V2d& along)
{
    return { p.dot(along), along.cross(p) };
}

} // namespace

V2d lay_straight(UnwrapChart& chart)
{
    std::vector<V2d> border;
    for (uint32_t h : chart.border)
        border.push_back(chart.uvs[chart.from(h)]);
    const std::vector<V2d> hull = convex_hull(border);
    V2d best(1, 0);
    double least = 1e300;
    for (size_t i = 0; i < hull.size(); ++i) {
        const V2d along = (hull[(i + 1) % hull.size()] - hull[i]).normalized();
        UvBounds bounds;
        for (const V2d& p : hull)
            bounds.add(turned(p, along));
        // Of bounds of one area, the ones nearest to a square: a right triangle lies on its legs.
        const double room = bounds.size().x * bounds.size().y
            + 1e-3 * std::max(bounds.size().x, bounds.size().y) * bounds.size().length();
        if (room < least * (1 - 1e-9)) {
            least = room;
            best = bounds.size().x >= bounds.size().y ? along : V2d(-along.y, along.x);
        }
    }
    UvBounds bounds;
    for (V2d& uv : chart.uvs) {
        uv = turned(uv, best);
        bounds.add(uv);
    }
    for (V2d& uv : chart.uvs)
        uv -= bounds.low;
    return bounds.size();
}

} // namespace vmlight
