// SPDX-License-Identifier: Apache-2.0
#include "instruction_sets.h"
#include "lightmap_scene.h"

#include <vmlight/lightmap/lookup_kernel.h>
#include <vmlight/lightmap/model_paper.h>

#include <cfloat>

using namespace vmlight;
using namespace scene;

namespace {

V3f looked_up(const ImageBuf& map, V3d direction)
{
    return color(lit(one_texel(1, V3f(direction)), map));
}

V3d row_mean(const ImageBuf& map, int y)
{
    V3d sum(0);
    for (int x = 0; x < map.spec().width; ++x)
        sum += V3d(color(map, x, y));
    return sum / map.spec().width;
}

} // namespace

TEST(ShadeKernel, AngleIsTrueToTheLastBits)
{
    double worst = 0;
    for (int i = 0; i <= 200000; ++i) {
        const double angle = (i / 100000.0 - 1) * latlong::pi;
        const float y = float(std::sin(angle)), x = float(std::cos(angle));
        worst = std::max(worst, std::abs(atan2_turns(y, x) - std::atan2(double(y), double(x)) / (2 * latlong::pi)));
    }
    EXPECT_LT(worst, 6e-8);
    RecordProperty("worst_turns", std::to_string(worst * 1e9) + "e-9");
    EXPECT_EQ(atan2_turns(0, 1), 0);
    EXPECT_EQ(atan2_turns(2, 0), 0.25f);
    EXPECT_EQ(atan2_turns(-2, 0), -0.25f);
    EXPECT_EQ(atan2_turns(0, -3), 0.5f);
    EXPECT_EQ(atan2_turns(-0.0f, -3), -0.5f);
    EXPECT_EQ(atan2_turns(0, 0), 0);
}

TEST(ShadeKernel, LookupIsExactAtTexelCentres)
{
    for (const auto& [w, h] : { std::pair { 16, 8 }, { 1, 1 }, { 2, 1 }, { 1, 7 }, { 5, 3 }, { 33, 16 } }) {
        const ImageBuf map = random_cfem(w, h);
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) {
                const V3d n = latlong::direction((x + 0.5) / w, (y + 0.5) / h);
                // Angles are good to 1e-7 of a turn, so columns to 1e-7 w, and neighbours differ by up to 1.
                EXPECT_LT((looked_up(map, n) - color(map, x, y)).length(), 5e-7f * float(w + h) + 1e-6f)
                    << w << "x" << h << " at " << x << ", " << y;
            }
    }
}

TEST(ShadeKernel, LookupIsTheBilinearMeanBetweenCentres)
{
    const ImageBuf map = random_cfem(16, 8);
    for (int y = 0; y + 1 < 8; ++y)
        for (int x = 0; x < 16; ++x) { // x = 15: over the seam
            const int right = (x + 1) % 16;
            const V3f expected = color(map, x, y) * 0.1875f + color(map, right, y) * 0.5625f
                + color(map, x, y + 1) * 0.0625f + color(map, right, y + 1) * 0.1875f;
            const V3d n = latlong::direction((x + 1.25) / 16, (y + 0.75) / 8);
            EXPECT_LT((looked_up(map, n) - expected).length(), 2e-5f) << x << ", " << y;
        }
}

TEST(ShadeKernel, LookupIsContinuousOverTheSeam)
{
    for (const auto& [w, h] : { std::pair { 16, 8 }, { 5, 3 }, { 2, 1 }, { 1, 7 } }) {
        const ImageBuf map = random_cfem(w, h);
        for (double t = 0.01; t < 1; t += 0.049) {
            const V3f before = looked_up(map, latlong::direction(-1e-7, t));
            const V3f on = looked_up(map, latlong::direction(0.0, t));
            const V3f after = looked_up(map, latlong::direction(1e-7, t));
            // A step of 1e-7 turns is 1e-7 w columns; rounding of s is as much again.
            EXPECT_LT((before - on).length() + (after - on).length(), 1e-6f * float(w + h) + 1e-6f) << t;
        }
    }
}

