// SPDX-License-Identifier: Apache-2.0
#include "scenes.h"
#include "stack_maps.h"

#include <vmlight/vismap/vismap.h>

#include <OpenImageIO/imagebufalgo.h>

#include <array>
#include <cstdio>

using namespace vmlight;
using namespace scene;
using OIIO::ImageBufAlgo::channels;

namespace {

std::string light_refusal(const ImageBuf& vm, const ImageBuf& map, const LightmapParams& params = {},
                          const ImageBuf* albedo = nullptr, const Progress& progress = {})
{
    ImageBuf dst(ImageSpec(8, 8, 3, OIIO::TypeFloat));
    EXPECT_FALSE(make_lightmap(dst, vm, map, params, albedo, 2, progress));
    EXPECT_FALSE(dst.initialized());
    EXPECT_TRUE(dst.has_error());
    return dst.geterror();
}

ImageBuf with_stage(ImageBuf image, const char* stage)
{
    image.specmod().attribute("vmlight:stage", stage);
    return image;
}

ImageBuf with_value(ImageBuf image, int x, int y, int channel, float value)
{
    pixels(image)[(size_t(y) * image.spec().width + x) * image.nchannels() + channel] = value;
    return image;
}

const ImageBuf kGoodVismap = random_vismap(30, 20), kGoodCfem = random_cfem(16, 8);

} // namespace

TEST(LightmapRefusal, PixelsThatAreNotFiniteAreCountedAndTheFirstIsTold)
{
    ImageBuf vm = with_value(with_value(with_value(kGoodVismap, 29, 19, 0, INFINITY), 4, 12, 2, NAN), 5, 12, 0, NAN);
    EXPECT_EQ(light_refusal(vm, kGoodCfem),
              "visibility map has 3 values that are not finite, the first at pixel (4, 12) channel "
              "\"direction.y\"");
    const std::array<int, 4> exr { 1, 2, 3, 0 };
    EXPECT_EQ(light_refusal(channels(vm, 4, exr), kGoodCfem),
              "visibility map has 3 values that are not finite, the first at "
              "pixel (4, 12) channel \"direction.y\"");
    EXPECT_EQ(light_refusal(kGoodVismap, with_value(kGoodCfem, 15, 7, 2, -INFINITY)),
              "cosine-filtered environment has 1 value that is not finite, at pixel (15, 7) channel \"B\"");
    // Filters that ring go below 0, and light that is a little negative must pass.
    EXPECT_LT(color(lit(one_texel(1, V3f(0, 1, 0)), cfem(4, 2, [](V3d) { return V3f(-1); }))).x, 0);

    const ImageBuf albedo = with_value(with_value(random_cfem(30, 20), 7, 3, 1, -0.5f), 7, 3, 2, NAN);
    EXPECT_EQ(light_refusal(kGoodVismap, kGoodCfem, {}, &albedo),
              "albedo has 2 values that are negative or not finite, the first at pixel (7, 3) channel \"G\"");
    const ImageBuf small = with_value(random_cfem(9, 9), 7, 3, 1, NAN);
    EXPECT_EQ(light_refusal(kGoodVismap, kGoodCfem, {}, &small),
              "albedo has 1 value that is negative or not finite, at pixel (7, 3) channel \"G\"");
}

