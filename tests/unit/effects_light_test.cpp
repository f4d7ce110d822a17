// SPDX-License-Identifier: Apache-2.0
// Light of one colour and an albedo of 1 change nothing: exactly, and for no work.
#include "lightmap_scene.h"

#include <vmlight/base/work_counts.h>
#include <vmlight/cfem/stack.h>
#include <vmlight/image/channels.h>
#include <vmlight/lightmap/model.h>
#include <vmlight/lightmap/model_light.h>
#include <vmlight/math/packed_visibility.h>

#include <OpenImageIO/imagebufalgo.h>

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <map>

using namespace vmlight;
using namespace scene;

namespace {

constexpr float kLightColor[3] { 0.3f, 1.7f, 123.456f };

ImageBuf one_color(int width, int height)
{
    ImageSpec spec(width, height, 3, OIIO::TypeFloat);
    spec.channelnames = { "R", "G", "B" };
    ImageBuf image(spec);
    OIIO::ImageBufAlgo::fill(image, { kLightColor[0], kLightColor[1], kLightColor[2] });
    return image;
}

// Of one colour but for the last bit of the last pixel.
ImageBuf nearly_one_color(int width, int height)
{
    ImageBuf image = one_color(width, height);
    float& last = pixels(image)[3 * width * height - 1];
    last = std::nextafter(last, 2 * last);
    return image;
}

void expect_all(const ImageBuf& image, float r, float g, float b)
{
    const float* p = pixels(image);
    for (size_t i = 0; i < size_t(image.spec().image_pixels()); ++i, p += 3)
        ASSERT_TRUE(p[0] == r && p[1] == g && p[2] == b) << "pixel " << i << ": " << p[0] << " " << p[1] << " " << p[2];
}

// A map that every model can read: random V, B, normals and packed numbers.
ImageBuf map_of_all_models(int width, int height)
{
    ImageSpec spec(width, height, 0, OIIO::TypeFloat);
    spec.channelnames.assign(kVismapChannels.begin(), kVismapChannels.end());
    for (const auto& names :
         { std::vector<std::string>(kNormalChannels.begin(), kNormalChannels.end()), numbered_channels("sh", 4, 9),
           numbered_channels("mask", 0, kMaskFloats), numbered_channels("cells", 0, kCellsFloats) })
        spec.channelnames.insert(spec.channelnames.end(), names.begin(), names.end());
    spec.nchannels = int(spec.channelnames.size());
    ImageBuf image(spec), random = random_vismap(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            std::vector<float> texel(size_t(spec.nchannels), 0.0f);
            random.getpixel(x, y, 0, texel.data(), 4);
            texel[0] = (x + y) % 7 == 0 ? 0 : texel[0];
            texel[6] = 1;
            for (size_t k = 12; k < texel.size(); ++k)
                texel[k] = float((x * 7919 + y * 104729 + int(k) * 1299709) & 0xffffff);
            image.setpixel(x, y, texel.data(), spec.nchannels);
        }
    return image;
}

struct LightWorkDone
{
    int64_t passes = work_counts().filter_passes, lookups = work_counts().texels_looked_up,
            multiplied = work_counts().texels_multiplied;

    LightWorkDone since() const
    {
        LightWorkDone now;
        now.passes -= passes, now.lookups -= lookups, now.multiplied -= multiplied;
        return now;
    }
};

} // namespace

TEST(EffectsLight, AFilterLeavesOneColourAsItIs)
{
    for (const char* filter : { "exact", "sh" })
        for (const bool skip : { true, false })
            for (const bool border : { true, false }) {
                ImageBuf env = one_color(37, 19);
                env.specmod().attribute("oiio:sampleborder", int(border));
                CfemParams params;
                params.filter = filter;
                params.resolution = { 11, 6 };
                params.skip_one_color = skip;
                const LightWorkDone before;
                std::vector<ImageBuf> stack;
                ImageBuf cfem;
                std::string error;
                ASSERT_TRUE(make_cfem(cfem, env, params)) << cfem.geterror();
                ASSERT_TRUE(make_cfem_stack(stack, env, params, error)) << error;
                expect_all(cfem, kLightColor[0], kLightColor[1], kLightColor[2]);
                for (const ImageBuf& image : stack)
                    expect_all(image, kLightColor[0], kLightColor[1], kLightColor[2]);
                EXPECT_EQ(before.since().passes, skip ? 0 : 5) << filter;
            }
}

