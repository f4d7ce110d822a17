// SPDX-License-Identifier: Apache-2.0
#include "cfem_maps.h"

#include <vmlight/cfem/spherical_harmonics.h>
#include <vmlight/cfem/stack.h>
#include <vmlight/math/harmonics.h>

#include <cstring>

using namespace cfem_maps;

namespace {

std::vector<OIIO::ImageBuf> stack(const OIIO::ImageBuf& env, int width = 32, int nthreads = 1)
{
    std::vector<OIIO::ImageBuf> levels;
    std::string error;
    EXPECT_TRUE(make_cfem_stack(levels, env, exact(width, width / 2), error, nthreads)) << error;
    EXPECT_EQ(int(levels.size()), kStackImages);
    return levels;
}

Map image_map(const OIIO::ImageBuf& image)
{
    Map map(image.spec().width, image.spec().height);
    EXPECT_TRUE(image.get_pixels(image.roi(), OIIO::TypeFloat, map.rgb.data()));
    return map;
}

} // namespace

TEST(CfemStack, LevelsStandWhereTheirSpacingSays)
{
    EXPECT_DOUBLE_EQ(stack_lobe(0), 2.0 / 3);
    EXPECT_DOUBLE_EQ(stack_lobe(1), 0.5);
    EXPECT_NEAR(2 * kStackStep, std::sqrt(0.5) - std::sqrt(1.0 / 3), 1e-9);
    for (int level = 2; level < kStackLevels; ++level)
        EXPECT_NEAR(std::sqrt(1 - stack_lobe(level == 2 ? 0 : level - 1)) - std::sqrt(1 - stack_lobe(level)),
                    kStackStep, 1e-12);
    EXPECT_DOUBLE_EQ(power_lobe_exponent(2.0 / 3), 1);
    EXPECT_DOUBLE_EQ(power_lobe_exponent(0.5), 0);
}

TEST(CfemStack, LobesHaveTheirSpectrum)
{
    for (int l = 0; l < 20; ++l)
        EXPECT_NEAR(power_lobe_eigenvalue(l, 1), cosine_eigenvalue(l), 1e-15) << l;
    for (double s : { 0.0, 0.5, 3.0, 26.0, 64.0 }) {
        EXPECT_DOUBLE_EQ(power_lobe_eigenvalue(0, s), 1);
        EXPECT_DOUBLE_EQ(power_lobe_eigenvalue(1, s), (s + 1) / (s + 2));
        // Int (s + 1) x^s P_l(x) dx over [0, 1], by the midpoints of 1e5 parts
        double two = 0, three = 0, four = 0;
        for (int i = 0; i < 100000; ++i) {
            const double x = (i + 0.5) / 100000, k = (s + 1) * std::pow(x, s) / 100000, q = x * x;
            two += k * (1.5 * q - 0.5);
            three += k * x * (2.5 * q - 1.5);
            four += k * (35 * q * q - 30 * q + 3) / 8;
        }
        EXPECT_NEAR(power_lobe_eigenvalue(2, s), two, 1e-5) << s;
        EXPECT_NEAR(power_lobe_eigenvalue(3, s), three, 1e-5) << s;
        EXPECT_NEAR(power_lobe_eigenvalue(4, s), four, 1e-5) << s;
    }
}

TEST(CfemStack, TheFirstLevelIsTheCfemToTheLastBit)
{
    const OIIO::ImageBuf env = image(sampled(64, 32, soft_light));
    const std::vector<OIIO::ImageBuf> levels = stack(env);
    const Map plain = filtered(env, exact(32, 16)), first = image_map(levels[0]);
    EXPECT_EQ(std::memcmp(plain.rgb.data(), first.rgb.data(), 4 * plain.rgb.size()), 0);
    for (int level = 0; level < kStackLevels; ++level) {
        const OIIO::ImageSpec& spec = levels[size_t(level)].spec();
        EXPECT_EQ(spec.get_string_attribute("vmlight:stack"), "true");
        EXPECT_EQ(spec.get_float_attribute("vmlight:lobe"), float(stack_lobe(level)));
        EXPECT_EQ(spec.get_string_attribute("vmlight:stage"), "cfem");
        EXPECT_EQ(spec.get_string_attribute("oiio:subimagename").substr(0, 4), "lobe");
        EXPECT_EQ(describe_cfem_level(env.spec(), exact(32, 16), level).width, spec.width);
    }
}

