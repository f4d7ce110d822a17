// SPDX-License-Identifier: Apache-2.0
#include <vmlight/uv/unwrap_chart.h>

#include <algorithm>
#include <cmath>

namespace vmlight {

using Imath::V2d;

namespace {

// Borders that only touch, as along a seam that has not opened, are moved apart by this much of the chart's size, so
// that what still crosses overlaps. What overlaps by less is no more than rounding.
constexpr double kInset = 1e-7;

struct Segment
{
    V2d a, b;
    uint32_t loop, index, next; // in its loop
    double low_x() const { return std::min(a.x, b.x); }
    double high_x() const { return std::max(a.x, b.x); }
};

double side(const V2d& a, const V2d& b, const V2d& p)
{
    return (b - a).cross(p - a);
}

bool cross(const Segment& s, const Segment& t)
{
    if (std::max(s.a.y, s.b.y) < std::min(t.a.y, t.b.y) || std::max(t.a.y, t.b.y) < std::min(s.a.y, s.b.y))
        return false;
    return side(s.a, s.b, t.a) * side(s.a, s.b, t.b) <= 0 && side(t.a, t.b, s.a) * side(t.a, t.b, s.b) <= 0;
}

// The border, moved inwards. It runs counter-clockwise, the chart on its left.
std::vector<Segment> inset_border(const UnwrapChart& chart, double inset)
{
    std::vector<Segment> segments;
    for (uint32_t loop = 0; loop + 1 < chart.loops.size(); ++loop) {
        const uint32_t first = chart.loops[loop], count = chart.loops[loop + 1] - first;
        const auto at = [&](uint32_t i) { return chart.uvs[chart.from(chart.border[first + i % count])]; };
        std::vector<V2d> moved;
        for (uint32_t i = 0; i < count; ++i) {
            const V2d before = (at(i) - at(i + count - 1)).normalized(), after = (at(i + 1) - at(i)).normalized();
            const V2d turned = before + after;
            V2d inwards(-turned.y, turned.x);
            if (inwards.length2() < 1e-12)
                inwards = before; // the tip of a needle, or the end of a slit: either way to the chart's side
            moved.push_back(at(i) + inwards.normalized() * inset);
        }
        for (uint32_t i = 0; i < count; ++i)
            segments.push_back({ moved[i], moved[(i + 1) % count], loop, i, (i + 1) % count });
    }
    return segments;
}

// Around a vertex of the border the triangles must not turn by more than once.
bool turns_too_far(const UnwrapChart& chart)
{
    std::vector<double> turns(chart.uvs.size(), 0);
    for (const auto& c : chart.corners)
        for (int k = 0; k < 3; ++k) {
            const V2d &p = chart.uvs[c[k]], a = chart.uvs[c[(k + 1) % 3]] - p, b = chart.uvs[c[(k + 2) % 3]] - p;
            turns[c[k]] += std::atan2(a.cross(b), a.dot(b));
        }
    constexpr double kOnce = 2 * M_PI + 1e-6;
    return std::any_of(turns.begin(), turns.end(), [](double turn) { return turn > kOnce; });
}

bool are_adjacent(const Segment& s, const Segment& t)
{
    return s.loop == t.loop && (s.next == t.index || t.next == s.index);
}

} // namespace

bool is_one_to_one(const UnwrapChart& chart)
{
    for (const auto& c : chart.corners)
        if (!(side(chart.uvs[c[0]], chart.uvs[c[1]], chart.uvs[c[2]]) > 0))
            return false;
    // All triangles turn the same way, so a point is covered as often as the border winds around it: once, if its loops
    // do not cross, and only one of them runs counter-clockwise.
    int outer = 0;
    V2d low = chart.uvs[0], high = low;
    for (size_t loop = 0; loop + 1 < chart.loops.size(); ++loop) {
        double area = 0;
        const V2d origin = chart.uvs[chart.from(chart.border[chart.loops[loop]])];
        for (uint32_t i = chart.loops[loop]; i < chart.loops[loop + 1]; ++i) {
            const V2d &a = chart.uvs[chart.from(chart.border[i])], &b = chart.uvs[chart.to(chart.border[i])];
            area += (a - origin).cross(b - origin);
            low = { std::min(low.x, a.x), std::min(low.y, a.y) };
            high = { std::max(high.x, a.x), std::max(high.y, a.y) };
        }
        outer += area > 0;
    }
    if (outer != 1 || turns_too_far(chart))
        return false;
    std::vector<Segment> segments = inset_border(chart, kInset * (high - low).length());
    std::sort(segments.begin(), segments.end(),
              [](const Segment& s, const Segment& t) { return s.low_x() < t.low_x(); });
    for (size_t i = 0; i < segments.size(); ++i)
        for (size_t j = i + 1; j < segments.size() && segments[j].low_x() <= segments[i].high_x(); ++j)
            if (!are_adjacent(segments[i], segments[j]) && cross(segments[i], segments[j]))
                return false;
    return true;
}

} // namespace vmlight