TEST(LightmapRefusal, AVisibilityThatIsNoneIsRefusedByEveryModel)
{
    const std::vector<ImageBuf> light = filtered_stack(random_cfem(16, 8), 16);
    for (const char* model : { "paper", "lobe", "ao", "sh", "mask", "cells" }) {
        SCOPED_TRACE(model);
        VismapParams bake;
        bake.resolution = { 8, 8 };
        bake.samples = 4;
        bake.channels = { "normal" };
        for (const char* basis : { "sh", "mask", "cells" })
            if (basis == std::string(model))
                bake.basis = basis;
        ImageBuf baked;
        ASSERT_TRUE(make_vismap(baked, scenes::floor_facing_z(1), {}, bake)) << baked.geterror();
        LightmapParams params;
        params.model = model;
        ImageBuf dst;
        for (float rung : { -2.0f, -0.3f, 1.3f, 2.0f })
            EXPECT_TRUE(make_lightmap(dst, with_value(baked, 3, 2, 0, rung), light, params)) << dst.geterror();
        for (float none : { -2.1f, 2.1f, 255.0f, 1e30f }) {
            EXPECT_FALSE(make_lightmap(dst, with_value(baked, 3, 2, 0, none), light, params));
            EXPECT_EQ(dst.geterror(),
                      "visibility map has 1 value that is outside [-2, 2] and so cannot be visibility, at pixel (3, 2) "
                      "channel \"visibility\"");
        }
    }
}

TEST(LightmapRefusal, AResultTooLargeForFloatIsRefused)
{
    const ImageBuf bright = cfem(4, 2, [](V3d) { return V3f(1e30f, 1, 1); });
    LightmapParams params;
    EXPECT_NEAR(color(lit(one_texel(1, V3f(0, 1, 0)), bright, params)).x, 1e30f, 1e24f);
    params.exposure = 60;
    EXPECT_EQ(light_refusal(one_texel(1, V3f(0, 1, 0)), bright, params),
              "lightmap has 1 value that is too large for float, at pixel (0, 0) channel \"R\"");
    EXPECT_EQ(light_refusal(kGoodVismap, cfem(4, 2, [](V3d n) { return V3f(n.x > 0 && n.z > 0 ? -3e38f : 3e38f); })),
              "cosine-filtered environment has values too large to interpolate");
}

TEST(LightmapRefusal, WhatIsNotAStagesImageIsRefused)
{
    EXPECT_EQ(light_refusal(kGoodCfem, kGoodCfem), "not a visibility map: no channel \"visibility\" among R, G, B");
    EXPECT_EQ(light_refusal(with_stage(kGoodVismap, "lightmap"), kGoodCfem),
              "not a visibility map: its vmlight:stage is \"lightmap\", not \"vismap\"");
    EXPECT_EQ(light_refusal(kGoodVismap, with_stage(kGoodCfem, "lightmap")),
              "not a cosine-filtered environment: its vmlight:stage is \"lightmap\", not \"cfem\"");
    EXPECT_EQ(light_refusal(kGoodVismap, with_stage(kGoodVismap, "vismap")),
              "not a cosine-filtered environment: its vmlight:stage is \"vismap\", not \"cfem\"");
    const std::string no_light = "no channels R, G, B, and no Y of grey, among visibility, direction.x, direction.y, "
                                 "direction.z; if one of them is light, name it with oiiotool --ch NAME,NAME,NAME "
                                 "--chnames R,G,B";
    EXPECT_EQ(light_refusal(kGoodVismap, kGoodVismap), no_light);
    EXPECT_EQ(light_refusal(kGoodVismap, kGoodCfem, {}, &kGoodVismap), no_light);
    const ImageBuf nothing;
    EXPECT_EQ(light_refusal(nothing, kGoodCfem), "no visibility map: the image is empty");
    EXPECT_EQ(light_refusal(kGoodVismap, nothing), "no cosine-filtered environment: the image is empty");
    EXPECT_EQ(light_refusal(kGoodVismap, kGoodCfem, {}, &nothing), "no albedo: the image is empty");
    ImageSpec deep(4, 4, 4, OIIO::TypeFloat);
    deep.deep = true;
    EXPECT_EQ(light_refusal(ImageBuf(deep), kGoodCfem), "not a visibility map: a deep image");
    ImageSpec volume(4, 4, 3, OIIO::TypeFloat);
    volume.depth = 2;
    EXPECT_EQ(light_refusal(kGoodVismap, ImageBuf(volume)), "not a cosine-filtered environment: a volume image");
}

