// SPDX-License-Identifier: Apache-2.0
// Maps and environments of the models sh, mask and cells: channels and shapes that they take, and what they refuse.
#include "basis_maps.h"
#include "scenes.h"
#include "stack_maps.h"

#include <vmlight/cfem/radiance.h>
#include <vmlight/vismap/vismap.h>

#include <OpenImageIO/imagebufalgo.h>

#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

using namespace vmlight;
using namespace scene;
using namespace scene::basis_maps;

TEST(LightmapBasis, BitsDependOnNoThreadsAndAutoTakesWhatTheMapHas)
{
    const std::vector<ImageBuf> stack = filtered_stack(random_cfem(32, 16));
    for (const char* name : kModels) {
        const ImageBuf vm = basis_map(name);
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
        const ImageBuf whole = basis_map(name, 16);
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
        EXPECT_EQ(refusal(basis_map(name, 1), stack[0], model(name)),
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
            ImageBuf vm = basis_map(name, 8);
            pixels(vm)[3 * vm.nchannels() + 9] = bad;
            EXPECT_EQ(refusal(vm, stack, {}),
                      std::string("visibility map has 1 value that is no longer whole and below 2^24 (was the map "
                                  "resized, mipmapped or stored as half?), at pixel (3, 0) channel \"")
                          + channel + "\"");
        }
    ImageBuf vm = basis_map("sh", 8);
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

TEST(LightmapBasis, LightOutOfFloatsRangeIsRefusedNotBlack)
{
    const ImageBuf env = painted_by([](V3d w) { return V3f(w.y > 0.5 ? 0.0f : 3e38f); });
    std::vector<ImageBuf> light(1);
    std::string error;
    ASSERT_TRUE(make_radiance(light[0], env, {}, error)) << error;
    for (const char* name : kModels) {
        LightmapParams params = model(name);
        params.exposure = 1;
        EXPECT_NE(refusal(basis_map(name, 64), light, params), "") << name;
    }
}

TEST(LightmapBasis, TheShapeOfTheEnvironmentsPixelsMattersLittle)
{
    const ImageBuf env = painted_by([](V3d w) { return V3f(float(std::exp(2 * w.x) + w.y * w.y)); }, 256);
    for (const char* name : { "mask", "cells" }) {
        const ImageBuf vm = basis_map(name, 512);
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
