// SPDX-License-Identifier: Apache-2.0
// Bounced light between quads: closed forms, the traced reference, and what is read again.
#include "quad_folder.h"

#include <vmlight/base/format.h>
#include <vmlight/math/latlong.h>
#include <vmlight/reference/reference.h>
#include <vmlight/stage/make_stage.h>

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <utility>

using namespace vmlight;
using namespace vmlight::stage_scene;

namespace {

constexpr const char* kFacade = "v 0 0 -1\nv 0 0 1\nv 0 1 1\nv 0 1 -1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 1 0 0\n"
                                "f 1/1/1 4/4/1 3/3/1 2/2/1\n";

} // namespace

// A tower behind a facade hides sky from the ground before it.
TEST(BounceScenes, OccludersThatNoTexelSeesShadeTheGround)
{
    const QuadFolder folder;
    folder.write("facade.obj", kFacade);
    folder.write("tower.obj", "v -0.2 0 -9\nv -0.2 0 9\nv -0.2 9 9\nv -0.2 9 -9\nf 1 2 3 4\n");
    const std::string map = "mesh = \"facade.obj\"\nground = true\n", tower = "occluder = [\"tower.obj\"]\n";
    LightmapRecipe recipe = folder.recipe(map);
    recipe.bounce_params.ground_albedo = 1;
    const double alone = folder.mean(folder.bounced(recipe));
    recipe = folder.recipe(map + tower);
    recipe.bounce_params.ground_albedo = 1;
    const std::vector<float> decided = folder.bounced(recipe);
    EXPECT_LT(folder.mean(decided), 0.8 * alone);
    recipe = folder.recipe(map + tower + "effects = \"all\"\n");
    recipe.bounce_params.ground_albedo = 1;
    EXPECT_EQ(folder.bounced(recipe), decided);
}

// V is 0 everywhere, and the ground around is lit: a ceiling .2 above it, or a much larger sheet that faces down too.
TEST(BounceScenes, TexelsThatSeeNoSkyAreLit)
{
    const QuadFolder folder;
    folder.write("ceiling.obj",
                 "v -1 0.2 -1\nv 1 0.2 -1\nv 1 0.2 1\nv -1 0.2 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 -1 0\n"
                 "f 1/1/1 2/2/1 3/3/1 4/4/1\n");
    folder.write("sheet.obj", "v -999 0 -999\nv 999 0 -999\nv 999 0 999\nv -999 0 999\nf 1 2 3 4\n");
    LightmapRecipe recipe = folder.recipe("mesh = \"ceiling.obj\"\nground = true\nground_height = 0\n");
    recipe.bounce_params.ground_albedo = 0.5;
    const std::vector<float> of_ground = folder.bounced(recipe);
    // At the edge half of what it sees is in the open.
    EXPECT_GT(of_ground[0], 0.2f);
    EXPECT_GT(folder.mean(of_ground), 0.02);
    recipe = folder.recipe("mesh = \"ceiling.obj\"\noccluder = [\"sheet.obj\"]\n");
    const std::vector<float> of_sheet = folder.bounced(recipe);
    EXPECT_NEAR(folder.mean(of_sheet), folder.mean(of_ground), 0.05 * folder.mean(of_ground));
}

// Texels of the floor, on the left of the map, see the wall, which is another part.
TEST(BounceScenes, OtherPartsHaveTheMeanAlbedoOfTheTexels)
{
    const QuadFolder folder;
    folder.write("corner.mtl", "newmtl floor\nnewmtl wall\n");
    folder.write("corner.obj",
                 "mtllib corner.mtl\nv 0 0 1\nv 1 0 1\nv 1 0 -1\nv 0 0 -1\nv 0 1 1\nv 0 1 -1\n"
                 "vt 0 0\nvt 0.5 0\nvt 0.5 1\nvt 0 1\nvt 1 0\nvt 1 1\nvn 0 1 0\nvn 1 0 0\n"
                 "usemtl floor\nf 1/1/1 2/2/1 3/3/1 4/4/1\nusemtl wall\nf 1/2/2 4/3/2 6/6/2 5/5/2\n");
    LightmapRecipe recipe = folder.recipe("mesh = \"corner.obj\"\nmaterial = [\"floor\"]\n");
    const double white = folder.mean(folder.bounced(recipe));
    EXPECT_GT(white, 0.01);
    folder.image("white.exr", 32, 32, [](int x, int) { return x < 16 ? 1.0f : 0.0f; }); // no texel is there
    EXPECT_NEAR(folder.mean(folder.bounced(recipe)), white, 1e-6);
}