TEST(EffectsLight, WhatIsNotOneColourIsFiltered)
{
    CfemParams params;
    params.resolution = { 8, 4 };
    ImageBuf env = one_color(16, 8), cfem;
    const auto passes = [&] {
        const LightWorkDone before;
        EXPECT_TRUE(make_cfem(cfem, env, params)) << cfem.geterror();
        return before.since().passes;
    };
    EXPECT_EQ(passes(), 0);
    env = nearly_one_color(16, 8);
    EXPECT_EQ(passes(), 1);
    // What is outside of the data window is black.
    env = one_color(16, 8);
    env.specmod().full_width = 20;
    EXPECT_EQ(passes(), 1);
    // A bad pixel is repaired by its neighbours, and counted; or refused.
    env = one_color(16, 8);
    pixels(env)[40] = NAN;
    EXPECT_FALSE(make_cfem(cfem, env, params));
    EXPECT_THAT(cfem.geterror(), testing::HasSubstr("1 value that is NaN or infinite"));
    params.sanitize = true;
    EXPECT_EQ(passes(), 0);
    EXPECT_EQ(cfem.spec().get_int_attribute("vmlight:sanitized"), 1);
}

TEST(EffectsLight, EveryModelGivesVTimesOneColour)
{
    const ImageBuf map = map_of_all_models(40, 30);
    for (const ModelEntry& entry : model_entries()) {
        CfemParams filter;
        filter.resolution = { 16, 8 };
        LightmapParams params;
        params.model = entry.name;
        params.exposure = 1;
        std::vector<ImageBuf> exact, near;
        std::string error;
        ASSERT_TRUE(make_model_light(exact, one_color(32, 16), filter, entry.light, error)) << error;
        ASSERT_TRUE(make_model_light(near, nearly_one_color(32, 16), filter, entry.light, error)) << error;
        // The other way: looked up, where no two directions see quite the same.
        pixels(near[0])[0] = std::nextafter(pixels(near[0])[0], 2 * kLightColor[0]);
        ImageBuf lit, forced, other;
        const LightWorkDone before;
        ASSERT_TRUE(make_lightmap(lit, map, exact, params)) << entry.name << ": " << lit.geterror();
        EXPECT_EQ(before.since().lookups, 0) << entry.name;
        EXPECT_EQ(before.since().passes, 0) << entry.name;
        params.skip_one_color = false;
        ASSERT_TRUE(make_lightmap(forced, map, exact, params)) << entry.name << ": " << forced.geterror();
        EXPECT_EQ(before.since().lookups, 40 * 30) << entry.name;
        ASSERT_TRUE(make_lightmap(other, map, near, params)) << entry.name << ": " << other.geterror();
        for (int y = 0; y < 30; ++y)
            for (int x = 0; x < 40; ++x) {
                float v = 0, p[3], q[3], r[3];
                map.getpixel(x, y, 0, &v, 1);
                lit.getpixel(x, y, 0, p, 3);
                forced.getpixel(x, y, 0, q, 3);
                other.getpixel(x, y, 0, r, 3);
                for (int c = 0; c < 3; ++c) {
                    EXPECT_EQ(p[c], 2 * v * kLightColor[c]) << entry.name;
                    EXPECT_EQ(p[c], q[c]) << entry.name;
                    EXPECT_NEAR(p[c], r[c], 2e-5 * double(p[c])) << entry.name;
                }
            }
    }
}

TEST(EffectsLight, LightOfOneColourHidesNoFault)
{
    const ImageBuf light = one_color(8, 4);
    LightmapParams params;
    params.model = "paper";
    const auto fault = [&](int channel, float value, const std::vector<ImageBuf>& images, const char* model) {
        ImageBuf map = map_of_all_models(4, 3), lit;
        map.setpixel(0, 0, std::vector<float>(size_t(map.nchannels()), 0.5f).data());
        std::vector<float> texel(size_t(map.nchannels()));
        map.getpixel(2, 1, texel.data());
        texel[size_t(channel)] = value;
        map.setpixel(2, 1, texel.data());
        params.model = model;
        EXPECT_FALSE(make_lightmap(lit, map, images, params)) << model;
        return lit.geterror();
    };
    EXPECT_THAT(fault(2, NAN, { light }, "paper"), testing::HasSubstr("not finite"));
    EXPECT_THAT(fault(0, 3, { light }, "paper"), testing::HasSubstr("cannot be visibility"));
    EXPECT_THAT(fault(5, INFINITY, { light }, "ao"), testing::HasSubstr("not finite"));
    std::vector<ImageBuf> stack;
    CfemParams small;
    small.resolution = { 8, 4 };
    std::string error;
    ASSERT_TRUE(make_cfem_stack(stack, light, small, error)) << error;
    EXPECT_THAT(fault(30, 0.5f, stack, "cells"), testing::HasSubstr("no longer whole"));
    stack[3].specmod().attribute("vmlight:lobe", 0.9f);
    EXPECT_THAT(fault(0, 1, stack, "lobe"), testing::HasSubstr("level 3 of the stack: vmlight:lobe is 0.9"));
    // Light without a colour of its own is not taken for one.
    ImageBuf broken = one_color(8, 4);
    OIIO::ImageBufAlgo::fill(broken, { NAN, NAN, NAN });
    EXPECT_THAT(fault(0, 1, { broken }, "paper"), testing::HasSubstr("not finite"));
}