TEST(CfemStack, AConstantEnvironmentIsItselfInEachLevel)
{
    for (const OIIO::ImageBuf& level : stack(image(almost(Map(40, 17, 0.7f)))))
        EXPECT_LT(largest_error(image_map(level), [](const V3d&) { return V3d(0.7f); }), 0.7e-6);
}

TEST(CfemStack, EachLevelScalesTheFirstMomentByItsR)
{
    // Constant pixels stand for a linear light to (pi / 256)^2 / 12 in each angle.
    const V3d a(1.5, 2, 3), b(0.5, -0.9, 0.7);
    const std::vector<OIIO::ImageBuf> levels
        = stack(image(sampled(512, 256, [&](const V3d& w) { return a + V3d(b.dot(w)); })));
    for (int level = 0; level < kStackLevels; ++level)
        EXPECT_LT(largest_error(image_map(levels[size_t(level)]),
                                [&](const V3d& n) { return a + V3d(stack_lobe(level) * b.dot(n)); }),
                  4e-5)
            << level;
}

TEST(CfemStack, LevelsAreWhatQuadratureSays)
{
    const Map soft = sampled(64, 32, soft_light);
    Map sun(128, 64);
    std::fill_n(sun.at(41, 22), 3, 1e4f);
    for (const Map& env : { soft, sun }) {
        const bool hard = &env != &soft && env.width == 128;
        const V3d mean = brute::mean(env);
        const std::vector<OIIO::ImageBuf> levels = stack(image(env), 64);
        for (int level = 1; level < kStackLevels; ++level) {
            const Map map = image_map(levels[size_t(level)]);
            const double s = power_lobe_exponent(stack_lobe(level));
            double worst = 0;
            for (int y = 1; y < 32; y += 5)
                for (int x = y % 7; x < 64; x += 7) {
                    const V3d truth = brute::lobe_filtered(env, center(x, y, 64, 32), s, hard ? 48 : 6);
                    worst = std::max(worst, std::abs(map.at(x, y)[1] - truth[1]) / mean[1]);
                }
            // What the harmonics leave out, and at level 1 the steps of the sum, which are 1/48 of a sun.
            EXPECT_LT(worst, !hard ? 1e-3 : level < 3 ? 2e-3 : level < 8 ? 2e-4 : 1e-2) << level;
            RecordProperty((hard ? "sun_level_" : "soft_level_") + std::to_string(level), std::to_string(worst));
        }
    }
}

TEST(CfemStack, NothingIsBelowZeroUnderASun)
{
    Map sun(64, 32);
    std::fill_n(sun.at(10, 10), 3, 1e5f);
    for (const OIIO::ImageBuf& level : stack(image(sun), 64)) {
        const Map map = image_map(level);
        EXPECT_GE(*std::min_element(map.rgb.begin(), map.rgb.end()), 0);
        // What is cut off below 0 is light that is added.
        EXPECT_NEAR(brute::mean(map)[0] / brute::mean(sun)[0], 1, 0.02);
    }
}

TEST(CfemStack, BitsDependOnNoThreads)
{
    const OIIO::ImageBuf env = image(random_map(60, 33, 4));
    const std::vector<OIIO::ImageBuf> one = stack(env, 32, 1), two = stack(env, 32, 2);
    for (int level = 0; level < kStackLevels; ++level)
        EXPECT_EQ(std::memcmp(one[size_t(level)].localpixels(), two[size_t(level)].localpixels(), 12 * 32 * 16), 0);
}

TEST(CfemStack, RefusesWhatTheCfemRefuses)
{
    std::vector<OIIO::ImageBuf> levels(3);
    std::string error;
    Map bad(8, 4, 1);
    bad.at(3, 1)[0] = -1;
    EXPECT_FALSE(make_cfem_stack(levels, image(bad), exact(8, 4), error));
    EXPECT_EQ(error, refusal(image(bad)));
    EXPECT_TRUE(levels.empty());
    CfemParams mend = exact(8, 4);
    mend.sanitize = true;
    EXPECT_TRUE(make_cfem_stack(levels, image(bad), mend, error)) << error;
    for (const OIIO::ImageBuf& level : levels)
        EXPECT_EQ(level.spec().get_int_attribute("vmlight:sanitized"), 1);
    EXPECT_FALSE(make_cfem_stack(levels, image(Map(8, 4, 1)), exact(8, 4), error, 1, [](double) { return false; }));
    EXPECT_EQ(error, "interrupted");
}
