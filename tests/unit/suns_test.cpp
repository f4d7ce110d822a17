// SPDX-License-Identifier: Apache-2.0
// Environments are split into suns and a rest without loss, and into none where there is none.
#include "cfem_brute.h"
#include "split_sky.h"

#include <vmlight/cfem/stack.h>
#include <vmlight/cfem/suns.h>

#include <OpenImageIO/imagebuf.h>

#include <gtest/gtest.h>

#include <random>

using namespace vmlight;
using namespace vmlight::sun_sky;

TEST(Suns, ASunKeepsItsPlaceItsWidthAndItsLight)
{
    for (const double half_angle : { 0.265, 1.0, 3.0 }) {
        const V3d direction = at_angles(40, 35);
        const SunSplit split = split_of(one_sun(direction, half_angle).environment(1024));
        ASSERT_EQ(split.suns().size(), 1u) << half_angle;
        const Sun& sun = split.suns()[0];
        EXPECT_LT(degrees_between(sun.disc.direction, direction), 0.02);
        // Each pixel spreads the light that falls into it evenly: its position varies by p^2 / 12 twice, each way.
        const double p = 180.0 / 512, spread = 2 * p * p / 3 * (1 + std::pow(std::cos(35 * M_PI / 180), 2)) / 2;
        EXPECT_NEAR(sun.disc.half_angle * 180 / M_PI, std::sqrt(half_angle * half_angle + spread),
                    0.02 * half_angle + 0.01);
        for (size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(sun.color[c] * M_PI / (12 - 2.0 * double(c)), 1, 0.01) << c;
        EXPECT_NEAR(split.share(), 30 / (30 + 4 * M_PI * 3), 0.002);
    }
}

TEST(Suns, ADiscHasTheEnergyAndTheMomentOfWhatWasCutOut)
{
    constexpr int width = 256, height = 128;
    std::mt19937 random(5);
    std::uniform_real_distribution<float> noise(0, 1);
    OIIO::ImageBuf map(OIIO::ImageSpec(width, height, 3, OIIO::TypeFloat));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float rgb[3] { noise(random), noise(random), noise(random) };
            map.setpixel(x, y, rgb);
        }
    for (const auto& [x, y] : { std::pair(100, 40), { 101, 40 }, { 100, 41 }, { 102, 42 } }) {
        const float rgb[3] { 9e3f + 1e3f * float(x - 100), 7e3f, 5e3f * noise(random) };
        map.setpixel(x, y, rgb);
    }
    const SunSplit split = split_of(map);
    ASSERT_EQ(split.suns().size(), 1u);
    const std::vector<float> all = sky_pixels(map), rest = sky_pixels(split.rest(map));
    V3d moment(0), energy(0);
    int64_t cut = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            V3d excess;
            for (int c = 0; c < 3; ++c) {
                const size_t i = 3 * (size_t(y) * width + size_t(x)) + size_t(c);
                ASSERT_LE(rest[i], all[i]);
                ASSERT_GE(rest[i], 0);
                excess[c] = double(all[i]) - double(rest[i]);
                ASSERT_EQ(float(double(rest[i]) + excess[c]), all[i]);
            }
            cut += excess.length() > 0;
            energy += excess * (latlong::row_solid_angle(y, height) / width);
            moment += brute::moment(x, y, width, height) * ((excess.x + excess.y + excess.z) / 3);
        }
    EXPECT_LT(cut, 100);
    const Sun& sun = split.suns()[0];
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(sun.color[size_t(c)] * M_PI / energy[c], 1, 1e-6);
    const double mean = (energy.x + energy.y + energy.z) / 3;
    const V3d of_disc = sun.disc.direction * (mean * disc_mean_length(sun.disc.half_angle));
    EXPECT_LT((of_disc - moment).length(), 1e-6 * moment.length());
    // The background of uniform noise: its median.
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(rest[3 * (40 * width + 100) + size_t(c)], 0.5, 0.2);
}

TEST(Suns, WhatASurfaceReceivesIsThatOfTheRestAndTheSun)
{
    const Environment env = one_sun(at_angles(-70, 50), 0.5, 0.2).environment(1024);
    const SunSplit split = split_of(env);
    ASSERT_EQ(split.suns().size(), 1u);
    OIIO::ImageBuf all, rest;
    ASSERT_TRUE(make_cfem(all, env)) << all.geterror();
    ASSERT_TRUE(make_cfem(rest, split.rest(env))) << rest.geterror();
    const Sun& sun = split.suns()[0];
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 128; ++x) {
            const V3d n = latlong::direction((x + 0.5) / 128, (y + 0.5) / 64);
            const double facing = n.dot(sun.disc.direction);
            if (std::abs(facing) < 0.25) // of what was cut out, a part may be below the horizon
                continue;
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(all.getchannel(x, y, 0, c),
                            rest.getchannel(x, y, 0, c)
                                + sun.color[size_t(c)] * std::max(0.0, facing) * disc_mean_length(sun.disc.half_angle),
                            1e-4);
        }
}

TEST(Suns, TwoSunsStayTwoAndKeepTheirColours)
{
    for (const double apart : { 8.0, 30.0, 170.0 }) {
        const Sky sky {
            gray_sky, { { at_angles(10, 40), 0.3, V3d(20, 4, 1) }, { at_angles(10 + apart, 40), 0.6, V3d(1, 3, 15) } }
        };
        const SunSplit split = split_of(sky.environment(1024));
        ASSERT_EQ(split.suns().size(), 2u) << apart;
        for (size_t k = 0; k < 2; ++k) {
            EXPECT_LT(degrees_between(split.suns()[k].disc.direction, sky.lights[k].direction), 0.05) << apart;
            for (size_t c = 0; c < 3; ++c)
                EXPECT_NEAR(split.suns()[k].color[c] * M_PI / sky.lights[k].energy[int(c)], 1, 0.02) << apart;
        }
    }
}

