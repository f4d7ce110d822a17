// SPDX-License-Identifier: Apache-2.0
/// Skies with suns, painted row by row at any size.
#pragma once

#include <vmlight/cfem/suns.h>
#include <vmlight/math/latlong.h>

#include <array>
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
    V3d at(int x, int y, int width, int height) const
    {
        const V3d middle = latlong::direction((x + 0.5) / width, (y + 0.5) / height);
        V3d sum = background(middle.y);
        const int n = std::clamp(16384 / width, 2, 16);
        for (const Light& light : lights) {
            const double radius = light.half_angle * M_PI / 180, spread = kSpread * M_PI / 180;
            const double reach = (light.glow > 0 ? 5 * spread : 0) + radius + 2 * M_PI / height;
            if ((middle - light.direction).length() > reach)
                continue;
            const V3d even = light.energy * (1 - light.glow) / disc_solid_angle(radius);
            const V3d peak = light.energy * light.glow / (2 * M_PI * spread * spread);
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i) {
                    const V3d d = latlong::direction((x + (i + 0.5) / n) / width, (y + (j + 0.5) / n) / height);
                    const double chord = (d - light.direction).length();
                    if (chord < 2 * std::sin(0.5 * radius))
                        sum += even / (n * n);
                    sum += peak * std::exp(-0.5 * chord * chord / spread / spread) / (n * n);
                }
        }
        return sum;
    }

    Environment environment(int width) const
    {
        OIIO::ImageSpec spec(width, width / 2, 3, OIIO::TypeFloat);
        spec.channelnames = { "R", "G", "B" };
        const Sky sky = *this;
        return Environment(spec, [sky, width](int y, float* rgb, std::string&) {
            const double theta = (y + 0.5) / (width / 2) * M_PI;
            const V3d flat = sky.background(std::cos(theta));
            bool plain = true;
            for (const Light& light : sky.lights)
                plain &= std::abs(std::acos(light.direction.y) - theta)
                    > (light.half_angle + (light.glow > 0 ? 5 * kSpread : 0)) * M_PI / 180 + 4 * M_PI / width;
            for (int x = 0; x < width; ++x) {
                const V3d pixel = plain ? flat : sky.at(x, y, width, width / 2);
                for (int c = 0; c < 3; ++c)
                    rgb[3 * x + c] = float(pixel[c]);
            }
            return true;
        });
    }
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
