// SPDX-License-Identifier: Apache-2.0
#include "instruction_sets.h"
#include "stack_maps.h"

#include <vmlight/lightmap/lookup_kernel.h>
#include <vmlight/lightmap/model_lobe.h>

#include <cfloat>

using namespace vmlight;
using namespace scene;

namespace {

double knot_lobe(int knot)
{
    return knot == 0 ? 0 : stack_lobe(knot == kCfemKnot ? 0 : knot == 1 ? 1 : knot - 1);
}

} // namespace

TEST(ShadeLobe, BetweenKnotsTheMeanDirectionIsThatOfR)
{
    EXPECT_EQ(kLargestLobe, float(stack_lobe(kStackLevels - 1)));
    float last = -1;
    for (int i = 0; i <= 100000; ++i) {
        const float r = float(i) / 100000, position = lobe_position(r);
        ASSERT_GE(position, last) << r;
        ASSERT_LE(position, float(kLobeKnots - 1)) << r;
        last = position;
        const int knot = std::min(int(position), kLobeKnots - 2);
        const double share = position - knot;
        ASSERT_NEAR((1 - share) * knot_lobe(knot) + share * knot_lobe(knot + 1), std::min(r, kLargestLobe), 1e-6);
    }
    for (int knot = 0; knot < kLobeKnots; ++knot)
        EXPECT_NEAR(lobe_position(float(knot_lobe(knot))), knot, 1e-4);
    EXPECT_EQ(lobe_position(-1), 0);
    EXPECT_EQ(lobe_position(NAN), 0);
    EXPECT_EQ(lobe_position(INFINITY), float(kLobeKnots - 1));
}

TEST(ShadeLobe, EveryInstructionSetGivesTheBitsOfTheScalarForm)
{
    LobeLookup lobes;
    std::string error;
    ASSERT_TRUE(prepare_lobes(lobes, random_stack(37, 18), error)) << error;
    const ShadeSetup setup { { 0.36f, 0.48f, -0.8f, -0.8f, 0.6f, 0, 0.48f, 0.64f, 0.6f }, 1.5f };

    constexpr int count = 997;
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> unit;
    std::vector<float> in(4 * count);
    for (int i = 0; i < count; ++i)
        if (i % 2) { // any r
            const V3f b = V3f(normal(random), normal(random), normal(random)).normalized() * unit(random);
            std::copy_n(&b.x, 3, &in[size_t(4 * i) + 1]);
            in[size_t(4 * i)] = b.length() / std::max(0.01f, unit(random));
        } else {
            for (int c = 0; c < 4; ++c) {
                const float kinds[] { normal(random),         0.0f,  -0.0f, 1e-7f * normal(random),
                                      1e30f * normal(random), 1e-40f };
                in[size_t(4 * i + c)] = kinds[random() % 3 ? 0 : random() % 6];
            }
        }
    with_each_instruction_set([&](const char* instruction_set) {
        for (TexelLayout layout : { TexelLayout::visibility_first, TexelLayout::visibility_last })
            for (int texels : { 0, 1, 2, 3, 5, 8, 9, 17, 33, 257, count }) {
                std::vector<float> expected(3 * count + 1, -7), got(3 * count + 1, -7);
                EXPECT_EQ(shade_lobe_scalar(lobes, setup, layout, in.data(), texels, expected.data()),
                          shade_lobe(lobes, setup, layout, in.data(), texels, got.data()));
                EXPECT_EQ(std::memcmp(expected.data(), got.data(), 4 * expected.size()), 0)
                    << instruction_set << ", " << texels << " texels";
            }
    });
}

TEST(ShadeLobe, NoInputLeadsOutsideTheMapsAndNoBadOneGoesUnseen)
{
    LobeLookup lobes;
    std::string error;
    ASSERT_TRUE(prepare_lobes(lobes, random_stack(5, 3), error)) << error;
    const float bad[] { NAN, INFINITY, -INFINITY, FLT_MAX, -FLT_MAX, 1e-45f, 0, -0.0f, 1 };
    const ShadeSetup setup { { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, 1 };
    for (float v : bad)
        for (float x : bad)
            for (float y : bad)
                for (float z : bad) {
                    const float in[4] { v, x, y, z };
                    float out[3], scalar[3];
                    const bool finite = std::isfinite(v) && std::isfinite(x) && std::isfinite(y) && std::isfinite(z);
                    const bool sound = shade_lobe(lobes, setup, TexelLayout::visibility_first, in, 1, out);
                    EXPECT_EQ(sound, shade_lobe_scalar(lobes, setup, TexelLayout::visibility_first, in, 1, scalar));
                    EXPECT_TRUE(finite || !sound) << v << ", " << x << ", " << y << ", " << z;
                    EXPECT_TRUE(!sound || std::isfinite(out[0] + out[1] + out[2]))
                        << v << ", " << x << ", " << y << ", " << z;
                }
}

TEST(ShadeLobe, AnUnoccludedTexelIsThePapers)
{
    const std::vector<ImageBuf> stack = random_stack(32, 16);
    std::mt19937 random(2);
    std::normal_distribution<float> normal;
    const ImageBuf vm = vismap(50, 50, [&](int, int) {
        return VismapTexel { 1, V3f(normal(random), normal(random), normal(random)).normalized() * (2.0f / 3) };
    });
    // |B| / V is 2/3 to a rounding, and the next knot 14 times as far.
    EXPECT_LT(difference(lit(vm, stack, model("lobe")), lit(vm, stack, model("paper"))), 1e-5f);
}

TEST(ShadeLobe, ATexelThatSeesAlikeOnAllSidesGetsTheMeanLight)
{
    const auto stack = stack_of(256, 128, [](double, V3d n) { return V3f(float(1 + n.y * n.y)); });
    EXPECT_NEAR(color(lit(one_texel(0.5f, V3f(0)), stack)).x, 0.5 * 4 / 3, 1e-4);
    EXPECT_EQ(color(lit(one_texel(0, V3f(0, 1, 0)), stack)), V3f(0));
    EXPECT_EQ(color(lit(one_texel(-1, V3f(0, 1, 0)), stack)), V3f(0));
}
