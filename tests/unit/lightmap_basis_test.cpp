// SPDX-License-Identifier: Apache-2.0
// Light of the models that know more of the sky than V and B tell: sh, mask, cells.
#include "basis_maps.h"
#include "cases.h"
#include "scenes.h"
#include "stack_maps.h"

#include <vmlight/vismap/vismap.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

using namespace vmlight;
using namespace scene;
using namespace scene::basis_maps;

namespace {

// Numbers that no bake would make.
ImageBuf random_texels(const char* basis)
{
    ImageBuf vm = basis_map(basis, 1, 16);
    std::mt19937 random(9);
    std::uniform_real_distribution<float> unit;
    const int channels = vm.nchannels();
    for (int i = 0; i < 256; ++i)
        for (int c = 0; c < channels; ++c) {
            const bool packed = holds_whole_numbers(vm.spec().channelnames[size_t(c)]);
            pixels(vm)[i * channels + c] = packed ? float(random() >> 8) : c == 0 ? unit(random) : 2 * unit(random) - 1;
        }
    for (int c = 4; c < channels; ++c) // nothing but V; and no normal
        pixels(vm)[c] = 0;
    return vm;
}

float visibility(const ImageBuf& vm, int i)
{
    return pixels(vm)[i * vm.nchannels()];
}

} // namespace

TEST(LightmapBasis, AConstantEnvironmentIsVisibilityTimesItsLight)
{
    const V3f light(0.25f, 1, 1000);
    const std::vector<ImageBuf> stack = filtered_stack(almost(painted_by([&](V3d) { return light; })));
    for (const char* name : kModels)
        for (const ImageBuf& vm : { basis_map(name, 64), random_texels(name) }) {
            if (name == std::string("sh") && vm.spec().width == 16)
                continue; // no visibility has such harmonics
            LightmapParams params = model(name);
            params.rotate = { 20, 35, -50 };
            const ImageBuf image = lit(vm, stack, params);
            for (int i = 0; i < int(vm.spec().image_pixels()); ++i)
                for (int c = 0; c < 3; ++c) {
                    const float expected = visibility(vm, i) * light[c];
                    const float tolerance = name == std::string("sh") ? 3e-6f * light[c]
                        : c == 2                                      ? 2e-7f * expected
                                                                      : 0;
                    EXPECT_NEAR(pixels(image)[3 * i + c], expected, tolerance) << name << " " << i;
                }
        }
}

TEST(LightmapBasis, AnOpenTexelIsTheFilteredEnvironment)
{
    const std::vector<ImageBuf> stack = filtered_stack(painted_by(
                                                           [](V3d w) {
                                                               return V3f(float(1 + 0.5 * w.x + 0.3 * w.y * w.z),
                                                                          float(1 + w.x * w.z), float(1 - 0.7 * w.z));
                                                           },
                                                           128),
                                                       128);
    for (const char* name : kModels) {
        const Mesh floor = scenes::floor_facing_z(2);
        VismapParams bake;
        bake.resolution = { 8, 8 };
        bake.samples = 1024;
        bake.basis = name;
        ImageBuf vm;
        ASSERT_TRUE(make_vismap(vm, floor, {}, bake)) << vm.geterror();
        LightmapParams params = model(name);
        params.rotate = { -40, 15, 70 };
        const ImageBuf image = lit(vm, stack, params);
        params.model = "paper"; // exact here
        // Harmonics hold this sky; intervals and cells reach over the horizon or end before it.
        EXPECT_LT(difference(image, lit(vm, stack, params)), name == std::string("sh") ? 1e-3f : 0.03f) << name;
    }
}

TEST(LightmapBasis, LightOfASunIsNeverNegativeAndTurnsWithoutAJump)
{
    ImageBuf sun = painted_by([](V3d) { return V3f(0.1f); });
    const float bright[3] { 1e4f, 1e4f, 1e4f };
    sun.setpixel(20, 9, bright, 3);
    const std::vector<ImageBuf> stack = filtered_stack(sun);
    for (const char* name : kModels)
        for (const ImageBuf& vm : { basis_map(name), random_texels(name) }) {
            LightmapParams params = model(name);
            ImageBuf last;
            float largest = 0, step = 0;
            // Random texels may see the sun alone, far above the brightest point of the CFEM, at which they are held:
            // they reach it within a small part of the sun.
            const double turn = vm.spec().width == 16 ? 0.1 : 1;
            for (int i = 0; i <= cases(60, 20); ++i) {
                params.rotate = { turn * 0.01 * i, 360 * (i / 30) + turn * 0.02 * i, turn * 0.013 * i };
                const ImageBuf image = lit(vm, stack, params);
                for (int k = 0; k < 3 * int(vm.spec().image_pixels()); ++k) {
                    ASSERT_TRUE(pixels(image)[k] >= 0 && std::isfinite(pixels(image)[k])) << name;
                    largest = std::max(largest, pixels(image)[k]);
                }
                if (i > 0)
                    step = std::max(step, difference(image, last));
                last.copy(image);
            }
            // The sun is 5.6 degrees wide, and turns by 1/250 of that, or a tenth.
            EXPECT_LT(step, largest / 50) << name << " " << vm.spec().width;
            EXPECT_GT(step, 0) << name;
        }
}

