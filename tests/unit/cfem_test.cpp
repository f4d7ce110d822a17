// SPDX-License-Identifier: Apache-2.0
#include "cfem_brute.h"

#include <vmlight/cfem.h>
#include <vmlight/cfem_exact.h>
#include <vmlight/cfem_kernel.h>
#include <vmlight/cfem_sh.h>
#include <vmlight/rotation.h>

#include <OpenImageIO/filesystem.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

using namespace vmlight;
using brute::center;
using brute::Map;
using brute::pi;
using brute::V3d;

namespace {

OIIO::ImageBuf image(const Map& map)
{
    OIIO::ImageBuf buf(OIIO::ImageSpec(map.width, map.height, 3, OIIO::TypeFloat));
    buf.set_pixels(buf.roi(), OIIO::TypeFloat, map.rgb.data());
    return buf;
}

CfemParams exact(int width, int height)
{
    CfemParams params;
    params.resolution = { width, height };
    return params;
}

CfemParams harmonics(int order, int width, int height)
{
    CfemParams params = exact(width, height);
    params.filter = "sh";
    params.order = order;
    return params;
}

Map filtered(const OIIO::ImageBuf& env, const CfemParams& params, int nthreads = 1)
{
    OIIO::ImageBuf dst;
    Map map(params.resolution.width, params.resolution.height);
    EXPECT_TRUE(make_cfem(dst, env, params, nthreads)) << dst.geterror();
    EXPECT_TRUE(dst.get_pixels(dst.roi(), OIIO::TypeFloat, map.rgb.data()));
    return map;
}

Map filtered(const Map& map, int width, int height)
{
    return filtered(image(map), exact(width, height));
}

std::string refusal(const OIIO::ImageBuf& env, const CfemParams& params = exact(4, 2))
{
    OIIO::ImageBuf dst(OIIO::ImageSpec(2, 2, 3, OIIO::TypeFloat));
    EXPECT_FALSE(make_cfem(dst, env, params, 1));
    EXPECT_EQ(dst.spec().width, 0) << "a failed filter left pixels";
    return dst.geterror();
}

// Light given by a function of direction, sampled at pixel centres.
template <class Light> Map sampled(int width, int height, Light&& light)
{
    Map map(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const V3d value = light(center(x, y, width, height));
            for (int k = 0; k < 3; ++k)
                map.at(x, y)[k] = float(value[k]);
        }
    return map;
}

Map random_map(int width, int height, unsigned seed)
{
    std::mt19937 random(seed);
    Map map(width, height);
    for (float& value : map.rgb)
        value = float(random() % 1000) / 1000;
    return map;
}

// Largest |cfem - want(n)| over all pixels and channels.
template <class Want> double largest_error(const Map& cfem, Want&& want)
{
    double worst = 0;
    for (int y = 0; y < cfem.height; ++y)
        for (int x = 0; x < cfem.width; ++x) {
            const V3d expected = want(center(x, y, cfem.width, cfem.height));
            for (int k = 0; k < 3; ++k)
                worst = std::max(worst, std::abs(cfem.at(x, y)[k] - expected[k]));
        }
    return worst;
}

double largest_difference(const Map& a, const Map& b)
{
    double worst = 0;
    for (size_t i = 0; i < a.rgb.size(); ++i)
        worst = std::max(worst, double(std::abs(a.rgb[i] - b.rgb[i])));
    return worst;
}

// A smooth light that no symmetry of the grid leaves alone.
V3d soft_light(const V3d& w)
{
    const V3d lobe = V3d(1, 2, -0.5).normalized();
    return { std::exp(2 * w.dot(lobe)), 1 + 0.8 * w.x * w.y, std::exp(-w.z) };
}

} // namespace

// Closed forms.

TEST(Cfem, ConstantSkyStaysConstantAtEverySize)
{
    const int sizes[][2] = { { 1, 1 }, { 2, 1 }, { 1, 7 }, { 3, 5 }, { 17, 9 }, { 4, 11 }, { 64, 32 } };
    const int results[][2] = { { 1, 1 }, { 3, 3 }, { 5, 2 }, { 8, 4 }, { 6, 5 }, { 7, 16 } };
    for (const auto& size : sizes)
        for (const auto& result : results)
            for (const float value : { 1.0f, 0.3f }) {
                const Map cfem = filtered(Map(size[0], size[1], value), result[0], result[1]);
                // Half an ulp of float.
                EXPECT_LT(largest_error(cfem, [&](const V3d&) { return V3d(value); }), 6e-8 * value)
                    << size[0] << "x" << size[1] << " to " << result[0] << "x" << result[1];
            }
}

