// SPDX-License-Identifier: Apache-2.0
/// The lat-long convention of all environments: right-handed, y up, +z at the centre of the map, +x at s = 0.25, -x at
/// s = 0.75, as in OpenImageIO's y-up maps and OpenEXR's ImfEnvmap. Pixel centres are at (i + 0.5) / width, unlike in
/// OpenEXR's functions, which put the first and last columns on the seam.
#pragma once

#include <Imath/ImathVec.h>

#include <cmath>

namespace vmlight::latlong {

constexpr double pi = 3.14159265358979323846;

/// The unit direction at (s, t), for any s (periodic) and t in [0, 1]; t = 0 is +y, t = 1 is -y.
template <class T> inline Imath::Vec3<T> direction(T s, T t)
{
    const T theta = T(pi) * t;
    const T phi = T(2 * pi) * (s - T(0.5));
    const T sin_theta = std::sin(theta);
    return { -std::sin(phi) * sin_theta, std::cos(theta), std::cos(phi) * sin_theta };
}

/// (s, t) of a direction of any length: s in [0, 1), t in [0, 1]. The inverse of direction().
/// The zero vector gives (0.5, 0.5). Uses atan2 for both angles: acos(y) loses half its digits near the poles, and is
/// NaN where y rounds past 1.
template <class T> inline Imath::Vec2<T> position(const Imath::Vec3<T>& d)
{
    const T s = std::atan2(-d.x, d.z) / T(2 * pi) + T(0.5);
    const T t = T(0.5) - std::atan2(d.y, std::hypot(d.x, d.z)) / T(pi);
    return { s >= T(1) ? T(0) : s, t };
}

/// Solid angle in steradians of one whole row of a map of `height` rows; the rows of a map sum to 4 pi.
inline double row_solid_angle(int row, int height)
{
    // cos a - cos b as a product, which is accurate near the poles, where the difference cancels.
    const double half = 0.5 * pi / height;
    return 2 * pi * 2 * std::sin((2 * row + 1) * half) * std::sin(half);
}

} // namespace vmlight::latlong
