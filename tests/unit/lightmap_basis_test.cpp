// SPDX-License-Identifier: Apache-2.0
// The models that know more of the sky than V and B tell: sh, mask, cells.
#include "scenes.h"
#include "stack_maps.h"

#include <vmlight/cfem/radiance.h>
#include <vmlight/math/packed_visibility.h>
#include <vmlight/vismap/vismap.h>

#include <OpenImageIO/imagebufalgo.h>

#include <numeric>

using namespace vmlight;
using namespace scene;

namespace {

const char* const kModels[] = { "sh", "mask", "cells" };

// A floor with a wall beside it and a roof over a part: texels that see all, half and little.
ImageBuf baked(const char* basis, int samples = 256, int side = 24)
{
    const Mesh floor = scenes::floor_facing_z(2);
    const Mesh wall = scenes::quad({ 2.01, -9, 0 }, { 2.01, 9, 0 }, { 2.01, 9, 3 }, { 2.01, -9, 3 });
    const Mesh roof = scenes::quad({ -3, -3, 0.5 }, { -1, -3, 0.5 }, { -1, 3, 0.5 }, { -3, 3, 0.5 });
    VismapParams params;
    params.resolution = { side, side };
    params.samples = samples;
    params.basis = basis;
    params.margin = 0;
    ImageBuf vm;
    EXPECT_TRUE(make_vismap(vm, floor, { wall, roof }, params)) << vm.geterror();
    return vm;
}

// Numbers that no bake would make.
ImageBuf random_texels(const char* basis)
{
    ImageBuf vm = baked(basis, 1, 16);
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

ImageBuf painted_by(const std::function<V3f(V3d direction)>& light, int width = 64)
{
    return cfem(width, width / 2, light);
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
        for (const ImageBuf& vm : { baked(name, 64), random_texels(name) }) {
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
        for (const ImageBuf& vm : { baked(name), random_texels(name) }) {
            LightmapParams params = model(name);
            ImageBuf last;
            float largest = 0, step = 0;
            // Random texels may see the sun alone, far above the brightest point of the CFEM, at which they are held:
            // they reach it within a small part of the sun.
            const double turn = vm.spec().width == 16 ? 0.1 : 1;
            for (int i = 0; i <= 60; ++i) {
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
    turned.rotate = { 0, 90, 0 };
    const ImageBuf plain = random_vismap(8, 8);
    if (difference(lit(plain, other, model("paper")), lit(plain, stack, turned)) > 1e-4f)
        turned.rotate = { 0, -90, 0 };
    ASSERT_LT(difference(lit(plain, other, model("paper")), lit(plain, stack, turned)), 1e-4f);
    for (const char* name : kModels) {
        turned.model = name;
        const ImageBuf vm = baked(name);
        EXPECT_LT(difference(lit(vm, other, model(name)), lit(vm, stack, turned)), 2e-4f) << name;
        EXPECT_GT(difference(lit(vm, stack, model(name)), lit(vm, stack, turned)), 0.1f) << name;
    }
}

TEST(LightmapBasis, HarmonicsAreLinearInTheMap)
{
    const std::vector<ImageBuf> stack = filtered_stack(painted_by([](V3d w) { return V3f(float(2 + w.x * w.y)); }));
    const ImageBuf vm = baked("sh"), image = lit(vm, stack);
    ImageBuf mean(vm.spec());
    const int row = 24 * vm.nchannels();
    for (int i = 0; i < 23 * row; ++i) // of each texel and the one below it
        pixels(mean)[i] = 0.5f * (pixels(vm)[i] + pixels(vm)[i + row]);
    const ImageBuf of_mean = lit(mean, stack);
    for (int i = 0; i < 23 * 24 * 3; ++i)
        EXPECT_NEAR(pixels(of_mean)[i], 0.5f * (pixels(image)[i] + pixels(image)[i + 72]), 1e-5f);
}

TEST(LightmapBasis, BitsDependOnNoThreadsAndAutoTakesWhatTheMapHas)
{
    const std::vector<ImageBuf> stack = filtered_stack(random_cfem(32, 16));
    for (const char* name : kModels) {
        const ImageBuf vm = baked(name);
        const ImageBuf image = lit(vm, stack, model("auto"));
        EXPECT_EQ(image.spec().get_string_attribute("vmlight:model"), name);
        EXPECT_TRUE(same_bits(image, lit(vm, stack, model(name), 3)));
        EXPECT_TRUE(same_bits(image, lit(vm, { stack.back() }, model("auto")))); // all that it reads
        EXPECT_EQ(lit(vm, stack[0]).spec().get_string_attribute("vmlight:model"), "paper");
        EXPECT_EQ(lit(vm, stack, model("lobe")).spec().get_string_attribute("vmlight:model"), "lobe");
    }
}

TEST(LightmapBasis, ChannelsMayLieAnywhereInMapsOfAnySize)
{
    const std::vector<ImageBuf> stack = filtered_stack(random_cfem(16, 8), 16);
    for (const char* name : kModels) {
        const ImageBuf whole = baked(name, 16);
        const int count = whole.nchannels();
        std::vector<std::string> names = whole.spec().channelnames;
        std::vector<int> order(size_t(count), 0), apart;
        std::iota(order.begin(), order.end(), 0);
        // The first four, one that no model reads, the rest; and all of them backwards.
        apart = order;
        apart.insert(apart.begin() + 4, -1);
        std::vector<std::string> apart_names = names;
        apart_names.insert(apart_names.begin() + 4, "samples");
        const std::vector<int> backwards(order.rbegin(), order.rend());
        const ImageBuf all = lit(whole, stack, model(name));
        for (const auto& [width, height] : { std::pair(1, 1), { 2, 1 }, { 1, 3 }, { 5, 3 }, { 24, 20 } }) {
            const ImageBuf vm = OIIO::ImageBufAlgo::cut(whole, { 0, width, 4, 4 + height, 0, 1, 0, count });
            const ImageBuf image = lit(vm, stack, model(name));
            // How many texels are shaded at once changes no bit.
            EXPECT_TRUE(same_bits(image, OIIO::ImageBufAlgo::cut(all, { 0, width, 4, 4 + height })))
                << name << " " << width << "x" << height;
            for (const ImageBuf& other : { OIIO::ImageBufAlgo::channels(vm, count + 1, apart, {}, apart_names),
                                           OIIO::ImageBufAlgo::channels(vm, count, backwards) })
                EXPECT_TRUE(same_bits(lit(other, stack, model(name)), image)) << name << " " << width << "x" << height;
        }
    }
}

TEST(LightmapBasis, WhatAModelLacksIsNamed)
{
    const std::vector<ImageBuf> stack = filtered_stack(random_cfem(32, 16));
    const ImageBuf plain = random_vismap(4, 4);
    for (const char* name : kModels) {
        EXPECT_NE(refusal(plain, stack, model(name)).find(std::string(", which makevismap --basis ") + name + " adds"),
                  std::string::npos)
            << refusal(plain, stack, model(name));
        EXPECT_EQ(refusal(baked(name, 1), stack[0], model(name)),
                  std::string("model ") + name
                      + " needs the unfiltered environment, the last image of a stack; make one with makecfem --stack");
    }
    EXPECT_EQ(refusal(plain, stack.back(), model("paper")),
              "model paper needs a cosine-filtered environment; this one is unfiltered");
}

TEST(LightmapBasis, PackedNumbersThatWereFilteredAreRefused)
{
    const std::vector<ImageBuf> stack = filtered_stack(random_cfem(32, 16));
    for (const auto& [name, channel] : { std::pair { "mask", "mask.2" }, { "cells", "cells.2" } })
        for (const float bad : { 7.5f, -1.0f, 0x1p24f }) {
            ImageBuf vm = baked(name, 8);
            pixels(vm)[3 * vm.nchannels() + 9] = bad;
            EXPECT_EQ(refusal(vm, stack, {}),
                      std::string("visibility map has 1 value that is no longer whole and below 2^24 (was the map "
                                  "resized, mipmapped or stored as half?), at pixel (3, 0) channel \"")
                          + channel + "\"");
        }
    ImageBuf vm = baked("sh", 8);
    pixels(vm)[5] = INFINITY;
    EXPECT_EQ(refusal(vm, stack, {}),
              "visibility map has 1 value that is not finite, at pixel (0, 0) channel \"sh.5\"");
}

TEST(LightmapBasis, ABasisGoesWithTheCosine)
{
    VismapParams params;
    params.measure = "uniform";
    params.basis = "sh";
    ImageBuf vm;
    EXPECT_FALSE(make_vismap(vm, scenes::floor_facing_z(1), {}, params));
    EXPECT_EQ(vm.geterror(), "basis: sh needs the measure cosine, not uniform");
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

TEST(LightmapBasis, LightOutOfFloatsRangeIsRefusedNotBlack)
{
    const ImageBuf env = painted_by([](V3d w) { return V3f(w.y > 0.5 ? 0.0f : 3e38f); });
    std::vector<ImageBuf> light(1);
    std::string error;
    ASSERT_TRUE(make_radiance(light[0], env, {}, error)) << error;
    for (const char* name : kModels) {
        LightmapParams params = model(name);
        params.exposure = 1;
        EXPECT_NE(refusal(baked(name, 64), light, params), "") << name;
    }
}

TEST(LightmapBasis, TheShapeOfTheEnvironmentsPixelsMattersLittle)
{
    const ImageBuf env = painted_by([](V3d w) { return V3f(float(std::exp(2 * w.x) + w.y * w.y)); }, 256);
    for (const char* name : { "mask", "cells" }) {
        const ImageBuf vm = baked(name, 512);
        const auto at_size = [&](int width, int height) {
            CfemParams params;
            params.resolution = { width, height };
            std::vector<ImageBuf> light(1);
            std::string error;
            EXPECT_TRUE(make_radiance(light[0], env, params, error)) << error;
            return lit(vm, light);
        };
        const ImageBuf square = at_size(128, 64);
        EXPECT_LT(difference(at_size(32, 64), square), 0.06f) << name;
        EXPECT_LT(difference(at_size(512, 32), square), 0.06f) << name;
        EXPECT_LT(difference(at_size(1024, 512), square), 0.02f) << name; // reduced, where it is made ready
    }
}