TEST(Cfem, ConstantSkyStaysConstantAtTheEndsOfFloat)
{
    const float largest = std::numeric_limits<float>::max();
    for (const float value : { 0.0f, 1e-42f, 1e30f, largest }) {
        const Map cfem = filtered(Map(8, 4, value), 6, 3);
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
    V3d moment[3] = {};
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
    for (const auto& place : places) {
        Map map(64, 32, 1);
        std::fill_n(map.at(place[0], place[1]), 3, 1e6f);
        const double mean = brute::mean(map)[0];
        const Map cfem = filtered(map, 32, 16);
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 32; ++x) {
                const V3d n = center(x, y, 32, 16);
                const double want = 1 + (1e6 - 1) * brute::pixel_response(n, place[0], place[1], 64, 32, 256);
                const double whole = n.dot(brute::moment(place[0], place[1], 64, 32)) / pi;
                const bool cut = want != 1 && std::abs(want - 1 - (1e6 - 1) * whole) > 1e-9 * want;
                // Wholly seen or unseen: float's rounding and the quadrature of the background. Cut by the horizon:
                // the quadrature of the texel, kept below 5e-5 of the mean.
                EXPECT_NEAR(cfem.at(x, y)[0], want, (cut ? 6e-5 : 2e-6) * mean)
                    << place[0] << "," << place[1] << " at " << x << "," << y;
            }
    }
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

// What an environment may be.

TEST(Cfem, BorderSamplesReachHalfWayToTheirNeighbours)
{
    // Five samples at s = 0, 1/4, .. 1 and three at t = 0, 1/2, 1 are eight columns and four rows.
    const Map samples = random_map(5, 3, 11);
    Map cells(8, 4);
    const int column[8] = { 0, 1, 1, 2, 2, 3, 3, 4 }, row[4] = { 0, 1, 1, 2 };
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x)
            std::copy_n(samples.at(column[x], row[y]), 3, cells.at(x, y));
    OIIO::ImageBuf env = image(samples);
    env.specmod().attribute("oiio:sampleborder", 1);
    EXPECT_LT(largest_difference(filtered(env, exact(10, 5)), filtered(cells, 10, 5)), 1e-5);
    EXPECT_LT(largest_difference(filtered(env, harmonics(3, 10, 5)), filtered(image(cells), harmonics(3, 10, 5))),
              1e-6);
    OIIO::ImageBuf one = image(Map(1, 1, 2));
    one.specmod().attribute("oiio:sampleborder", 1);
    EXPECT_EQ(filtered(one, exact(2, 1)).rgb, Map(2, 1, 2).rgb);
}

TEST(Cfem, OneChannelServesAsAllThreeAndOthersAreIgnored)
{
    const Map map = random_map(12, 6, 5);
    OIIO::ImageSpec spec(12, 6, 5, OIIO::TypeFloat);
    spec.channelnames = { "A", "B", "G", "R", "Z" };
    OIIO::ImageBuf five(spec), gray(OIIO::ImageSpec(12, 6, 1, OIIO::TypeFloat));
    Map gray_map = map;
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 12; ++x) {
            const float* rgb = map.at(x, y);
            const float all[5] = { NAN, rgb[2], rgb[1], rgb[0], -1 };
            five.setpixel(x, y, all);
            gray.setpixel(x, y, rgb);
            std::fill_n(gray_map.at(x, y), 3, rgb[0]);
        }
    EXPECT_EQ(filtered(five, exact(8, 4)).rgb, filtered(map, 8, 4).rgb);
    EXPECT_EQ(filtered(gray, exact(8, 4)).rgb, filtered(gray_map, 8, 4).rgb);
}

TEST(Cfem, CroppedMapIsBlackOutsideItsPixels)
{
    Map map = random_map(16, 8, 6);
    OIIO::ImageSpec spec(16, 3, 3, OIIO::TypeFloat);
    spec.y = 2;
    spec.full_height = 8;
    OIIO::ImageBuf env(spec);
    env.set_pixels(env.roi(), OIIO::TypeFloat, map.at(0, 2));
    std::fill(map.rgb.begin(), map.rgb.begin() + 2 * 16 * 3, 0.0f);
    std::fill(map.rgb.begin() + 5 * 16 * 3, map.rgb.end(), 0.0f);
    EXPECT_EQ(filtered(env, exact(8, 4)).rgb, filtered(map, 8, 4).rgb);
}