// A black floor under a white roof, whose back it sees; both are a part of a mesh with something far off.
TEST(BounceScenes, BacksOfAPartHaveTheirOwnAlbedo)
{
    const QuadFolder folder;
    folder.write("shed.mtl", "newmtl shed\nnewmtl other\n");
    folder.write("shed.obj",
                 "mtllib shed.mtl\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nv -1 1 1\nv 1 1.4 1\nv 1 1.4 -1\nv -1 1 -1\n"
                 "v 8 -8 1\nv 9 -8 1\nv 9 -8 -1\nvt 0 0\nvt 0.5 0\nvt 0.5 1\nvt 0 1\nvt 1 0\nvt 1 1\nvn 0 1 0\n"
                 "usemtl shed\nf 1/1/1 2/2/1 3/3/1 4/4/1\nf 5/2/1 6/5/1 7/6/1 8/3/1\n"
                 "usemtl other\nf 9/1/1 10/1/1 11/1/1\n");
    folder.image("white.exr", 32, 32, [](int x, int) { return x < 16 ? 0.25f : 1.0f; });
    const std::vector<float> whole = folder.bounced(folder.recipe("mesh = \"shed.obj\"\n")),
                             part = folder.bounced(folder.recipe("mesh = \"shed.obj\"\nmaterial = [\"shed\"]\n"));
    EXPECT_GT(folder.mean(whole), 0.01);
    for (size_t i = 0; i < whole.size(); ++i)
        ASSERT_NEAR(part[i], whole[i], 1e-6f) << i;
}

TEST(BounceScenes, ColoursOfOccludersAreReadAgainWhenTheyChange)
{
    const QuadFolder folder;
    folder.write("facade.obj", kFacade);
    folder.write("red.mtl", "newmtl paint\nKd 1 0 0\n");
    folder.write("wall.obj",
                 "mtllib red.mtl\nusemtl paint\nv 0.5 0 -9\nv 0.5 0 9\nv 0.5 0.4 9\nv 0.5 0.4 -9\nf 1 2 3 4\n");
    LightmapRecipe recipe = folder.recipe("mesh = \"facade.obj\"\noccluder = [\"wall.obj\"]\n");
    folder.write("lit.lightmap",
                 "vismap = \"map.vismap\"\nenvironment = \"sky.exr\"\nalbedo = \"white.exr\"\nbounce = \"auto\"\n");
    LightmapInputs inputs; // of frames
    const auto make = [&] {
        std::string error;
        OIIO::ImageBuf image;
        EXPECT_TRUE(read_lightmap_inputs(inputs, recipe, {}, error)
                    && make_lightmap(image, inputs, recipe.lightmap_params, {}, error))
            << error;
        return all_pixels(image);
    };
    const auto read = [&] {
        const auto host = OIIO::ImageInput::open(folder / "lit.lightmap");
        return all_pixels(*host);
    };
    const std::vector<float> red = make();
    EXPECT_EQ(read(), red);
    EXPECT_GT(red[0], red[1] + 0.01f);
    folder.write("red.mtl", "newmtl paint\nKd 0 0.75 0\n");
    const std::vector<float> green = make();
    EXPECT_GT(green[1], green[0] + 0.01f);
    EXPECT_EQ(read(), green);
    // And a texture of theirs.
    folder.image("paint.exr", 4, 4, [](int, int) { return 0.5f; });
    folder.write("red.mtl", "newmtl paint\nKd 1 1 1\nmap_Kd paint.exr\n");
    const std::vector<float> grey = make();
    EXPECT_EQ(grey[0], grey[1]);
    EXPECT_EQ(read(), grey);
    folder.image("paint.exr", 4, 4, [](int x, int) { return x < 9 ? 0.25f : 1.0f; });
    const std::vector<float> dark = make();
    EXPECT_LT(dark[0], grey[0]);
    EXPECT_EQ(read(), dark);
}

