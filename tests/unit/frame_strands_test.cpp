// SPDX-License-Identifier: Apache-2.0
// Strands in frames: where they are, how they are looked up and lit, and what is in front.
#include "frame_scenes.h"
#include "stage_scene.h"
#include "strand_files.h"

#include <vmlight/frame/lit_object.h>
#include <vmlight/frame/lit_strands.h>

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace vmlight;
using namespace vmlight::frame_scenes;
using namespace vmlight::strand_files;
using Imath::C3f;

namespace {

constexpr int kTexels = 8;

/// White strands, or with `light` along each of their kTexels texels.
FrameSurface strand_surface(const Strands& strands, const std::vector<float>& light = {})
{
    FrameSurface surface;
    StrandLayout layout;
    std::string error;
    EXPECT_TRUE(StrandLayout::make(layout, strands.count(), kTexels, error)) << error;
    Mesh mesh;
    mesh.strands = std::make_shared<const Strands>(strands);
    surface.strands = std::make_shared<StrandSurface>(mesh.strands, layout);
    surface.mesh = shared(std::move(mesh));
    surface.light = light.empty() ? texture_of(1, 1, { 1, 1, 1 }) : texture_of(kTexels, int(strands.count()), light);
    return surface;
}

Strands upright(double x, double radius, double z = 0)
{
    return straight({ { V3d(x, -2, z), V3d(x, 2, z) } }, radius, 5);
}

double mean_alpha(const OIIO::ImageBuf& image)
{
    double sum = 0;
    for (OIIO::ImageBuf::ConstIterator<float> pixel(image); !pixel.done(); ++pixel)
        sum += double(pixel[3]);
    return sum / double(image.spec().image_pixels());
}

} // namespace

TEST(FrameStrands, CoverTheirWidthHoweverThin)
{
    for (const double radius : { .1, .01, .001 }) { // from 6 pixels to a sixteenth of one
        const FrameScene scene = scene_of({ strand_surface(upright(.013, radius)) });
        for (const char* sampling : { "all", "edges" }) {
            RenderParams params = params_of(64, 256);
            params.sampling = sampling;
            // Samples are in 256 columns a pixel: one more or less of them.
            EXPECT_NEAR(mean_alpha(rendered(scene, square_on(), params)), radius, .01 * radius + 1.0 / (64 * 256))
                << sampling;
        }
    }
}

TEST(FrameStrands, AreSampledWholeAmongSmoothSurfaces)
{
    FrameSurface wall = surface_of(scenes::floor_facing_z(2, V3d(0, 0, -1)), { 0, 0, 1 });
    const FrameScene scene = scene_of({ wall, strand_surface(upright(.013, .002)) });
    RenderParams params = params_of(64, 16);
    const OIIO::ImageBuf edges = rendered(scene, square_on(), params);
    params.sampling = "all";
    const OIIO::ImageBuf all = rendered(scene, square_on(), params);
    bool is_seen = false;
    for (int x = 0; x < 64; ++x) {
        is_seen = is_seen || pixel(all, x, 30)[0] > .05f;
        EXPECT_NEAR(pixel(edges, x, 30)[0], pixel(all, x, 30)[0], 1e-6) << x;
    }
    EXPECT_TRUE(is_seen);
}

TEST(FrameStrands, LookUpTheirOwnRowOfTheMap)
{
    const Strands pair = straight({ { V3d(-.5, -1, 0), V3d(-.5, 1, 0) }, { V3d(.5, -1, 0), V3d(.5, 1, 0) } }, .2, 4);
    std::vector<float> light;
    for (int strand = 0; strand < 2; ++strand)
        for (int k = 0; k < kTexels; ++k)
            for (const float value : { float(k), float(10 * strand), 1.f })
                light.push_back(value);
    const OIIO::ImageBuf image = rendered(scene_of({ strand_surface(pair, light) }), square_on(), params_of(64));
    for (const int x : { 16, 48 })
        for (const int y : { 2, 20, 33, 50, 61 }) {
            const double share = 1 - (y + .5) / 64; // the root is below
            const std::vector<float> seen = pixel(image, x, y);
            EXPECT_NEAR(seen[0], std::clamp(share * kTexels - .5, 0.0, kTexels - 1.0), .02) << x << " " << y;
            EXPECT_NEAR(seen[1], x == 16 ? 0 : 10, 1e-3);
        }
}

TEST(FrameStrands, ArePartOfTheScene)
{
    const FrameSurface wall = surface_of(scenes::floor_facing_z(2), { 0, 0, 1 });
    FrameSurface strand = strand_surface(upright(0, .2, 1));
    strand.strand_color = C3f(.5f, 0, 0);
    const std::vector<float> before = pixel(rendered(scene_of({ wall, strand }), square_on(), params_of(32)), 16, 16);
    EXPECT_EQ(before, (std::vector<float> { .5f, 0, 0, 1 }));
    const FrameSurface behind = strand_surface(upright(0, .2, -1));
    EXPECT_EQ(pixel(rendered(scene_of({ wall, behind }), square_on(), params_of(32)), 16, 16)[2], 1);
}

TEST(FrameStrands, HaveLayers)
{
    RenderParams params = params_of(33);
    params.layers = { "normal", "position", "uv", "depth", "coverage" };
    const OIIO::ImageBuf image = rendered(scene_of({ strand_surface(upright(0, .2, 1)) }), square_on(false), params);
    const auto at = [&](const char* name) { return image.getchannel(16, 16, 0, image.spec().channelindex(name)); };
    EXPECT_NEAR(at("normal.z"), 1, 1e-6);
    EXPECT_NEAR(at("normal.y"), 0, 1e-6);
    EXPECT_NEAR(at("depth.Z"), 4, 1e-5);
    EXPECT_NEAR(at("position.z"), 1, 1e-5);
    EXPECT_NEAR(at("uv.u"), .5, 1e-5);
    EXPECT_NEAR(at("uv.v"), .5, 1e-5);
    EXPECT_EQ(at("coverage"), 1);
}

