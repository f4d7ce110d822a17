// SPDX-License-Identifier: Apache-2.0
// One sky gives one sun, at any size and however it is turned.
#include "split_sky.h"

#include <gtest/gtest.h>

#include <random>

using namespace vmlight;
using namespace vmlight::sun_sky;

namespace {

// The red light above 1 of a sky as its pixels have it, as a vector: a pixel does not tell where in it the sun is.
V3d painted(const Sky& sky, int width)
{
    const std::vector<float> pixels = sky_pixels(sky.environment(width));
    V3d sum(0);
    for (int y = 0; y < width / 2; ++y)
        for (int x = 0; x < width; ++x)
            if (const double excess = double(pixels[3 * (size_t(y) * size_t(width) + size_t(x))]) - 1; excess > 0)
                sum += latlong::direction((x + 0.5) / width, (y + 0.5) / (width / 2))
                    * (excess * latlong::row_solid_angle(y, width / 2) / width);
    return sum;
}

} // namespace

TEST(Suns, SizesOfOneSkyGiveOneSun)
{
    const V3d direction = at_angles(123.4, 27.1);
    const Sky sky = one_sun(direction, 0.265, 0.2);
    const Sun most = split_of(sky.environment(8192)).suns().at(0);
    for (const int width : { 512, 1000, 2048 }) {
        const SunSplit split = split_of(sky.environment(width));
        ASSERT_EQ(split.suns().size(), 1u) << width;
        const Sun& sun = split.suns()[0];
        EXPECT_LT(degrees_between(sun.disc.direction, direction), 0.1) << width;
        for (size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(sun.color[c] / most.color[c], 1, 0.01) << width;
    }
}

TEST(Suns, TurnedSkiesGiveTheTurnedSun)
{
    std::vector<V3d> places { V3d(0, 1, 0), V3d(0, -1, 0), V3d(0, 0, -1), at_angles(0, 89.5), at_angles(179.9, 2) };
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    while (places.size() < 16)
        places.push_back(V3d(normal(random), normal(random), normal(random)).normalized());
    for (const V3d& place : places) {
        Sky sky = one_sun(place, 0.265, 0.2);
        sky.background = [](double) { return V3d(1); };
        const SunSplit split = split_of(sky.environment(512));
        ASSERT_EQ(split.suns().size(), 1u) << place;
        const Sun& sun = split.suns()[0];
        const V3d light = painted(sky, 512);
        EXPECT_LT(degrees_between(sun.disc.direction, light.normalized()), 0.1) << place;
        EXPECT_LT(degrees_between(sun.disc.direction, place), 0.15) << place;
        EXPECT_NEAR(sun.color[0] * M_PI / light.length(), 1, 0.01) << place;
    }
}