TEST(BounceScenes, WhatWasStoppedIsTracedAgain)
{
    const QuadFolder folder;
    folder.write("facade.obj", kFacade);
    LightmapRecipe recipe = folder.recipe("mesh = \"facade.obj\"\nground = true\n");
    recipe.bounce_params.ground_albedo = 1;
    const std::vector<float> wanted = folder.lit(recipe);
    LightmapInputs inputs;
    OIIO::ImageBuf image;
    std::string error;
    MakeOptions options;
    options.progress = [&](const std::string&, int64_t) { return Progress([](double) { return false; }); };
    ASSERT_TRUE(read_lightmap_inputs(inputs, recipe, {}, error)) << error;
    EXPECT_FALSE(make_lightmap(image, inputs, recipe.lightmap_params, options, error));
    error.clear();
    ASSERT_TRUE(read_lightmap_inputs(inputs, recipe, {}, error)) << error;
    ASSERT_TRUE(make_lightmap(image, inputs, recipe.lightmap_params, {}, error)) << error;
    EXPECT_EQ(all_pixels(image), wanted);
}

TEST(BounceScenes, WhatCannotBounceIsSaidOrRefused)
{
    const QuadFolder folder;
    folder.write("facade.obj", kFacade);
    LightmapRecipe recipe = folder.recipe("mesh = \"facade.obj\"\nground = true\n");
    LightmapRecipe stored = recipe;
    VismapRecipe map;
    std::string error;
    ASSERT_TRUE(read_recipe(map, recipe.vismap, error)) << error;
    OIIO::ImageBuf baked;
    ASSERT_TRUE(make_image(baked, map)) << baked.geterror();
    ASSERT_TRUE(baked.write(folder / "map.exr")) << baked.geterror();
    stored.vismap = folder / "map.exr";
    recipe.albedo.clear();
    for (LightmapRecipe* known : { &recipe, &stored }) {
        std::vector<std::string> warnings;
        MakeOptions options;
        options.warn = [&](const std::string& line) { warnings.push_back(line); };
        OIIO::ImageBuf image;
        EXPECT_TRUE(make_image(image, *known, options)) << image.geterror();
        EXPECT_THAT(warnings, testing::Contains(testing::StartsWith("no bounced light: "))) << known->vismap;
        known->bounce_params.bounce = "on";
        EXPECT_FALSE(make_image(image, *known));
        EXPECT_THAT(image.geterror(),
                    testing::HasSubstr(known == &recipe ? "the bounce needs an albedo: set --albedo"
                                                        : "does not store its mesh: set --mesh, and "
                                                          "--occluder for each mesh that occluded it"));
    }
    stored.mesh = folder / "facade.obj";
    stored.occluder = { folder / "facade.obj" };
    OIIO::ImageBuf image;
    EXPECT_FALSE(make_image(image, stored));
    EXPECT_THAT(image.geterror(),
                testing::HasSubstr("baked without occluders; leave out --occluder, or bake the map again with it"));
    // A map of an earlier version has no names of them.
    baked.specmod().attribute("vmlight:occluderHash", "1");
    ASSERT_TRUE(baked.write(stored.vismap)) << baked.geterror();
    EXPECT_FALSE(make_image(image, stored));
    EXPECT_THAT(image.geterror(),
                testing::HasSubstr("baked with other occluders; list the same ones with --occluder, in "
                                   "the same order"));
}

