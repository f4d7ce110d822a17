// SPDX-License-Identifier: Apache-2.0
#include "cases.h"
#include "stack_maps.h"

#include <vmlight/math/longest_direction.h>

#include <OpenImageIO/imagebufalgo.h>

using namespace vmlight;
using namespace scene;

namespace {

ImageBuf painted_sky(int width, const std::function<V3f(V3d direction)>& light)
{
    return cfem(width, width / 2, light); // any image of a function of direction
}

// A point with normal +z that sees the directions for which `open` is true: V, B and (1/pi) Int L cos dw, by midpoints.
struct LitPoint
{
    double v = 0, light = 0;
    V3d b { 0 };
};
template <class Open, class Light> LitPoint integrate(Open&& open, Light&& light, int steps)
{
    LitPoint point;
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < 2 * steps; ++j) {
            const double square = (i + 0.5) / steps, phi = latlong::pi * (j + 0.5) / steps; // sin^2 theta
            const double s = std::sqrt(square);
            const V3d w(s * std::cos(phi), s * std::sin(phi), std::sqrt(1 - square));
            if (!open(w))
                continue;
            const double weight = 1.0 / (2 * steps * steps);
            point.v += weight;
            point.b += w * weight;
            point.light += light(w) * weight;
        }
    return point;
}

// Root mean square of model - truth over lights that are brightest toward many directions.
struct ModelErrors
{
    double paper, lobe;
};
template <class Open> ModelErrors model_errors(Open&& open)
{
    double paper = 0, lobe = 0, mean = 0;
    const int count = cases(24, 8);
    for (int i = 0; i < count; ++i) {
        const double z = 1 - (2 * i + 1.0) / count, a = 2.4 * i; // evenly about the sphere
        const V3d toward(std::sqrt(1 - z * z) * std::cos(a), std::sqrt(1 - z * z) * std::sin(a), z);
        const auto light = [&](V3d w) { return std::exp(3 * w.dot(toward)); };
        const LitPoint truth = integrate(open, light, 150);
        const auto stack = filtered_stack(painted_sky(128, [&](V3d w) { return V3f(float(light(w))); }), 128);
        for (const auto& [name, sum] : { std::pair { "paper", &paper }, { "lobe", &lobe } }) {
            const double got = color(lit(one_texel(float(truth.v), V3f(truth.b)), stack, model(name))).x;
            *sum += (got - truth.light) * (got - truth.light);
        }
        mean += truth.light;
    }
    return { std::sqrt(paper / count) / (mean / count), std::sqrt(lobe / count) / (mean / count) };
}

} // namespace

TEST(LightmapModel, ALinearEnvironmentIsExactForEveryVisibility)
{
    // L = a + b.w sends (a V + b.B), whatever is open: the lobe knows V and B, and no more is needed.
    const V3d a(1, 2, 3), b(0.5, -0.9, 0.7);
    const auto stack = stack_of(512, 256, [&](double r, V3d n) { return V3f(a + V3d(r * (b ^ n))); });
    const Rotation turn = rotation_from_angles(20, 35, -50);
    LightmapParams params = model("lobe");
    params.rotate = { 20, 35, -50 };
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> unit;
    const ImageBuf vm = vismap(64, 48, [&](int, int) {
        const float v = unit(random), length = unit(random) * std::min(v * kLargestLobe, float(longest_direction(v)));
        return VismapTexel { v, V3f(normal(random), normal(random), normal(random)).normalized() * length };
    });
    const ImageBuf image = lit(vm, stack, params);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x) {
            float t[4];
            vm.getpixel(x, y, t);
            const V3d expected = a * double(t[0]) + V3d(b ^ rotate(turn, V3d(t[1], t[2], t[3])));
            // Bilinear interpolation alone: spacing^2 / 8 in each angle, 1.9e-5 twice.
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(color(image, x, y)[c], expected[c], 4e-5 * b.length() + 3e-6);
        }
}