TEST(EffectsLight, AnAlbedoOfOneMultipliesNothing)
{
    const ImageBuf map = random_vismap(20, 10), light = random_cfem(16, 8);
    ImageBuf without, with, forced;
    ASSERT_TRUE(make_lightmap(without, map, light));
    for (const int width : { 20, 7 })
        for (const int channels : { 3, 1 }) {
            ImageSpec spec(width, 10, channels, OIIO::TypeFloat);
            spec.channelnames
                = channels == 3 ? std::vector<std::string> { "R", "G", "B" } : std::vector<std::string> { "Y" };
            ImageBuf albedo(spec);
            const float ones[3] { 1, 1, 1 };
            OIIO::ImageBufAlgo::fill(albedo, { ones, channels });
            LightmapParams params;
            LightWorkDone before;
            ASSERT_TRUE(make_lightmap(with, map, light, params, &albedo)) << with.geterror();
            EXPECT_EQ(before.since().multiplied, 0) << width;
            EXPECT_EQ(std::memcmp(pixels(with), pixels(without), size_t(with.spec().image_bytes())), 0) << width;
            params.skip_one_albedo = false;
            ASSERT_TRUE(make_lightmap(forced, map, light, params, &albedo)) << forced.geterror();
            EXPECT_EQ(before.since().multiplied, 200) << width;
            EXPECT_EQ(std::memcmp(pixels(with), pixels(forced), size_t(with.spec().image_bytes())), 0) << width;
            // The last pixel of all.
            pixels(albedo)[width * 10 * channels - 1] = 0.5f;
            before = {};
            params.skip_one_albedo = true;
            ASSERT_TRUE(make_lightmap(with, map, light, params, &albedo)) << with.geterror();
            EXPECT_EQ(before.since().multiplied, 200) << width;
            EXPECT_NE(std::memcmp(pixels(with), pixels(without), size_t(with.spec().image_bytes())), 0) << width;
        }
}

TEST(EffectsLight, ARotationThatTurnsNothingAndAnExposureOfNothingChangeNothing)
{
    const ImageBuf map = random_vismap(20, 10), light = random_cfem(16, 8);
    ImageBuf without, with;
    LightWorkDone before;
    ASSERT_TRUE(make_lightmap(without, map, light));
    const LightWorkDone least = before.since();
    LightmapParams params[3];
    params[0].rotate = { 0, 0, 0 };
    params[1].quaternion = { 1, 0, 0, 0 };
    params[2].env_rotate = { 0, 0, 0 };
    for (const LightmapParams& one : params) {
        before = {};
        ASSERT_TRUE(make_lightmap(with, map, light, one));
        EXPECT_EQ(before.since().lookups, least.lookups);
        EXPECT_EQ(std::memcmp(pixels(with), pixels(without), size_t(with.spec().image_bytes())), 0);
    }
}

TEST(EffectsLight, OnlyTheFiltersThatTheModelReadsAreMade)
{
    const std::map<ModelLight, int64_t> passes { { ModelLight::cfem, 1 },
                                                 { ModelLight::lobes, 4 },
                                                 { ModelLight::radiance, 1 } };
    for (const ModelEntry& entry : model_entries()) {
        CfemParams filter;
        filter.resolution = { 16, 8 };
        std::vector<ImageBuf> images;
        std::string error;
        const LightWorkDone before;
        ASSERT_TRUE(make_model_light(images, random_cfem(32, 16), filter, entry.light, error)) << error;
        EXPECT_EQ(before.since().passes, passes.at(entry.light)) << entry.name;
    }
}