// A tall wall, nearly all of whose hemisphere is open, under a sky that differs in all directions and is turned: its
// points need the right normal, B and basis. The difference of two references with the same rays is the bounce alone.
TEST(BounceScenes, EveryModelLightsPointsOffTheMapAsTheReference)
{
    const QuadFolder folder;
    folder.write("floor.obj",
                 "v 0.3 0 0.2\nv 0.7 0 0.2\nv 0.7 0 -0.2\nv 0.3 0 -0.2\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                 "vn 0 1 0\nf 1/1/1 2/2/1 3/3/1 4/4/1\n");
    const std::string wall = "v 0 0.3 1\nv 0 0.3 -1\nv 0.2 1.6 -1\nv 0.2 1.6 1\nf 1 2 3 4\n";
    folder.write("wall.obj", wall);
    OIIO::ImageBuf sky(OIIO::ImageSpec(64, 32, 3, OIIO::TypeFloat));
    for (OIIO::ImageBuf::Iterator<float> pixel(sky); !pixel.done(); ++pixel) {
        const Imath::V3d w = latlong::direction((pixel.x() + 0.5) / 64, (pixel.y() + 0.5) / 32);
        for (int c = 0; c < 3; ++c)
            pixel[c] = float(1 + 0.9 * w[c]);
    }
    ASSERT_TRUE(sky.write(folder / "sky.exr")) << sky.geterror();
    LightmapParams turned;
    turned.rotate = { 20, 70, 0 };

    Mesh floor, occluder;
    std::string error;
    ASSERT_TRUE(read_mesh(floor, folder / "floor.obj", {}, error)) << error;
    ASSERT_TRUE(read_mesh(occluder, folder / "wall.obj", {}, error)) << error;
    VismapParams map;
    map.resolution = { 32, 32 };
    ReferenceParams params;
    params.samples = 256;
    OIIO::ImageBuf direct, all;
    ASSERT_TRUE(make_reference(direct, floor, { occluder }, sky, map, turned, params)) << direct.geterror();
    params.bounce_albedo = 1;
    ASSERT_TRUE(make_reference(all, floor, { occluder }, sky, map, turned, params)) << all.geterror();
    std::array<double, 3> wanted {};
    for (OIIO::ImageBuf::ConstIterator<float> a(all), b(direct); !a.done(); ++a, ++b)
        for (int c = 0; c < 3; ++c)
            wanted[size_t(c)] += (double(a[c]) - double(b[c])) / (32 * 32);
    // The three colours differ: light from the wrong side would show.
    EXPECT_GT(*std::max_element(wanted.begin(), wanted.end()), 1.3 * *std::min_element(wanted.begin(), wanted.end()));

    const auto basis_of = [](const char* basis) { return format("basis = \"{}\"\n", basis); };
    for (const auto& [model, basis] :
         std::vector<std::pair<const char*, std::string>> { { "paper", "" },
                                                            { "lobe", "" },
                                                            { "ao", "" },
                                                            { "sh", basis_of("sh") },
                                                            { "mask", basis_of("mask") },
                                                            { "cells", basis_of("cells") } }) {
        LightmapRecipe recipe
            = folder.recipe("mesh = \"floor.obj\"\noccluder = [\"wall.obj\"]\nchannels = \"normal\"\n" + basis);
        recipe.lightmap_params = turned;
        recipe.lightmap_params.model = model;
        recipe.bounce_params.bounce_albedo = 1;
        const std::vector<float> light = folder.bounced(recipe);
        for (size_t c = 0; c < 3; ++c) {
            double mean = 0;
            for (size_t i = c; i < light.size(); i += 3)
                mean += double(light[i]) / (32 * 32);
            EXPECT_NEAR(mean, wanted[c], 0.03 * wanted[c]) << model << " " << c;
        }
    }
}
