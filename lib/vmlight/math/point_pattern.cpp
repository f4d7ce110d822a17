// SPDX-License-Identifier: Apache-2.0
#include <vmlight/math/point_pattern.h>

#include <vmlight/math/ray_fan.h>

#include <Imath/ImathBox.h>

#include <algorithm>
#include <cstddef>

namespace vmlight {
namespace {

using kernel::reverse_bits;

uint64_t spread_bits(uint32_t x)
{
    uint64_t s = x;
    s = (s | (s << 16)) & 0x0000ffff0000ffffull;
    s = (s | (s << 8)) & 0x00ff00ff00ff00ffull;
    s = (s | (s << 4)) & 0x0f0f0f0f0f0f0f0full;
    s = (s | (s << 2)) & 0x3333333333333333ull;
    return (s | (s << 1)) & 0x5555555555555555ull;
}

uint64_t morton(const Point32& p)
{
    return spread_bits(p.u) << 1 | spread_bits(p.v);
}

struct DirectedPoint
{
    Imath::V3d direction;
    Point32 point;
};

// Divide points into packets: halve them across the longest side of their box until packets are left.
void halve(DirectedPoint* first, DirectedPoint* last)
{
    const auto packets = (last - first + kPacketSize - 1) / kPacketSize;
    if (packets < 2)
        return;
    Imath::Box3d box;
    for (const DirectedPoint* p = first; p < last; ++p)
        box.extendBy(p->direction);
    const auto axis = int(box.majorAxis());
    std::stable_sort(first, last, [&](const DirectedPoint& a, const DirectedPoint& b) {
        return a.direction[axis] < b.direction[axis];
    });
    DirectedPoint* const middle = first + packets / 2 * kPacketSize;
    halve(first, middle);
    halve(middle, last);
}

void sort_by_direction(std::vector<Point32>& points, const PointPattern::Direction& direction)
{
    std::vector<DirectedPoint> all;
    for (const Point32& point : points)
        all.push_back({ direction(point), point });
    halve(all.data(), all.data() + all.size());
    for (size_t i = 0; i < all.size(); ++i)
        points[i] = all[i].point;
    // Each lane's own points are to be spread evenly as well (lane_scatter()): it takes another rank in packet after
    // packet. Steps of 3, which has no factor in common with 8, bring it to each.
    for (size_t first = 0, step = 0; first + kPacketSize <= points.size(); first += kPacketSize, step += 3) {
        const auto packet = points.begin() + std::ptrdiff_t(first);
        std::sort(packet, packet + kPacketSize, [](const Point32& a, const Point32& b) { return a.u < b.u; });
        std::rotate(packet, packet + std::ptrdiff_t(step % kPacketSize), packet + kPacketSize);
    }
}

} // namespace

PointPattern::PointPattern(const std::string& sampler, int count, const Direction& direction)
    : m_count(count)
    , m_owen(sampler == "sobol")
{
    if (sampler == "fibonacci")
        m_lattice.emplace(uint32_t(count));
    std::vector<Point32> points;
    for (uint32_t i = 0; i < uint32_t(count); ++i)
        points.push_back(m_lattice ? m_lattice->point(i) : sampler == "halton" ? halton_point(i) : sobol_point(i));
    if (m_lattice)
        sort_by_direction(points, direction);
    else // along a space-filling curve, whose intervals stay together under nested scrambling
        std::stable_sort(points.begin(), points.end(),
                         [](const Point32& a, const Point32& b) { return morton(a) < morton(b); });
    points.resize(size_t((count + kPacketSize - 1) / kPacketSize) * kPacketSize, points.back());
    for (const Point32& p : points) {
        m_u.push_back(m_owen ? reverse_bits(p.u) : p.u);
        m_v.push_back(m_owen ? reverse_bits(p.v) : p.v);
    }
}

kernel::Points PointPattern::points(Point32 texel, bool uniform) const
{
    if (m_lattice)
        texel = m_lattice->reduce(texel);
    return { m_u.data(), m_v.data(), m_count, uniform, m_owen, texel.u, texel.v };
}

} // namespace vmlight
