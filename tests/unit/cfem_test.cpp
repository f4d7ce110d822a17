// SPDX-License-Identifier: Apache-2.0
#include "cfem_maps.h"

#include <vmlight/cfem/exact.h>
#include <vmlight/math/rotation.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

using namespace cfem_maps;

// Closed forms.

TEST(Cfem, ConstantSkyStaysConstantAtEverySize)
{
    const int sizes[][2] = { { 1, 1 }, { 2, 1 }, { 1, 7 }, { 3, 5 }, { 17, 9 }, { 4, 11 }, { 64, 32 } };
    const int results[][2] = { { 1, 1 }, { 3, 3 }, { 5, 2 }, { 8, 4 }, { 6, 5 }, { 7, 16 } };
    for (const auto& size : sizes)
        for (const auto& result : results)
            for (const float value : { 1.0f, 0.3f }) {
                const Map cfem = filtered_anyway(Map(size[0], size[1], value), result[0], result[1]);
                // Half an ulp of float.
                EXPECT_LT(largest_error(cfem, [&](const V3d&) { return V3d(value); }), 6e-8 * value)
                    << size[0] << "x" << size[1] << " to " << result[0] << "x" << result[1];
            }
}

TEST(Cfem, ConstantSkyStaysConstantAtTheEndsOfFloat)
{
    const float largest = std::numeric_limits<float>::max();
    for (const float value : { 0.0f, 1e-42f, 1e30f, largest }) {
        const Map cfem = filtered_anyway(Map(8, 4, value), 6, 3);
        for (const float result : cfem.rgb)
            EXPECT_NEAR(result, value, std::max(double(value) * 1.2e-7, 1.5e-45));
    }
}

TEST(Cfem, LinearLightKeepsTwoThirdsOfItsSlope)
{
    // C of a + b.w is a + (2/3) b.n. Constant pixels stand for the slope to the square of their size: 5e-5 here.
    const V3d slope(0.3, -0.4, 0.5);
    const Map cfem = filtered(sampled(256, 128, [&](const V3d& w) { return V3d(1 + slope.dot(w)); }), 32, 16);
    EXPECT_LT(largest_error(cfem, [&](const V3d& n) { return V3d(1 + slope.dot(n) * 2 / 3); }), 5e-5);
}

TEST(Cfem, HalfBrightSkyFallsAsOnePlusCosine)
{
    // The halves end at pixel edges, so nothing but quadrature is in the error.
    const auto half
        = [](const V3d& axis) { return sampled(64, 32, [&](const V3d& w) { return V3d(w.dot(axis) > 0 ? 1 : 0); }); };
    for (const V3d& axis : { V3d(0, 1, 0), V3d(0, -1, 0), V3d(1, 0, 0), V3d(-1, 0, 0), V3d(0, 0, 1) })
        EXPECT_LT(largest_error(filtered(half(axis), 32, 16), [&](const V3d& n) { return V3d((1 + n.dot(axis)) / 2); }),
                  2e-6)
            << axis;
}

TEST(Cfem, SunDiscLightsByItsSineSquaredTimesCosine)
{
    // A disc of half-angle alpha, wholly above the horizon: C = L sin^2 alpha cos gamma. Pixels hold the share of their
    // area that the disc covers, by 8 x 64 points; 1e-3 of the peak is what that coverage is good for.
    const double alpha = 0.17;
    for (const V3d& axis : { V3d(0.05, 1, -0.02), V3d(0, 0.6, -0.8), V3d(0.64, -0.6, 0.48) }) { // pole, seam, neither
        const V3d sun = axis.normalized();
        Map map(256, 128);
        for (int y = 0; y < 128; ++y)
            for (int x = 0; x < 256; ++x) {
                const double angle = std::acos(sun.dot(center(x, y, 256, 128)));
                double inside = angle < alpha ? 1 : 0, all = 1;
                if (std::abs(angle - alpha) < 1.5 * pi / 128) { // the edge may cross the pixel
                    inside = all = 0;
                    for (int i = 0; i < 512; ++i) {
                        const double t = (y + (i / 8 + 0.5) / 64) / 128, weight = std::sin(pi * t);
                        const V3d w = latlong::direction((x + (i % 8 + 0.5) / 8) / 256, t);
                        inside += w.dot(sun) > std::cos(alpha) ? weight : 0;
                        all += weight;
                    }
                }
                std::fill_n(map.at(x, y), 3, float(inside / all));
            }
        const Map cfem = filtered(map, 32, 16);
        const brute::Filter truth(map, 4);
        const double peak = std::sin(alpha) * std::sin(alpha);
        EXPECT_LT(largest_error(cfem,
                                [&](const V3d& n) {
                                    const double up = n.dot(sun);
                                    if (std::abs(up) < std::sin(alpha + pi / 128)) // the horizon cuts it
                                        return truth(n);
                                    return V3d(std::max(0.0, up) * peak);
                                }),
                  1e-3 * peak)
            << sun;
    }
}