TEST(LightmapRefusal, ACfemIsTheWholeSphereByTexelsAtTheirCentres)
{
    ImageBuf crop = random_cfem(16, 8);
    crop.specmod().full_width = 32;
    EXPECT_EQ(light_refusal(kGoodVismap, crop),
              "cosine-filtered environment is cropped: it stores 16x8 pixels of 32x8");
    ImageBuf border = random_cfem(16, 8);
    border.specmod().attribute("oiio:sampleborder", 1);
    EXPECT_EQ(light_refusal(kGoodVismap, border),
              "cosine-filtered environment has samples on its borders, as maketx --envlatl makes them; use plain "
              "maketx, which keeps the pixels");
}

TEST(LightmapRefusal, NamesOfSeveralLinesAreToldOnOne)
{
    ImageBuf vm = kGoodVismap;
    vm.specmod().channelnames[1] = "a\nb\xff";
    EXPECT_EQ(light_refusal(vm, kGoodCfem),
              "not a visibility map: no channel \"direction.x\" among visibility, a\\x0ab\\xff, "
              "direction.y, direction.z");
}

TEST(LightmapRefusal, AnAlbedoOfNoSizeIsRefused)
{
    ImageBuf albedo = random_cfem(30, 20);
    albedo.specmod().full_width = 0;
    EXPECT_EQ(light_refusal(kGoodVismap, kGoodCfem, {}, &albedo),
              "display window of 0x20 pixels: sides must be 1 to 65536");
}

TEST(LightmapRefusal, ParametersAreChecked)
{
    LightmapParams params;
    params.model = "radiosity";
    EXPECT_EQ(light_refusal(kGoodVismap, kGoodCfem, params),
              "model: \"radiosity\" is not one of auto, ao, paper, lobe, sh, mask, cells");
    params = {};
    params.rotate = { 1, 2 };
    EXPECT_EQ(light_refusal(kGoodVismap, kGoodCfem, params), "rotate: \"1,2\" has 2 numbers, expected 3");
    params.rotate = { 0, 90, 0 };
    params.quaternion = { 1, 0, 0, 0 };
    EXPECT_EQ(light_refusal(kGoodVismap, kGoodCfem, params), "only one of rotate, matrix and quaternion may be given");
    params = {};
    params.matrix = { 2, 0, 0, 0, 1, 0, 0, 0, 1 };
    EXPECT_EQ(light_refusal(kGoodVismap, kGoodCfem, params),
              "matrix: not a rotation: R R^T differs from the identity by 3, at most 1e-4 is allowed");
    params = {};
    params.quaternion = { 0, 0, 0, 0 };
    EXPECT_EQ(light_refusal(kGoodVismap, kGoodCfem, params), "quaternion: 0,0,0,0 is zero or not finite");
    params = {};
    params.exposure = 65;
    EXPECT_EQ(light_refusal(kGoodVismap, kGoodCfem, params), "exposure: 65 is not in [-64, 64]");
}

TEST(LightmapRefusal, ProgressMayStopTheWork)
{
    const ImageBuf vm = random_vismap(300, 200);
    double last = 0;
    EXPECT_EQ(light_refusal(vm, kGoodCfem, {}, nullptr, [&](double done) { return last = done, false; }),
              "interrupted");
    EXPECT_GT(last, 0);
    EXPECT_LE(last, 1);
}

TEST(LightmapRefusal, AFileIsNamed)
{
    const std::string path = testing::TempDir() + "lightmap_refusal_test.exr";
    ASSERT_TRUE(with_value(kGoodVismap, 3, 2, 0, NAN).write(path));
    EXPECT_EQ(light_refusal(ImageBuf(path), kGoodCfem),
              "\"" + path
                  + "\": visibility map has 1 value that is not finite, at pixel (3, 2) channel \"visibility\"");
    std::remove(path.c_str());
    const std::string text = light_refusal(ImageBuf(path), kGoodCfem);
    EXPECT_NE(text.find(path), std::string::npos) << text;
}
