// SPDX-License-Identifier: Apache-2.0
/// Splits of painted skies, and what is needed to check them pixel by pixel.
#pragma once

#include "sun_sky.h"

#include <vmlight/cfem/suns.h>
#include <vmlight/math/latlong.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace vmlight::sun_sky {

inline SunSplit split_of(const Environment& env)
{
    SunSplit split;
    std::string error;
    EXPECT_TRUE(split.find(env, false, error)) << error;
    return split;
}

inline std::vector<float> sky_pixels(const Environment& env)
{
    const OIIO::ImageSpec& spec = env.spec();
    std::vector<float> pixels(size_t(3) * spec.width * spec.height);
    std::string error;
    for (int y = 0; y < spec.height; ++y)
        EXPECT_TRUE(
            env.read(OIIO::ROI(0, spec.width, y, y + 1, 0, 1, 0, 3), &pixels[size_t(3) * spec.width * y], error))
            << error;
    return pixels;
}

inline Sky one_sun(const V3d& direction, double half_angle = 0.265, double glow = 0)
{
    return { gray_sky, { { direction, half_angle, V3d(12, 10, 8), glow } } };
}

} // namespace vmlight::sun_sky