TEST(Cfem, CosineLobeFilteredByCosineLobe)
{
    // C(g) = (2 / 3 pi) [(pi - g) cos g + sin g] at angle g from the lobe's axis.
    const V3d axis = V3d(2, -1, 1).normalized();
    const Map cfem = filtered(sampled(256, 128, [&](const V3d& w) { return V3d(std::max(0.0, w.dot(axis))); }), 32, 16);
    EXPECT_LT(largest_error(cfem,
                            [&](const V3d& n) {
                                const double g = std::acos(n.dot(axis));
                                return V3d(2 / (3 * pi) * ((pi - g) * std::cos(g) + std::sin(g)));
                            }),
              5e-5);
}

// Laws.

TEST(Cfem, OppositeDirectionsDifferByTheFirstMoment)
{
    // C(n) - C(-n) = n.M / pi, for any light: M summed here from the pixels' closed forms.
    Map map = random_map(40, 20, 1);
    map.at(39, 3)[1] = 1e5f;
    V3d moment[3] = { V3d(0), V3d(0), V3d(0) };
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 40; ++x)
            for (int k = 0; k < 3; ++k)
                moment[k] += brute::moment(x, y, 40, 20) * map.at(x, y)[k];
    const V3d mean = brute::mean(map);
    const Map cfem = filtered(map, 24, 12);
    for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 24; ++x)
            for (int k = 0; k < 3; ++k) {
                const double got = double(cfem.at(x, y)[k]) - cfem.at((x + 12) % 24, 11 - y)[k];
                EXPECT_NEAR(got, center(x, y, 24, 12).dot(moment[k]) / pi, 2e-6 * mean[k]);
            }
}

TEST(Cfem, MeanIsKeptAndFirstMomentIsTwoThirds)
{
    // What is left is the error of summing C over the centres of 128x64 pixels.
    const Map map = sampled(64, 32, soft_light), cfem = filtered(map, 128, 64);
    const V3d mean = brute::mean(map);
    EXPECT_LT((brute::mean(cfem) - mean).length(), 2e-4 * mean.length());
    for (int k = 0; k < 3; ++k) {
        V3d light(0), filter(0);
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 128; ++x) {
                filter += brute::moment(x, y, 128, 64) * cfem.at(x, y)[k];
                light += brute::moment(x / 2, y / 2, 64, 32) / 4 * map.at(x / 2, y / 2)[k];
            }
        // A quarter of a pixel's moment is not that of each of its quarters, but summed over the four it is.
        EXPECT_LT((filter - light * 2 / 3).length(), 1e-3 * mean[k]);
    }
}

TEST(Cfem, OneHotTexelLightsAsItsAreaDoes)
{
    // At the poles, on the seam, on the equator, elsewhere; over light of 1.
    const int places[][2] = { { 0, 0 }, { 20, 0 }, { 0, 13 }, { 63, 15 }, { 31, 16 }, { 40, 9 }, { 5, 31 } };
    for (const auto& place : places)
        each_light_of_hot_texel(place[0], place[1], [&](const HotTexelLight& light) {
            const double whole = light.normal.dot(brute::moment(place[0], place[1], 64, 32)) / pi;
            const bool cut = light.truth != 1 && std::abs(light.truth - 1 - (1e6 - 1) * whole) > 1e-9 * light.truth;
            // Wholly seen or unseen: float's rounding and the quadrature of the background. Cut by the horizon: the
            // quadrature of the texel, kept below 5e-5 of the mean.
            EXPECT_NEAR(light.filtered, light.truth, (cut ? 6e-5 : 2e-6) * light.mean)
                << place[0] << "," << place[1] << " seen along " << light.normal;
        });
}

TEST(Cfem, AgreesWithTheSumOverAllTexelsAtEverySize)
{
    const int results[][2] = { { 1, 1 }, { 3, 3 }, { 5, 2 }, { 2, 5 }, { 16, 8 }, { 15, 9 } };
    for (const auto& size : { Size { 24, 12 }, Size { 7, 5 }, Size { 5, 8 } }) {
        const Map map = random_map(size.width, size.height, 7);
        for (const auto& result : results)
            EXPECT_LT(largest_error(filtered(map, result[0], result[1]), brute::Filter(map, 32)), 5e-5)
                << result[0] << "x" << result[1];
    }
}

