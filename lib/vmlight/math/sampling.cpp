// SPDX-License-Identifier: Apache-2.0
#include <vmlight/math/sampling.h>

#include <vmlight/math/latlong.h>
#include <vmlight/math/lattice.h>
#include <vmlight/math/sampling_kernel.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vmlight {
namespace {

using Imath::V3d;
using Imath::V3f;
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

// Choosing a lattice takes time: only where its points are asked for, and once.
std::unique_ptr<const Lattice> lattice_of(const std::string& sampler, int count)
{
    return sampler == "fibonacci" ? std::make_unique<Lattice>(uint32_t(count)) : nullptr;
}

std::vector<Point32> ordered_points(const std::string& sampler, int count, const Lattice* lattice)
{
    std::vector<Point32> points;
    for (uint32_t i = 0; i < uint32_t(count); ++i)
        points.push_back(lattice ? lattice->point(i) : sampler == "halton" ? halton_point(i) : sobol_point(i));
    sort_for_packets(points);
    return points;
}

} // namespace

Point32 halton_point(uint32_t index)
{
    // Twenty ternary digits: the last is 2.9e-10, about 2^-32.
    uint64_t reversed = 0, power = 1;
    for (uint32_t rest = index; power < 3486784401u; rest /= 3, power *= 3)
        reversed = reversed * 3 + rest % 3;
    return { reverse_bits(index), uint32_t((reversed << 32) / power) };
}

Point32 sobol_point(uint32_t index)
{
    uint32_t v = 0;
    for (uint32_t rest = index, direction = 1u << 31; rest; rest >>= 1, direction ^= direction >> 1)
        if (rest & 1)
            v ^= direction;
    return { reverse_bits(index), v };
}

void sort_for_packets(std::vector<Point32>& points)
{
    std::stable_sort(points.begin(), points.end(),
                     [](const Point32& a, const Point32& b) { return morton(a) < morton(b); });
}

uint32_t owen_scramble(uint32_t fraction, uint32_t seed)
{
    return reverse_bits(kernel::scramble_reversed(reverse_bits(fraction), seed));
}

Point32 texel_hash(uint32_t x, uint32_t y, uint32_t seed)
{
    // SplitMix64's finalizer over the packed coordinates decorrelates neighbours.
    uint64_t h = (uint64_t(y) << 32 | x) + 0x9e3779b97f4a7c15ull * (uint64_t(seed) + 1);
    h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ull;
    h = (h ^ (h >> 27)) * 0x94d049bb133111ebull;
    h ^= h >> 31;
    return { uint32_t(h), uint32_t(h >> 32) };
}

TangentFrame::TangentFrame(const V3f& n)
    : normal(n)
{
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    tangent = V3f(1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x);
    bitangent = V3f(b, sign + n.y * n.y * a, -n.y);
}

std::vector<Point32> sample_points(const std::string& sampler, int count)
{
    return ordered_points(sampler, count, lattice_of(sampler, count).get());
}

SamplePattern::SamplePattern(const std::string& sampler, int count, bool uniform)
    : m_count(count)
    , m_uniform(uniform)
    , m_owen(sampler == "sobol")
    , m_lattice(lattice_of(sampler, count))
{
    std::vector<Point32> points = ordered_points(sampler, count, m_lattice.get());
    const size_t padded = size_t((count + kPacketSize - 1) / kPacketSize) * kPacketSize;
    points.resize(padded, points.back());
    for (const Point32& p : points) {
        m_u.push_back(m_owen ? reverse_bits(p.u) : p.u);
        m_v.push_back(m_owen ? reverse_bits(p.v) : p.v);
    }
}

SamplePattern::~SamplePattern() = default;

Point32 SamplePattern::texel(int x, int y, uint32_t seed) const
{
    return m_lattice ? m_lattice->shift(uint32_t(x), uint32_t(y), seed) : texel_hash(uint32_t(x), uint32_t(y), seed);
}

void SamplePattern::directions(RayFan& fan, const TangentFrame& frame, const V3f& geometric_normal, Point32 texel) const
{
    kernel::directions({ m_u.data(), m_v.data(), m_count, m_uniform, m_owen, texel.u, texel.v }, frame,
                       geometric_normal, fan);
}

void SamplePattern::directions_scalar(RayFan& fan, const TangentFrame& frame, const V3f& geometric_normal,
                                      Point32 texel) const
{
    std::fill(fan.lanes.begin(), fan.lanes.end(), uint8_t(0));
    for (int i = 0; i < fan.packets * kPacketSize; ++i) {
        const uint32_t u = m_owen ? reverse_bits(kernel::scramble_reversed(m_u[i], texel.u)) : m_u[i] + texel.u;
        const uint32_t v = m_owen ? reverse_bits(kernel::scramble_reversed(m_v[i], texel.v)) : m_v[i] + texel.v;
        // 24 bits are exact in a float, so that u never rounds to 1.
        const double fu = (u >> 8) * 0x1p-24, azimuth = 2 * latlong::pi * ((v >> 8) * 0x1p-24);
        const double radius = std::sqrt(m_uniform ? fu * (2 - fu) : fu);
        const double height = m_uniform ? 1 - fu : std::sqrt(1 - fu);
        const V3d d = V3d(frame.tangent) * (radius * std::cos(azimuth))
            + V3d(frame.bitangent) * (radius * std::sin(azimuth)) + V3d(frame.normal) * height;
        fan.x[i] = float(d.x), fan.y[i] = float(d.y), fan.z[i] = float(d.z);
        if (i < m_count && d.dot(V3d(geometric_normal)) > 0)
            fan.lanes[i / kPacketSize] |= uint8_t(1u << i % kPacketSize);
    }
}

DirectionSums sum_directions(const RayFan& fan, const V3f& weight_axis)
{
    return kernel::sum_directions(fan, weight_axis);
}

DirectionSums sum_directions_scalar(const RayFan& fan, const V3f& weight_axis)
{
    DirectionSums sums;
    for (int i = 0; i < fan.packets * kPacketSize; ++i) {
        if (!(fan.lanes[i / kPacketSize] >> i % kPacketSize & 1))
            continue;
        const V3d d(fan.x[i], fan.y[i], fan.z[i]);
        const double cosine = d.dot(V3d(weight_axis));
        sums.sum += d;
        sums.weighted_sum += d * cosine;
        sums.weight += cosine;
        ++sums.rays;
    }
    return sums;
}

} // namespace vmlight
