// SPDX-License-Identifier: Apache-2.0
/// Discs of the sky: cones of directions, such as the one that holds the sun.
#pragma once

#include <vmlight/math/latlong.h>

#include <Imath/ImathVec.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace vmlight {

/// All directions within `half_angle` of `direction`.
struct Disc
{
    Imath::V3d direction { 0, 1, 0 }; ///< of unit length
    double half_angle = 0; ///< radians, 0 to pi / 2
};

/// 2 pi (1 - cos a), accurate for small angles too.
inline double disc_solid_angle(double half_angle)
{
    const double half_sine = std::sin(0.5 * half_angle);
    return 4 * latlong::pi * half_sine * half_sine;
}

/// The length of the mean direction of a uniform disc, (1 + cos a) / 2.
inline double disc_mean_length(double half_angle)
{
    const double half_sine = std::sin(0.5 * half_angle);
    return 1 - half_sine * half_sine;
}

/// The half angle of the uniform disc whose mean direction has this length: the inverse of disc_mean_length() in
/// [1/2, 1], clamped to it.
inline double disc_half_angle(double mean_length)
{
    return 2 * std::asin(std::sqrt(std::clamp(1 - mean_length, 0.0, 0.5)));
}

/// Evenly distributed directions of a disc: those of a Fibonacci lattice, made once and shared by all texels.
class DiscSamples
{
public:
    /// Directions in all; texels start at different ones.
    static constexpr uint32_t kCount = 4096;

    explicit DiscSamples(const Disc& disc);

    /// Direction `ray` of `rays`, which divides kCount, for a texel with this hash. The rays of a texel are spread
    /// evenly over the disc.
    const Imath::V3f& at(uint32_t hash, int ray, int rays) const
    {
        return m_directions[(hash + uint32_t(ray) * (kCount / uint32_t(rays))) % kCount];
    }

    /// One of any number of directions that find out whether the whole disc is alike: every other is at its rim, where
    /// straight edges come in.
    const Imath::V3f& probe(uint32_t hash, int ray) const
    {
        constexpr uint32_t kRim = kCount / 32;
        const uint32_t number = uint32_t(ray) / 2;
        return ray % 2 ? m_directions[kCount - 1 - (hash + number) % kRim]
                       : m_directions[(hash + number * (kCount / 8)) % kCount];
    }

private:
    std::vector<Imath::V3f> m_directions;
};

} // namespace vmlight
