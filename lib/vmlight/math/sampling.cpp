// SPDX-License-Identifier: Apache-2.0
#include <vmlight/math/sampling.h>

#include <vmlight/math/latlong.h>
#include <vmlight/math/point_pattern.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vmlight {
namespace {

using Imath::V3d;
using Imath::V3f;
using kernel::reverse_bits;

// Of a distribution by the cosine.
V3d cosine_direction(const Point32& p)
{
    const double u = p.u * 0x1p-32, azimuth = 2 * latlong::pi * (p.v * 0x1p-32), radius = std::sqrt(u);
    return { radius * std::cos(azimuth), radius * std::sin(azimuth), std::sqrt(1 - u) };
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

SamplePattern::SamplePattern(const std::string& sampler, int count, bool uniform)
    : m_points(std::make_unique<PointPattern>(sampler, count, cosine_direction))
    , m_uniform(uniform)
{
}

SamplePattern::~SamplePattern() = default;

int SamplePattern::count() const
{
    return m_points->count();
}

Point32 SamplePattern::texel(int x, int y, uint32_t seed) const
{
    const Lattice* lattice = m_points->lattice();
    return lattice ? lattice->shift(uint32_t(x), uint32_t(y), seed) : texel_hash(uint32_t(x), uint32_t(y), seed);
}

void SamplePattern::directions(RayFan& fan, const TangentFrame& frame, const V3f& geometric_normal, Point32 texel) const
{
    kernel::directions(m_points->points(texel, m_uniform), frame, geometric_normal, fan);
}

void SamplePattern::directions_scalar(RayFan& fan, const TangentFrame& frame, const V3f& geometric_normal,
                                      Point32 texel) const
{
    const kernel::Points points = m_points->points(texel, m_uniform);
    std::fill(fan.lanes.begin(), fan.lanes.end(), uint8_t(0));
    for (int i = 0; i < fan.packets * kPacketSize; ++i) {
        const uint32_t u = points.owen ? reverse_bits(kernel::scramble_reversed(points.u[i], points.texel_u))
                                       : points.u[i] + points.texel_u;
        const uint32_t v = points.owen ? reverse_bits(kernel::scramble_reversed(points.v[i], points.texel_v))
                                       : points.v[i] + points.texel_v;
        // 24 bits are exact in a float, so that u never rounds to 1.
        const double fu = (u >> 8) * 0x1p-24, azimuth = 2 * latlong::pi * ((v >> 8) * 0x1p-24);
        const double radius = std::sqrt(m_uniform ? fu * (2 - fu) : fu);
        const double height = m_uniform ? 1 - fu : std::sqrt(1 - fu);
        const V3d d = V3d(frame.tangent) * (radius * std::cos(azimuth))
            + V3d(frame.bitangent) * (radius * std::sin(azimuth)) + V3d(frame.normal) * height;
        fan.x[i] = float(d.x), fan.y[i] = float(d.y), fan.z[i] = float(d.z);
        if (i < points.count && d.dot(V3d(geometric_normal)) > 0)
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
