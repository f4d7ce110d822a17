// SPDX-License-Identifier: Apache-2.0
/// Skies with suns, painted row by row at any size.
#pragma once

#include <vmlight/cfem/suns.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace vmlight::sun_sky {

using Imath::V3d;
using Imath::V3f;

constexpr double kSpread = 0.7; ///< degrees

/// A disc of even light, with a glow around it of this share of its energy, a Gaussian of kSpread.
struct Light
{
    V3d direction;
    double half_angle; ///< degrees
    V3d energy; ///< radiance times solid angle
    double glow = 0;
};

struct Sky
{
    std::function<V3d(double height)> background; ///< of the y of a direction
    std::vector<Light> lights;

    /// The mean radiance of the pixel, over many points where a light may be.
    V3d at(int x, int y, int width, int height) const;

    Environment environment(int width) const;
};

inline V3d gray_sky(double height)
{
    return V3d(0.8, 1, 1.2) * (1 + 0.3 * height);
}

inline V3d at_angles(double azimuth, double elevation)
{
    const double a = azimuth * M_PI / 180, e = elevation * M_PI / 180;
    return { std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e) };
}

inline double degrees_between(const V3d& a, const V3d& b)
{
    return 2 * std::asin(std::min(1.0, 0.5 * (a - b).length())) * 180 / M_PI;
}

} // namespace vmlight::sun_sky