TEST(LightmapModel, AConstantEnvironmentIsVisibilityTimesItsLight)
{
    const ImageBuf vm = random_vismap(64, 48);
    const V3f light(0.25f, 1, 1000);
    const ImageBuf image = lit(vm, filtered_stack(almost(painted_sky(64, [&](V3d) { return light; }))), model("lobe"));
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x)
            for (int c = 0; c < 3; ++c) {
                const float expected = vm.getchannel(x, y, 0, 0) * light[c];
                EXPECT_NEAR(color(image, x, y)[c], expected, 2e-6f * expected);
            }
}

TEST(LightmapModel, LightOfASunIsNeverNegativeAndTurnsWithoutASeam)
{
    ImageBuf sun = painted_sky(64, [](V3d) { return V3f(0); });
    const float bright[3] { 1e5f, 1e5f, 1e5f };
    sun.setpixel(20, 9, bright, 3);
    const std::vector<ImageBuf> stack = filtered_stack(sun);
    const ImageBuf vm = random_vismap(64, 48);
    LightmapParams params = model("lobe");
    ImageBuf last;
    float largest = 0, step = 0;
    for (int i = 0; i <= 60; ++i) {
        params.rotate = { 0.01 * i, 360 * (i / 30) + 0.02 * i, 0 }; // small turns, and over a whole one
        const ImageBuf image = lit(vm, stack, params);
        for (int k = 0; k < 3 * 64 * 48; ++k) {
            ASSERT_GE(pixels(image)[k], 0);
            largest = std::max(largest, pixels(image)[k]);
        }
        if (i > 0)
            step = std::max(step, difference(image, last));
        last.copy(image);
    }
    // 0.02 degrees are 1/280 of a texel; neighbours differ by up to a third of the sun's light.
    EXPECT_LT(step, largest / 300);
    EXPECT_GT(step, 0);
}

TEST(LightmapModel, ALobeFollowsAWallAndAWellMoreCloselyThanTheCosine)
{
    const auto wall = [](V3d w) { return w.x > 0; };
    const LitPoint half = integrate(
        wall, [](V3d) { return 1.0; }, 400);
    EXPECT_NEAR(half.v, 0.5, 1e-12);
    EXPECT_NEAR(half.light, 0.5, 1e-12);
    EXPECT_LT((half.b - V3d(2 / (3 * latlong::pi), 0, 1.0 / 3)).length(), 1e-4);
    for (const auto& [name, cosine] : { std::pair { "wall", -1.0 }, { "wide well", 0.5 }, { "narrow well", 0.8 } }) {
        const auto open = [&, least = cosine](V3d w) { return least < 0 ? wall(w) : w.z > least; };
        const auto [paper, lobe] = model_errors(open);
        EXPECT_LT(lobe, 0.5 * paper) << name << ": paper " << paper << ", lobe " << lobe;
        RecordProperty(std::string(name) + "_paper", std::to_string(paper));
        RecordProperty(std::string(name) + "_lobe", std::to_string(lobe));
    }
}

TEST(LightmapModel, AutoTakesALobeWhereThereIsAStack)
{
    const std::vector<ImageBuf> stack = random_stack(16, 8);
    const ImageBuf vm = random_vismap(20, 20);
    EXPECT_EQ(LightmapParams().model, "auto");
    const ImageBuf with = lit(vm, stack), without = lit(vm, stack[0]);
    EXPECT_TRUE(same_bits(with, lit(vm, stack, model("lobe"))));
    EXPECT_TRUE(same_bits(without, lit(vm, stack, model("paper"))));
    EXPECT_EQ(with.spec().get_string_attribute("vmlight:model"), "lobe");
    EXPECT_EQ(without.spec().get_string_attribute("vmlight:model"), "paper");
    EXPECT_EQ(lit(vm, random_cfem(16, 8)).spec().get_string_attribute("vmlight:model"), "paper"); // no metadata at all
    ImageBuf in_place = stack[3];
    std::vector<ImageBuf> levels = stack;
    ASSERT_TRUE(make_lightmap(levels[3], vm, levels, {})) << levels[3].geterror();
    EXPECT_TRUE(same_bits(levels[3], with));
}