TEST(Cfem, MapsAreReadFromFilesRowByRow)
{
    const std::string path = OIIO::Filesystem::temp_directory_path() + "/" + OIIO::Filesystem::unique_path() + ".exr";
    const Map map = random_map(70, 35, 8);
    ASSERT_TRUE(image(map).write(path));
    EXPECT_EQ(filtered(OIIO::ImageBuf(path), exact(8, 4)).rgb, filtered(map, 8, 4).rgb);
    OIIO::Filesystem::remove(path);
}

// What is refused, and what is mended.

TEST(Cfem, BadPixelsAreCountedAndRefused)
{
    Map map(64, 32, 1);
    map.at(31, 7)[1] = NAN;
    map.at(0, 8)[0] = INFINITY;
    map.at(1, 31)[2] = -0.25f;
    EXPECT_EQ(refusal(image(map)),
              "environment has 2 NaN or infinite and 1 negative values, the first at pixel (31, 7); "
              "--sanitize mends them");
    EXPECT_EQ(refusal(image(map), harmonics(3, 4, 2)), refusal(image(map)));
    Map one(4, 2, 1);
    one.at(3, 1)[0] = -1;
    EXPECT_EQ(refusal(image(one)),
              "environment has 1 negative value, the first at pixel (3, 1); --sanitize mends them");
}

TEST(Cfem, WrongImagesAndParametersAreRefused)
{
    OIIO::ImageSpec spec(4, 2, 2, OIIO::TypeFloat);
    spec.channelnames = { "Z", "A" };
    EXPECT_EQ(refusal(OIIO::ImageBuf(spec)), "environment: no channels R, G, B among Z, A");
    EXPECT_EQ(refusal(OIIO::ImageBuf()), "environment has no pixels");
    EXPECT_NE(refusal(OIIO::ImageBuf("no/such.exr")).find("no/such.exr"), std::string::npos);
    OIIO::ImageBuf vismap = image(Map(4, 2));
    vismap.specmod().attribute("vmlight:stage", "vismap");
    EXPECT_NE(refusal(vismap).find("a visibility map, not light"), std::string::npos);
    EXPECT_NE(refusal(image(Map(4, 2)), exact(0, 2)).find("resolution: "), std::string::npos);
    EXPECT_NE(refusal(image(Map(4, 2)), harmonics(65, 4, 2)).find("order: 65"), std::string::npos);
    CfemParams unknown;
    unknown.filter = "gauss";
    EXPECT_NE(refusal(image(Map(4, 2)), unknown).find("filter: \"gauss\""), std::string::npos);
}

TEST(Cfem, SanitizeMendsFromSoundNeighbours)
{
    Map bad = random_map(8, 4, 9), good = bad;
    const auto mean = [&](std::initializer_list<std::pair<int, int>> around, int k) {
        double sum = 0;
        for (const auto& p : around)
            sum += good.at(p.first, p.second)[k];
        return float(sum / double(around.size()));
    };
    bad.at(3, 2)[0] = NAN;
    good.at(3, 2)[0] = mean({ { 2, 1 }, { 3, 1 }, { 4, 1 }, { 2, 2 }, { 4, 2 }, { 2, 3 }, { 3, 3 }, { 4, 3 } }, 0);
    // Over the seam, in the top row, beside another bad pixel, which is not sound.
    bad.at(0, 0)[1] = INFINITY;
    bad.at(7, 0)[1] = -3;
    good.at(0, 0)[1] = mean({ { 1, 0 }, { 7, 1 }, { 0, 1 }, { 1, 1 } }, 1);
    good.at(7, 0)[1] = 0;
    CfemParams params = exact(8, 4);
    params.sanitize = true;
    EXPECT_EQ(filtered(image(bad), params).rgb, filtered(good, 8, 4).rgb);
    EXPECT_EQ(filtered(image(Map(3, 3, NAN)), params).rgb, Map(8, 4, 0).rgb);

    OIIO::ImageBuf dst;
    ASSERT_TRUE(make_cfem(dst, image(bad), params, 1));
    EXPECT_EQ(dst.spec().get_int_attribute("vmlight:sanitized"), 3);
    ASSERT_TRUE(make_cfem(dst, image(good), params, 1));
    EXPECT_EQ(dst.spec().find_attribute("vmlight:sanitized"), nullptr);
}

