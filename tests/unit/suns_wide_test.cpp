// SPDX-License-Identifier: Apache-2.0
// Wide lights, such as the glow around a sun, are split off beside suns.
#include "cfem_brute.h"
#include "split_sky.h"

#include <OpenImageIO/imagebuf.h>

#include <gtest/gtest.h>

#include <array>
#include <random>

using namespace vmlight;
using namespace vmlight::sun_sky;

namespace {

constexpr double kGlow = 20; // degrees

// A sun, and around it a glow of `share` of the sun's light.
Sky glowing(const V3d& direction, double share)
{
    return { [](double) { return V3d(1); },
             { { direction, 0.265, V3d(12, 10, 8), 0 }, { direction, kGlow, V3d(6, 10, 14) * share, 0 } } };
}

// Energy of R, G and B, and the first moment of their mean.
struct Sums
{
    V3d energy { 0 }, moment { 0 };
};

Sums sums_of(const std::vector<Sun>& suns, size_t from)
{
    Sums sums;
    for (size_t k = from; k < suns.size(); ++k) {
        const V3d energy = V3d(suns[k].color[0], suns[k].color[1], suns[k].color[2]) * M_PI;
        sums.energy += energy;
        sums.moment += suns[k].disc.direction
            * (disc_mean_length(suns[k].disc.half_angle) * (energy.x + energy.y + energy.z) / 3);
    }
    return sums;
}

} // namespace

TEST(WideSuns, AGlowIsFourDiscsBesideItsSun)
{
    const V3d direction = at_angles(40, 50);
    const std::vector<Sun> suns = split_of(glowing(direction, 0.5).environment(1024)).suns();
    ASSERT_EQ(suns.size(), 5u);
    EXPECT_LT(degrees_between(suns[0].disc.direction, direction), 0.02);
    EXPECT_LT(suns[0].disc.half_angle * 180 / M_PI, 0.5);
    const Sums glow = sums_of(suns, 1);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(suns[0].color[size_t(c)] * M_PI / (12 - 2 * c), 1, 0.01) << c;
        EXPECT_NEAR(glow.energy[c] / (3 + 2 * c), 1, 0.02) << c;
    }
    EXPECT_LT(degrees_between(glow.moment.normalized(), direction), 0.2);
    EXPECT_NEAR(glow.moment.length() / 5, disc_mean_length(kGlow * M_PI / 180), 0.02);
    for (size_t k = 1; k < 5; ++k) { // where the quarters of a disc have their middle
        const double off = degrees_between(suns[k].disc.direction, direction);
        EXPECT_NEAR(off, 4 * std::sqrt(2) / (3 * M_PI) * kGlow, 0.5);
        EXPECT_NEAR(suns[k].color[1] / (glow.energy[1] / M_PI), 0.25, 0.02);
        EXPECT_LT(suns[k].disc.half_angle, kGlow * M_PI / 180);
    }
}

TEST(WideSuns, AWeakOneStaysInTheRest)
{
    // Of the light of its sun, or of all light.
    EXPECT_EQ(split_of(glowing(at_angles(40, 50), 0.05).environment(512)).suns().size(), 1u);
    Sky sky = glowing(at_angles(40, 50), 0.2);
    EXPECT_EQ(split_of(sky.environment(512)).suns().size(), 5u);
    sky.background = [](double) { return V3d(6); };
    EXPECT_EQ(split_of(sky.environment(512)).suns().size(), 1u);
}

TEST(WideSuns, OneWithoutASunStaysInTheRest)
{
    Sky sky = glowing(at_angles(40, 50), 2);
    sky.lights.erase(sky.lights.begin());
    const Environment env = sky.environment(512);
    const SunSplit split = split_of(env);
    EXPECT_TRUE(split.suns().empty());
    EXPECT_EQ(sky_pixels(split.rest(env)), sky_pixels(env));
}

TEST(WideSuns, DiscsHaveTheEnergyAndTheMomentOfWhatWasCutOut)
{
    // At the horizon, straight above, and where the search cannot make its map smaller.
    for (const auto& [elevation, width, height] : { std::array { 3, 256, 128 }, { 90, 256, 128 }, { 30, 250, 125 } }) {
        const Sky sky = glowing(at_angles(20, elevation), 0.5);
        std::mt19937 random(7);
        std::uniform_real_distribution<float> noise(0, 0.2f);
        OIIO::ImageBuf map(OIIO::ImageSpec(width, height, 3, OIIO::TypeFloat));
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const V3d light = sky.at(x, y, width, height);
                const float rgb[3] { float(light.x) + noise(random), float(light.y) + noise(random), float(light.z) };
                map.setpixel(x, y, rgb);
            }
        const SunSplit split = split_of(map);
        ASSERT_EQ(split.suns().size(), 5u) << elevation;
        const std::vector<float> all = sky_pixels(map), rest = sky_pixels(split.rest(map));
        Sums cut;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                V3d excess;
                for (int c = 0; c < 3; ++c) {
                    const size_t i = 3 * (size_t(y) * size_t(width) + size_t(x)) + size_t(c);
                    ASSERT_LE(rest[i], all[i]);
                    ASSERT_GE(rest[i], 0);
                    excess[c] = double(all[i]) - double(rest[i]);
                    ASSERT_EQ(float(double(rest[i]) + excess[c]), all[i]);
                }
                cut.energy += excess * (latlong::row_solid_angle(y, height) / width);
                cut.moment += brute::moment(x, y, width, height) * ((excess.x + excess.y + excess.z) / 3);
            }
        const Sums discs = sums_of(split.suns(), 0);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(discs.energy[c] / cut.energy[c], 1, 1e-6) << elevation;
        EXPECT_LT((discs.moment - cut.moment).length(), 2e-6 * cut.moment.length()) << elevation;
    }
}

TEST(WideSuns, AreTheSameAtAnySizeAndHoweverTheSkyIsTurned)
{
    const Sums first = sums_of(split_of(glowing(at_angles(123.4, 27.1), 0.5).environment(1024)).suns(), 1);
    struct Case
    {
        double azimuth, elevation;
        int width;
    };
    for (const Case& one : { Case { 123.4, 27.1, 512 },
                             { 123.4, 27.1, 600 },
                             { 0, 60, 512 },
                             { 179.9, 2, 512 },
                             { 77, 89.5, 512 },
                             { 45, -90, 512 },
                             { -60, -20, 300 } }) {
        const V3d direction = at_angles(one.azimuth, one.elevation);
        const SunSplit split = split_of(glowing(direction, 0.5).environment(one.width));
        ASSERT_EQ(split.suns().size(), 5u) << direction << ' ' << one.width;
        const Sums glow = sums_of(split.suns(), 1);
        EXPECT_LT(degrees_between(glow.moment.normalized(), direction), 0.3) << direction << ' ' << one.width;
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(glow.energy[c] / first.energy[c], 1, 0.01) << direction << ' ' << one.width;
    }
}