TEST(LightmapModel, AoLooksAlongTheNormal)
{
    const ImageBuf map = random_cfem(32, 16), directions = random_vismap(20, 20);
    ImageSpec spec = directions.spec();
    spec.nchannels = 7;
    spec.channelnames.insert(spec.channelnames.begin(), kNormalChannels.begin(), kNormalChannels.end());
    ImageBuf vm(spec), swapped(directions.spec());
    std::mt19937 random(8);
    std::normal_distribution<float> normal;
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 20; ++x) {
            const V3f n = V3f(normal(random), normal(random), normal(random)).normalized();
            float texel[7] { n.x, n.y, n.z };
            directions.getpixel(x, y, texel + 3, 4);
            vm.setpixel(x, y, texel);
            const float direct[4] { texel[3], n.x, n.y, n.z };
            swapped.setpixel(x, y, direct);
        }
    LightmapParams params = model("ao");
    params.rotate = { 20, 35, -50 };
    const ImageBuf image = lit(vm, map, params);
    EXPECT_EQ(image.spec().get_string_attribute("vmlight:model"), "ao");
    params.model = "paper";
    EXPECT_TRUE(same_bits(image, lit(swapped, map, params)));
    EXPECT_FALSE(same_bits(image, lit(vm, map, params)));
    // A stack lends its first level.
    std::vector<ImageBuf> stack = random_stack(32, 16);
    EXPECT_TRUE(same_bits(lit(vm, stack, model("ao")), lit(vm, stack[0], model("ao"))));

    EXPECT_EQ(refusal(directions, map, model("ao")),
              "model ao needs channel \"normal.x\", which makevismap --channels normal adds; found visibility, "
              "direction.x, direction.y, direction.z");
    pixels(vm)[7 * 3 + 1] = NAN;
    EXPECT_EQ(refusal(vm, map, model("ao")),
              "visibility map has 1 value that is not finite, at pixel (3, 0) channel \"normal.y\"");
    EXPECT_EQ(lit(vm, map, model("paper")).spec().width, 20);
}

TEST(LightmapModel, ALobeWithoutItsStackIsRefused)
{
    const std::vector<ImageBuf> stack = random_stack(16, 8);
    const ImageBuf vm = random_vismap(4, 4), map = random_cfem(16, 8);
    const auto with = [&](int level, const std::function<void(ImageBuf&)>& change) {
        std::vector<ImageBuf> levels = stack;
        change(levels[size_t(level)]);
        return levels;
    };
    EXPECT_EQ(
        refusal(vm, map, model("lobe")),
        "model lobe needs a stack of lobes, not a single cosine-filtered environment; make one with makecfem --stack");
    EXPECT_EQ(refusal(vm, OIIO::cspan<ImageBuf>(stack.data(), 5), {}),
              "a stack of 5 levels instead of 9; make it again with makecfem --stack");
    EXPECT_EQ(refusal(vm, with(2, [](ImageBuf& level) { level.specmod().erase_attribute("vmlight:lobe"); }), {}),
              "level 2 of the stack: vmlight:lobe is -1 instead of 0.7374");
    EXPECT_EQ(refusal(vm, with(4, [](ImageBuf& level) { level.specmod().attribute("vmlight:lobe", 0.8f); }), {}),
              "level 4 of the stack: vmlight:lobe is 0.8 instead of 0.8535");
    EXPECT_EQ(refusal(vm, with(8, [](ImageBuf& level) { pixels(level)[4] = NAN; }), {}),
              "level 8 of the stack: cosine-filtered environment has 1 value that is not finite, at pixel (1, 0) "
              "channel \"G\"");
    EXPECT_EQ(refusal(vm,
                      with(1,
                           [&](ImageBuf& level) {
                               const ImageSpec own = level.spec();
                               level = random_cfem(8, 4);
                               level.specmod().attribute("vmlight:lobe", 0.5f);
                           }),
                      {}),
              "level 1 of the stack: 8x4 pixels, but level 0 has 16x8");
    EXPECT_EQ(lit(vm, with(2, [](ImageBuf& level) { level.clear(); })[0]).spec().width, 4); // paper reads the first
}