TEST(ShadeKernel, PolesHaveOneValue)
{
    for (const auto& [w, h] : { std::pair { 16, 8 }, { 5, 3 }, { 2, 1 }, { 1, 7 }, { 1, 1 } }) {
        const ImageBuf map = random_cfem(w, h);
        for (const double pole : { 0.0, 1.0 }) {
            const V3f value(row_mean(map, pole == 0 ? 0 : h - 1));
            EXPECT_LT((looked_up(map, V3d(0, 1 - 2 * pole, 0)) - value).length(), 2e-6f);
            for (double s = 0.05; s < 1; s += 0.09) {
                const V3f near = looked_up(map, latlong::direction(s, std::abs(pole - 1e-7)));
                EXPECT_LT((near - value).length(), 1e-6f * float(h) + 2e-6f) << w << "x" << h << " at s = " << s;
            }
        }
    }
}

TEST(ShadeKernel, LightThatIsNotNegativeStaysSoAtThePoles)
{
    // One bright texel in the polar row: beyond the pole the frame is far below 0.
    ImageBuf map = cfem(64, 32, [](V3d) { return V3f(0); });
    const float bright[3] { 1e6f, 1e6f, 1e6f };
    map.setpixel(7, 0, bright, 3);
    for (double s = 0; s < 1; s += 0.003)
        for (double t : { 0.0, 1e-8, 1e-5, 0.004, 0.0156 })
            EXPECT_GE(looked_up(map, latlong::direction(s, t)).x, 0) << s << ", " << t;
}

TEST(ShadeKernel, EveryInstructionSetGivesTheBitsOfTheScalarForm)
{
    CfemLookup map;
    std::string error;
    ASSERT_TRUE(prepare_cfem(map, random_cfem(37, 18), error)) << error;
    const ShadeSetup setup { { 0.36f, 0.48f, -0.8f, -0.8f, 0.6f, 0, 0.48f, 0.64f, 0.6f }, 1.5f };

    constexpr int count = 997;
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    std::vector<float> in(4 * count);
    for (int i = 0; i < count; ++i)
        for (int c = 0; c < 4; ++c) {
            const float kinds[] { normal(random), 0.0f, -0.0f, 1e-7f * normal(random), 1e30f * normal(random), 1e-40f };
            in[4 * i + c] = kinds[random() % 3 ? 0 : random() % 6];
        }
    const int tested = with_each_instruction_set([&](const char* instruction_set) {
        for (TexelLayout layout : { TexelLayout::visibility_first, TexelLayout::visibility_last })
            for (int texels : { 0, 1, 2, 3, 4, 5, 7, 8, 9, 15, 16, 17, 31, 33, count }) {
                std::vector<float> expected(3 * count + 1, -7), got(3 * count + 1, -7);
                EXPECT_EQ(shade_paper_scalar(map, setup, layout, in.data(), texels, expected.data()),
                          shade_paper(map, setup, layout, in.data(), texels, got.data()));
                EXPECT_EQ(std::memcmp(expected.data(), got.data(), 4 * expected.size()), 0)
                    << instruction_set << ", " << texels << " texels";
            }
    });
    RecordProperty("instruction_sets", tested);
}

TEST(ShadeKernel, NoInputLeadsOutsideTheMapAndNoBadOneGoesUnseen)
{
    CfemLookup map;
    std::string error;
    ASSERT_TRUE(prepare_cfem(map, random_cfem(5, 3), error)) << error;
    const float bad[] { NAN, INFINITY, -INFINITY, FLT_MAX, -FLT_MAX, 1e-45f, 0, -0.0f, 1 };
    const ShadeSetup setup { { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, 1 };
    for (float v : bad)
        for (float x : bad)
            for (float y : bad)
                for (float z : bad) {
                    const float in[4] { v, x, y, z };
                    float out[3], scalar[3];
                    const bool finite = std::isfinite(v) && std::isfinite(x) && std::isfinite(y) && std::isfinite(z);
                    const bool sound = shade_paper(map, setup, TexelLayout::visibility_first, in, 1, out);
                    EXPECT_EQ(sound, shade_paper_scalar(map, setup, TexelLayout::visibility_first, in, 1, scalar));
                    EXPECT_TRUE(finite || !sound) << v << ", " << x << ", " << y << ", " << z;
                    EXPECT_TRUE(!sound || std::isfinite(out[0] + out[1] + out[2]));
                }
}
