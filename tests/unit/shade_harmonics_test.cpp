// SPDX-License-Identifier: Apache-2.0
// The kernel of `sh`: every instruction set against the scalar form, and that against sums in double.
#include "instruction_sets.h"

#include <vmlight/lightmap/brightest_light.h>
#include <vmlight/lightmap/harmonic_sums.h>

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <cstring>
#include <random>

using namespace vmlight;

namespace {

const ShadeSetup kPlainSetup { { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, 1.5f };
constexpr int kHarmonicTexels = 211;

HarmonicLight random_light(int bands, std::mt19937& random)
{
    std::normal_distribution<float> normal;
    HarmonicLight light;
    light.count = bands * bands;
    for (int k = 0; k < light.count; ++k)
        for (int c = 0; c < 4; ++c)
            light.coefficients.push_back(c < 3 ? normal(random) : 0);
    light.brightest[0] = 2, light.brightest[1] = 3, light.brightest[2] = 4;
    return light;
}

std::vector<float> random_texels(int count, std::mt19937& random)
{
    std::normal_distribution<float> normal;
    std::vector<float> texels;
    for (int i = 0; i < kHarmonicTexels * count; ++i)
        texels.push_back(i % count == 0 ? std::abs(normal(random)) : normal(random));
    return texels;
}

} // namespace

TEST(ShadeHarmonics, ATexelIsTheSumOfItsNumbersTimesTheLights)
{
    std::mt19937 random(5);
    const HarmonicLight light = random_light(5, random);
    const std::vector<float> texels = random_texels(light.count, random);
    std::vector<float> rgb(3 * kHarmonicTexels);
    EXPECT_EQ(shade_harmonics_scalar(light, kPlainSetup, texels.data(), kHarmonicTexels, rgb.data()),
              std::none_of(texels.begin(), texels.end(), [&](const float& v) {
                  return (&v - texels.data()) % light.count == 0 && v > kLargestVisibility;
              }));
    int within = 0;
    for (int i = 0; i < kHarmonicTexels; ++i)
        for (int c = 0; c < 3; ++c) {
            double sum = 0;
            for (int k = 0; k < light.count; ++k)
                sum += double(texels[size_t(i * light.count + k)]) * double(light.coefficients[size_t(4 * k + c)]);
            const double most = double(light.brightest[c]) * 1.5, expected = std::clamp(1.5 * sum, 0.0, most);
            within += expected == 1.5 * sum;
            EXPECT_NEAR(double(rgb[size_t(3 * i + c)]), expected, 2e-5 * most);
        }
    EXPECT_GT(within, 50); // neither dark nor held to the brightest
}

TEST(ShadeHarmonics, EveryInstructionSetGivesTheBitsOfTheScalarForm)
{
    std::mt19937 random(7);
    with_each_instruction_set([&](const char* instruction_set) {
        for (const int bands : { 3, 4, 5, 8 }) {
            const HarmonicLight light = random_light(bands, random);
            const std::vector<float> texels = random_texels(light.count, random);
            for (const size_t count : { 0, 1, 3, 4, 5, 8, 9, 17, kHarmonicTexels }) {
                std::vector<float> expected(3 * kHarmonicTexels + 1, -7), got(3 * kHarmonicTexels + 1, -7);
                EXPECT_EQ(shade_harmonics_scalar(light, kPlainSetup, texels.data(), count, expected.data()),
                          shade_harmonics(light, kPlainSetup, texels.data(), count, got.data()));
                EXPECT_EQ(std::memcmp(expected.data(), got.data(), 4 * expected.size()), 0)
                    << instruction_set << ", " << bands << " bands, " << count << " texels";
            }
        }
    });
}

// In each lane, and in each number of a texel.
TEST(ShadeHarmonics, NoBadNumberGoesUnseen)
{
    std::mt19937 random(11);
    const HarmonicLight light = random_light(5, random);
    constexpr size_t kGroup = 9; // lanes of every instruction set, and one by itself
    const std::vector<float> good(kGroup * size_t(light.count), 0.01f);
    std::vector<float> rgb(3 * kGroup), scalar(3 * kGroup);
    ASSERT_TRUE(shade_harmonics(light, kPlainSetup, good.data(), kGroup, rgb.data()));
    for (const float bad : { NAN, INFINITY, -INFINITY, FLT_MAX, -FLT_MAX })
        for (size_t at = 0; at < good.size(); ++at) {
            std::vector<float> texels = good;
            texels[at] = bad;
            const bool sound = shade_harmonics(light, kPlainSetup, texels.data(), kGroup, rgb.data());
            EXPECT_TRUE(!sound || std::isfinite(bad))
                << bad << " at " << at; // a large number may be held to the brightest
            EXPECT_EQ(sound, shade_harmonics_scalar(light, kPlainSetup, texels.data(), kGroup, scalar.data()));
            EXPECT_EQ(std::memcmp(rgb.data(), scalar.data(), sizeof(float) * rgb.size()), 0) << bad << " at " << at;
        }
    std::vector<float> closed = good;
    for (size_t i = 0; i < kGroup; ++i)
        closed[i * size_t(light.count)] = 0;
    EXPECT_TRUE(shade_harmonics(light, kPlainSetup, closed.data(), kGroup, rgb.data()));
    EXPECT_EQ(rgb, std::vector<float>(3 * kGroup, 0.0f));
}