// Lamps of one room are split off together; beside a sun, or alone, one of them stays.
TEST(Suns, FurtherLightsMayBeWeaker)
{
    const double all = 4 * M_PI; // of the gray sky, about
    const Light sun { at_angles(0, 50), 0.3, V3d(all), 0 }, lamp { at_angles(90, 40), 1, V3d(0.05 * all), 0 };
    Sky room { gray_sky, { lamp } };
    for (const double azimuth : { 150.0, 200.0, 250.0 })
        room.lights.push_back({ at_angles(azimuth, 30), 1, V3d(0.015 * all), 0 });
    EXPECT_EQ(split_of(room.environment(512)).suns().size(), 4u);
    room.lights[0] = sun;
    EXPECT_EQ(split_of(room.environment(512)).suns().size(), 1u);
    room.lights.erase(room.lights.begin());
    EXPECT_TRUE(split_of(room.environment(512)).suns().empty());
}

TEST(Suns, SkiesWithoutSunsStayAsTheyAre)
{
    const auto none = [](double) { return V3d(0); };
    const auto bright_horizon = [](double y) { return V3d(1, 1, 2) * (0.2 + 5 * std::exp(-40 * y * y)); };
    // A cloud that the sun is behind; a sun of a fiftieth of the light.
    const Sky cloud { gray_sky, { { at_angles(0, 50), 20, V3d(6), 0 } } };
    const Sky weak { gray_sky, { { at_angles(0, 50), 0.3, V3d(0.25), 0 } } };
    for (const Sky& sky : { Sky { none, {} }, Sky { gray_sky, {} }, Sky { bright_horizon, {} }, cloud, weak }) {
        const Environment env = sky.environment(512);
        const SunSplit split = split_of(env);
        EXPECT_TRUE(split.suns().empty());
        EXPECT_EQ(split.share(), 0);
        EXPECT_EQ(sky_pixels(split.rest(env)), sky_pixels(env));
    }
    for (const int width : { 2, 4, 16 }) // too coarse to hold a sun
        EXPECT_TRUE(split_of(one_sun(at_angles(0, 50)).environment(width)).suns().empty());
}

TEST(Suns, RealSkies)
{
    const auto suns = [](const char* name) {
        const OIIO::ImageBuf map(std::string(VMLIGHT_TEST_DATA "/") + name);
        return split_of(map);
    };
    const SunSplit sunny = suns("kloppenheim_05.hdr");
    ASSERT_EQ(sunny.suns().size(), 1u);
    EXPECT_NEAR(sunny.suns()[0].disc.direction.y, 0.965, 0.002);
    EXPECT_NEAR(sunny.share(), 0.64, 0.01);
    EXPECT_LT(sunny.suns()[0].disc.half_angle * 180 / M_PI, 1);
    EXPECT_TRUE(suns("forest_slope.hdr").suns().empty());
    EXPECT_GE(suns("studio_small_03.hdr").suns().size(), 1u);
}

TEST(Suns, BadPixelsAreRefusedOrRepairedAsByTheFilter)
{
    OIIO::ImageBuf map(OIIO::ImageSpec(64, 32, 3, OIIO::TypeFloat));
    const float gray[3] { 1, 1, 1 }, sun[3] { 5e3f, 5e3f, 5e3f }, bad[3] { NAN, 1, -1 };
    OIIO::ImageBuf::Iterator<float> pixel(map);
    for (; !pixel.done(); ++pixel)
        for (int c = 0; c < 3; ++c)
            pixel[c] = gray[c];
    map.setpixel(20, 10, sun);
    map.setpixel(21, 10, bad);
    SunSplit split;
    std::string error;
    OIIO::ImageBuf filtered;
    EXPECT_FALSE(split.find(map, false, error));
    EXPECT_FALSE(make_cfem(filtered, map));
    EXPECT_EQ(error, filtered.geterror());
    ASSERT_TRUE(split.find(map, true, error)) << error;
    EXPECT_EQ(split.bad_values(), 2);
    ASSERT_EQ(split.suns().size(), 1u);
    for (const float value : sky_pixels(split.rest(map)))
        ASSERT_TRUE(value >= 0 && value < 1.001f) << value;
}

TEST(Suns, TheirTextIsReadBack)
{
    const std::vector<Sun> suns { { { at_angles(10, 20), 0.0047 }, { 1.25, 3e-5, 7e8 } },
                                  { { at_angles(-10, -20), 0.2 }, { -0.01, 0, 1 } } };
    std::vector<Sun> read;
    std::string error;
    ASSERT_TRUE(parse_suns(read, suns_text(suns), error)) << error;
    ASSERT_EQ(read.size(), 2u);
    for (size_t k = 0; k < 2; ++k) {
        EXPECT_LT((read[k].disc.direction - suns[k].disc.direction).length(), 1e-9);
        EXPECT_NEAR(read[k].disc.half_angle, suns[k].disc.half_angle, 1e-9);
        for (size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(read[k].color[c], suns[k].color[c], 1e-9 * std::abs(suns[k].color[c]));
    }
    EXPECT_TRUE(parse_suns(read, "", error));
    EXPECT_TRUE(read.empty());
    for (const char* text : { "auto", "0 1 0 1 2 3", "0 2 0 1 1 1 1", "0 1 0 100 1 1 1", "0 1 0 1 1 1 nan",
                              "0 1 0 1 1 1 1 1", "0 1 0 1 1 1 1;;" })
        EXPECT_FALSE(parse_suns(read, text, error)) << text;
}
