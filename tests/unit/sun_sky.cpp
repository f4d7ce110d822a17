// SPDX-License-Identifier: Apache-2.0
#include "sun_sky.h"

#include <vmlight/math/latlong.h>

namespace vmlight::sun_sky {

V3d Sky::at(int x, int y, int width, int height) const
{
    const V3d middle = latlong::direction((x + 0.5) / width, (y + 0.5) / height);
    V3d sum = background(middle.y);
    const int n = std::clamp(16384 / width, 2, 16);
    for (const Light& light : lights) {
        const double radius = light.half_angle * M_PI / 180, spread = kSpread * M_PI / 180;
        const double reach = (light.glow > 0 ? 5 * spread : 0) + radius + 2 * M_PI / height;
        const double off = (middle - light.direction).length(), rim = 2 * std::sin(0.5 * radius);
        if (off > reach)
            continue;
        const V3d even = light.energy * (1 - light.glow) / disc_solid_angle(radius);
        if (light.glow == 0 && off < rim - 2 * M_PI / height) { // all of the pixel
            sum += even;
            continue;
        }
        const V3d peak = light.energy * light.glow / (2 * M_PI * spread * spread);
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                const V3d d = latlong::direction((x + (i + 0.5) / n) / width, (y + (j + 0.5) / n) / height);
                const double chord = (d - light.direction).length();
                if (chord < rim)
                    sum += even / (n * n);
                if (light.glow > 0)
                    sum += peak * std::exp(-0.5 * chord * chord / spread / spread) / (n * n);
            }
    }
    return sum;
}

Environment Sky::environment(int width) const
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

} // namespace vmlight::sun_sky