TEST(Cfem, TurningTheSkyTurnsTheFilteredSky)
{
    // C of L(R w) at n is C of L at R n. Both maps sample the light with 1/128 of a turn: 2e-3 of the light's range.
    const Map map = sampled(128, 64, soft_light);
    const brute::Filter truth(map, 4);
    Rotation odd;
    std::string error;
    ASSERT_TRUE(rotation_from_quaternion(odd, { 1, 0.3, -0.2, 0.1 }, error));
    Rotation cyclic;
    ASSERT_TRUE(rotation_from_quaternion(cyclic, { 1, 1, 1, 1 }, error)); // 120 degrees about (1,1,1)
    for (const Rotation& r : { rotation_from_angles(90, 0, 0), rotation_from_angles(0, 0, 180), cyclic, odd }) {
        const Map turned = filtered(sampled(128, 64, [&](const V3d& w) { return soft_light(rotate(r, w)); }), 12, 6);
        EXPECT_LT(largest_error(turned, [&](const V3d& n) { return truth(rotate(r, n)); }), 5e-4);
    }
}

TEST(Cfem, ShiftsAndMirrorsCarryOver)
{
    const Map map = random_map(48, 24, 3), cfem = filtered(map, 16, 8);
    Map shifted = map, left_right = map, up_down = map;
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 48; ++x) {
            std::copy_n(map.at(x, y), 3, shifted.at((x + 9) % 48, y)); // three pixels of the result
            std::copy_n(map.at(x, y), 3, left_right.at(47 - x, y));
            std::copy_n(map.at(x, y), 3, up_down.at(x, 23 - y));
        }
    const Map a = filtered(shifted, 16, 8), b = filtered(left_right, 16, 8), c = filtered(up_down, 16, 8);
    double worst = 0;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 16; ++x)
            for (int k = 0; k < 3; ++k) {
                worst = std::max<double>(worst, std::abs(a.at((x + 3) % 16, y)[k] - cfem.at(x, y)[k]));
                worst = std::max<double>(worst, std::abs(b.at(15 - x, y)[k] - cfem.at(x, y)[k]));
                worst = std::max<double>(worst, std::abs(c.at(x, 7 - y)[k] - cfem.at(x, y)[k]));
            }
    // An ulp of float; up and down also differ by what a row knows of the light above it.
    EXPECT_LT(worst, 1e-6);
}

TEST(Cfem, LightAdds)
{
    const Map a = random_map(32, 16, 4), b = sampled(32, 16, soft_light);
    Map sum = a;
    for (size_t i = 0; i < sum.rgb.size(); ++i)
        sum.rgb[i] = 2 * a.rgb[i] + 3 * b.rgb[i];
    const Map ca = filtered(a, 16, 8), cb = filtered(b, 16, 8), cs = filtered(sum, 16, 8);
    for (size_t i = 0; i < cs.rgb.size(); ++i)
        EXPECT_NEAR(cs.rgb[i], 2 * ca.rgb[i] + 3 * cb.rgb[i], 2e-5 * cs.rgb[i]);
}

TEST(Cfem, NothingIsDarkerOrBrighterThanTheLight)
{
    for (unsigned seed = 0; seed < 4; ++seed) {
        Map map = random_map(20 + seed, 10, seed);
        map.at(int(seed), 4)[0] = 1e6f;
        const Map cfem = filtered(map, 16 - seed, 8);
        for (int k = 0; k < 3; ++k) {
            float low = 1e9f, high = 0;
            for (size_t i = k; i < map.rgb.size(); i += 3) {
                low = std::min(low, map.rgb[i]);
                high = std::max(high, map.rgb[i]);
            }
            for (size_t i = k; i < cfem.rgb.size(); i += 3) {
                EXPECT_GE(cfem.rgb[i], low * (1 - 1e-6f));
                EXPECT_LE(cfem.rgb[i], high * (1 + 1e-6f));
            }
        }
    }
}

TEST(Cfem, OnlyRoundingFallsBelowZero)
{
    for (const double sun : { 1.0, 1e6, 1e8, 1e30 })
        for (const auto& result : { Size { 64, 32 }, Size { 33, 16 } })
            for (const auto& place : { V3d(0, 0, 0), V3d(100, 30, 0), V3d(255, 64, 0) }) {
                Map map(256, 128);
                std::fill_n(map.at(int(place.x), int(place.y)), 3, float(sun));
                const auto read = [&](int row, float* rgb) {
                    std::copy_n(map.at(0, row), 3 * 256, rgb);
                    return true;
                };
                std::vector<double> rgb;
                ASSERT_TRUE(filter_exact(rgb, result, { 256, 128, false }, read, 1, {}));
                EXPECT_GT(*std::min_element(rgb.begin(), rgb.end()), -1e-9 * brute::mean(map)[0]);
            }
}

TEST(Cfem, FaintLightSurvivesBesideTheSun)
{
    Map map(256, 128, 1e-3f);
    std::fill_n(map.at(37, 50), 3, 1e8f);
    const V3d sun = center(37, 50, 256, 128);
    const Map cfem = filtered(map, 32, 16);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 32; ++x) {
            const bool faces_away = sun.dot(center(x, y, 32, 16)) < -0.05;
            EXPECT_NEAR(faces_away ? cfem.at(x, y)[0] : 1e-3, 1e-3, 1e-8);
        }
}