TEST(Cfem, ResultSaysWhatItIs)
{
    OIIO::ImageBuf env = image(Map(4, 2, 1)), dst;
    const float primaries[8] = { 0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f };
    env.specmod().attribute("colorInteropID", "lin_rec709_scene");
    env.specmod().attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), primaries);
    env.specmod().attribute("envmap", 1);
    ASSERT_TRUE(make_cfem(dst, env, exact(8, 4)));
    const OIIO::ImageSpec& spec = dst.spec();
    EXPECT_EQ(spec.format, OIIO::TypeFloat);
    EXPECT_EQ(spec.get_string_attribute("vmlight:stage"), "cfem");
    EXPECT_EQ(spec.get_string_attribute("vmlight:filter"), "exact");
    EXPECT_EQ(spec.get_string_attribute("vmlight:resolution"), "8x4");
    EXPECT_FALSE(spec.get_string_attribute("vmlight:version").empty());
    EXPECT_EQ(spec.get_string_attribute("oiio:updirection"), "y");
    EXPECT_EQ(spec.get_string_attribute("colorInteropID"), "lin_rec709_scene");
    const OIIO::ParamValue* chromaticities = spec.find_attribute("chromaticities");
    ASSERT_NE(chromaticities, nullptr);
    EXPECT_EQ(std::memcmp(chromaticities->data(), primaries, sizeof primaries), 0);
    EXPECT_EQ(spec.find_attribute("oiio:ColorSpace"), nullptr);
    EXPECT_EQ(spec.find_attribute("envmap"), nullptr);
}

// How the work is done.

TEST(Cfem, SamePixelsForAnyNumberOfThreads)
{
    Map map = random_map(300, 150, 12);
    map.at(17, 60)[2] = 1e5f;
    for (const CfemParams& params : { exact(32, 16), exact(31, 9), harmonics(9, 32, 16) }) {
        const Map one = filtered(image(map), params, 1);
        EXPECT_EQ(filtered(image(map), params, 2).rgb, one.rgb);
        EXPECT_EQ(filtered(image(map), params, 7).rgb, one.rgb);
    }
}

TEST(Cfem, ProgressRisesToOneAndStopsTheWork)
{
    const OIIO::ImageBuf env = image(random_map(600, 300, 13));
    for (const CfemParams& params : { exact(16, 8), harmonics(4, 16, 8) }) {
        OIIO::ImageBuf dst;
        double last = 0;
        ASSERT_TRUE(make_cfem(dst, env, params, 1, [&](double done) {
            EXPECT_GE(done, last);
            last = done;
            return true;
        }));
        EXPECT_DOUBLE_EQ(last, 1);
        EXPECT_FALSE(make_cfem(dst, env, params, 1, [](double done) { return done < 0.5; }));
        EXPECT_EQ(dst.geterror(), "interrupted");
        EXPECT_EQ(dst.spec().width, 0);
    }
}

TEST(Cfem, VectorKernelAgreesWithScalar)
{
    std::mt19937 random(2);
    const auto number = [&] { return double(random()) / double(std::mt19937::max()) * 2 - 1; };
    std::vector<PrefixCell> cells(66);
    for (PrefixCell& cell : cells)
        for (int i = 0; i < 4; ++i)
            cell.zero[i] = number(), cell.slope[i] = number(), cell.cosine[i] = number(), cell.sine[i] = number();
    std::vector<ColumnAngle> columns(33);
    for (int c = 0; c < 33; ++c)
        columns[c] = { number(), number(), number() };
    std::vector<ColumnSum> scalar(33), vector(33);
    for (int repeat = 0; repeat < 100; ++repeat) {
        const ArcRun run { repeat % 5, 33 - repeat % 7, { int64_t(random()), 0 }, int64_t(1) << 32,
                           number(),   number(),        { number(), number() } };
        add_arcs_scalar(scalar.data(), &cells[1], columns.data(), run);
        add_arcs(vector.data(), &cells[1], columns.data(), run);
    }
    // Each of 500 additions of at most 2 rounds once, or twice where multiplication is apart: below 1000 ulps of the
    // largest sum, 64.
    for (int c = 0; c < 33; ++c)
        for (int i = 0; i < 8; ++i)
            EXPECT_NEAR((&scalar[c].half[0][0])[i], (&vector[c].half[0][0])[i], 1000 * 64 * 2.2e-16);
}