TEST(LightmapBasis, TheObjectTurnsAgainstTheEnvironment)
{
    const ImageBuf env = painted_by([](V3d w) { return V3f(float(std::exp(3 * w.x)), float(std::exp(2 * w.z)), 1); });
    ImageBuf rolled(env.spec()); // by a quarter
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x) {
            float rgb[3];
            env.getpixel((x + 16) % 64, y, rgb, 3);
            rolled.setpixel(x, y, rgb, 3);
        }
    const std::vector<ImageBuf> stack = filtered_stack(env), other = filtered_stack(rolled);
    LightmapParams turned = model("paper");
    turned.rotate = { 0, -90, 0 };
    const ImageBuf plain = random_vismap(8, 8);
    ASSERT_LT(difference(lit(plain, other, model("paper")), lit(plain, stack, turned)), 1e-4f);
    for (const char* name : kModels) {
        turned.model = name;
        const ImageBuf vm = basis_map(name);
        EXPECT_LT(difference(lit(vm, other, model(name)), lit(vm, stack, turned)), 2e-4f) << name;
        EXPECT_GT(difference(lit(vm, stack, model(name)), lit(vm, stack, turned)), 0.1f) << name;
    }
}

TEST(LightmapBasis, HarmonicsAreLinearInTheMap)
{
    const std::vector<ImageBuf> stack = filtered_stack(painted_by([](V3d w) { return V3f(float(2 + w.x * w.y)); }));
    const ImageBuf vm = basis_map("sh"), image = lit(vm, stack);
    ImageBuf mean(vm.spec());
    const int row = 24 * vm.nchannels();
    for (int i = 0; i < 23 * row; ++i) // of each texel and the one below it
        pixels(mean)[i] = 0.5f * (pixels(vm)[i] + pixels(vm)[i + row]);
    const ImageBuf of_mean = lit(mean, stack);
    for (int i = 0; i < 23 * 24 * 3; ++i)
        EXPECT_NEAR(pixels(of_mean)[i], 0.5f * (pixels(image)[i] + pixels(image)[i + 72]), 1e-5f);
}

TEST(LightmapBasis, NoTexelIsLitBeyondWhatThereIs)
{
    // Cells, and with them their weights, lie across the horizon: a floor that sees a low strip all around, and a ball
    // under which a lamp shines.
    const Mesh floor = scenes::sphere(V3d(0), 1, 12);
    const Mesh plate = scenes::quad({ -3, 1.05, -3 }, { -3, 1.05, 3 }, { 3, 1.05, 3 }, { 3, 1.05, -3 });
    ImageBuf lamp = painted_by([](V3d) { return V3f(1); }, 128);
    const float bright[3] { 1e4f, 1e4f, 1e4f };
    for (const int row : { 30, 32, 34 })
        lamp.setpixel(10 * row - 280, row, bright, 3);
    const std::vector<ImageBuf> stack = filtered_stack(lamp, 128), coarse = filtered_stack(lamp, 2);
    for (const char* name : { "mask", "cells" })
        for (const int samples : { 16, 256, 4096 }) {
            VismapParams params;
            params.resolution = { 24, 24 };
            params.samples = samples;
            params.basis = name;
            ImageBuf vm;
            ASSERT_TRUE(make_vismap(vm, floor, { plate }, params)) << vm.geterror();
            for (const auto& light : { stack, coarse }) {
                const ImageBuf image = lit(vm, light);
                const float* sky = pixels(light.back());
                const auto [least, most] = std::minmax_element(sky, sky + 3 * light.back().spec().image_pixels());
                for (int i = 0; i < 24 * 24; ++i) {
                    const float v = visibility(vm, i), c = pixels(image)[3 * i];
                    ASSERT_TRUE(c >= 0.9999f * v * *least && c <= 1.0001f * v * *most)
                        << name << " " << samples << " texel " << i << ": V " << v << ", light " << c;
                }
            }
        }
}