namespace {

class FrameGroom : public testing::Test
{
protected:
    FrameGroom()
    {
        folder.write("hair.tfx", tfx(5, 4));
        OIIO::ImageBuf sky(OIIO::ImageSpec(32, 16, 3, OIIO::TypeFloat));
        OIIO::ImageBufAlgo::fill(sky, { .5f, .5f, .5f });
        EXPECT_TRUE(sky.write(folder / "grey.exr")) << sky.geterror();
        recipe.map.mesh = folder / "hair.tfx";
        recipe.map.strand_params.radius = "0.05";
        recipe.map.vismap_params.samples = 16;
    }
    SceneLight light_of(const char* name, bool is_stack = true)
    {
        SceneLight light;
        CfemRecipe filter;
        filter.stack = is_stack;
        filter.cfem_params.resolution = { 32, 16 };
        std::string error;
        EXPECT_TRUE(light.open(folder / name, filter, true, {}, error)) << error;
        return light;
    }
    static LightmapParams model(const char* name)
    {
        LightmapParams params;
        params.model = name;
        return params;
    }
    stage_scene::Folder folder;
    ObjectRecipe recipe;
};

} // namespace

TEST_F(FrameGroom, IsMadeOfAFileOfStrands)
{
    EXPECT_NE(dynamic_cast<LitStrands*>(make_frame_object(recipe).get()), nullptr);
    recipe.map.mesh = folder / "spot.obj"; // a radius is of the strands beside it
    EXPECT_NE(dynamic_cast<LitObject*>(make_frame_object(recipe).get()), nullptr);
}

TEST_F(FrameGroom, UnderAConstantSkyItsLightIsV)
{
    const SceneLight light = light_of("grey.exr");
    struct Asked
    {
        std::string name, used;
        size_t warnings;
    };
    for (const Asked& asked :
         { Asked { "auto", "sh", 0 }, { "ao", "ao", 0 }, { "lobe", "lobe", 0 }, { "paper", "sh", 1 } }) {
        LitStrands hair;
        std::string error, used;
        std::vector<std::string> warnings;
        MakeOptions options;
        options.warn = [&](const std::string& line) { warnings.push_back(line); };
        ASSERT_TRUE(hair.open(recipe, options, error)) << error;
        for (int i = 0; i < 2; ++i)
            ASSERT_TRUE(hair.light(light, model(asked.name.c_str()), {}, options, error, &used)) << error;
        EXPECT_EQ(used, asked.used);
        EXPECT_EQ(warnings.size(), asked.warnings) << asked.name; // once
        const OIIO::ImageBuf &map = hair.maps().at(1001), &lit = hair.lightmaps().at(1001);
        for (int y = 0; y < 5; ++y)
            for (int x = 0; x < 16; ++x)
                EXPECT_NEAR(lit.getchannel(x, y, 0, 0), .5f * map.getchannel(x, y, 0, 0), 1e-5) << asked.name;
    }
}

TEST_F(FrameGroom, ShadesTheMeshAndIsShadedByIt)
{
    const auto mean_v = [&](FrameObject& object, const std::vector<FrameSurface>& others) {
        std::string error;
        EXPECT_TRUE(object.open(recipe, {}, error)) << error;
        object.set_occluders(others);
        EXPECT_TRUE(object.light(light_of("grey.exr"), model("auto"), {}, {}, error)) << error;
        double sum = 0;
        const OIIO::ImageBuf& map = object.maps().at(1001);
        for (OIIO::ImageBuf::ConstIterator<float> texel(map); !texel.done(); ++texel)
            sum += double(texel[0]);
        return sum;
    };
    LitStrands alone, among;
    LitObject bare, covered;
    FrameSurface mesh = surface_of(scenes::floor_facing_z(5, V3d(0, 0, -.2)));
    EXPECT_LT(mean_v(among, { mesh }), .7 * mean_v(alone, {}));
    const FrameSurface hair = alone.surface();
    recipe.map.mesh = folder / "spot.obj";
    recipe.map.vismap_params.resolution = { 32, 32 };
    EXPECT_LT(mean_v(covered, { hair }), mean_v(bare, {}));
}

TEST_F(FrameGroom, WhatItCannotBeLitByIsRefused)
{
    const auto refusal = [&](const SceneLight& light) {
        LitStrands hair;
        std::string error;
        EXPECT_FALSE(hair.open(recipe, {}, error) && hair.light(light, model("auto"), {}, {}, error));
        return error;
    };
    EXPECT_THAT(refusal(light_of("grey.exr", false)), testing::HasSubstr("the environment itself, or a stack"));
    const SceneLight stack = light_of("grey.exr");
    recipe.vismap = folder / "hero.vismap";
    EXPECT_THAT(refusal(stack), testing::HasSubstr("a visibility map of a mesh, not of strands"));
    recipe.vismap = folder.write("hair.vismap", "mesh = \"hair.tfx\"\nradius = \"0.05\"\nsamples = 4\n");
    recipe.map.strand_params.strand_texels = 4;
    EXPECT_THAT(refusal(stack), testing::HasSubstr("set --strand-texels to what it was baked with"));
    recipe.map.strand_params.radius.clear();
    EXPECT_THAT(refusal(stack), testing::HasSubstr("--radius ROOT:TIP"));
}