// Spherical harmonics.

namespace {

// The first nine in closed form, in the frame of latlong.h, by (l, m) at l^2 + l + m. With phi = 2 pi s,
// sin theta cos phi = -z and sin theta sin phi = x.
std::array<double, 9> nine_harmonics(const V3d& w)
{
    const double one = std::sqrt(3 / (4 * pi)), two = std::sqrt(15 / (4 * pi));
    return { std::sqrt(1 / (4 * pi)),
             one * w.x,
             one * w.y,
             one * -w.z,
             two * w.x * -w.z,
             two * w.y * w.x,
             std::sqrt(5 / (16 * pi)) * (3 * w.y * w.y - 1),
             two * w.y * -w.z,
             two / 2 * (w.z * w.z - w.x * w.x) };
}

// Red of the coefficients measured for the light in Grace Cathedral: Ramamoorthi and Hanrahan, 2001.
constexpr double kGrace[9] = { .79, .39, -.34, -.29, -.11, -.26, -.16, .56, .21 };

} // namespace

TEST(CfemHarmonics, NineCoefficientsComeBackAndFilterByTheirBands)
{
    const Map map = sampled(512, 256, [](const V3d& w) {
        const std::array<double, 9> y = nine_harmonics(w);
        double sum = 3; // so that nothing is negative
        for (int i = 0; i < 9; ++i)
            sum += kGrace[i] * y[i];
        return V3d(sum);
    });
    const auto read = [&](int row, float* rgb) {
        std::copy_n(map.at(0, row), 3 * map.width, rgb);
        return true;
    };
    std::vector<double> c;
    ASSERT_TRUE(project_harmonics(c, 5, { 512, 256, false }, read, 1, {}));
    // Constant pixels stand for a harmonic to the square of their size.
    for (int i = 0; i < 25; ++i)
        EXPECT_NEAR(c[3 * i + 1], (i < 9 ? kGrace[i] : 0) + (i == 0 ? 3 * std::sqrt(4 * pi) : 0), 5e-5) << i;

    const Map cfem = filtered(image(map), harmonics(3, 32, 16));
    EXPECT_LT(largest_error(cfem,
                            [](const V3d& n) {
                                const double band[3] = { 1, 2.0 / 3, 0.25 };
                                const std::array<double, 9> y = nine_harmonics(n);
                                double sum = 3;
                                for (int i = 0; i < 9; ++i)
                                    sum += band[i < 1 ? 0 : i < 4 ? 1 : 2] * kGrace[i] * y[i];
                                return V3d(sum);
                            }),
              5e-5);
    EXPECT_LT(largest_difference(cfem, filtered(map, 32, 16)), 5e-5);
}

TEST(CfemHarmonics, BandsScaleByTheCosineLobesSpectrum)
{
    const double want[] = { 1, 2.0 / 3, 0.25, 0, -1.0 / 24, 0, 1.0 / 64, 0, -1.0 / 128, 0, 7.0 / 1536 };
    for (int l = 0; l < 11; ++l)
        EXPECT_NEAR(cosine_eigenvalue(l), want[l], 1e-15) << l;
}

TEST(CfemHarmonics, HighBandsAreOrthonormal)
{
    // One harmonic in, one out. 256 rows sample band 40 with an error of (40 pi / 256)^2 / 12 or so.
    const int order = 64;
    std::vector<double> in(3 * order * order), rgb, out;
    in[3 * (40 * 40 + 40 + 17)] = 1;
    in[3 * (63 * 63 + 63 - 63) + 1] = 1;
    evaluate_harmonics(rgb, { 256, 128 }, in, order, 2);
    const auto read = [&](int row, float* pixels) {
        std::copy_n(&rgb[3 * 256 * row], 3 * 256, pixels);
        return true;
    };
    ASSERT_TRUE(project_harmonics(out, order, { 256, 128, false }, read, 2, {}));
    for (size_t i = 0; i < in.size(); ++i)
        EXPECT_NEAR(out[i], in[i], 0.15) << i / 3;
}

TEST(CfemHarmonics, RingBelowZeroUnderASun)
{
    Map map(64, 32);
    std::fill_n(map.at(10, 10), 3, 1e4f);
    const Map cfem = filtered(image(map), harmonics(3, 32, 16));
    EXPECT_LT(*std::min_element(cfem.rgb.begin(), cfem.rgb.end()), -0.05 * brute::mean(map)[0]);
}
