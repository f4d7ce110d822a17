// SPDX-License-Identifier: Apache-2.0
// Bounced light through recipes: what a host reads tile by tile is what the executables make.
#include "stage_scene.h"

#include <vmcost/models.h>
#include <vmlight/base/format.h>
#include <vmlight/math/latlong.h>
#include <vmlight/reference/reference.h>
#include <vmlight/stage/make_stage.h>

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <functional>
#include <thread>
#include <utility>

using namespace vmlight;
using namespace vmlight::stage_scene;

namespace {

// The cow, which lights itself, on a ground, with an albedo of noise.
class BounceFolder : public Folder
{
public:
    BounceFolder()
    {
        OIIO::ImageBuf albedo(OIIO::ImageSpec(64, 48, 3, OIIO::TypeFloat));
        OIIO::ImageBufAlgo::noise(albedo, "uniform", 0.0f, 1.0f, false, 3);
        EXPECT_TRUE(albedo.write(*this / "paint.exr")) << albedo.geterror();
        write("ground.vismap", "mesh = \"spot.obj\"\nresolution = [200, 150]\nsamples = 16\nground = true\n");
        write("plain.lightmap", "vismap = \"ground.vismap\"\ncfem = \"studio.cfem\"\nalbedo = \"paint.exr\"\n");
        write("bounced.lightmap",
              "vismap = \"ground.vismap\"\ncfem = \"studio.cfem\"\nalbedo = \"paint.exr\"\nbounce = \"auto\"\n"
              "ground_albedo = 0.4\nrotate = [0, 30, 0]\nexposure = 0.7\n");
    }
    // And a recipe that is lit by it.
    void add_sun() const
    {
        OIIO::ImageBuf sky(OIIO::ImageSpec(128, 64, 3, OIIO::TypeFloat));
        for (OIIO::ImageBuf::Iterator<float> p(sky); !p.done(); ++p)
            p[0] = p[1] = p[2] = p.x() == 40 && p.y() == 14 ? 5e4f : 1.0f;
        EXPECT_TRUE(sky.write(*this / "sunny.exr")) << sky.geterror();
        write("sunny.lightmap",
              "vismap = \"ground.vismap\"\nenvironment = \"sunny.exr\"\nalbedo = \"paint.exr\"\nbounce = \"auto\"\n"
              "ground_albedo = 0.4\nsuns = \"on\"\nmodel = \"lobe\"\n");
    }
    OIIO::ImageBuf made(const std::string& name, int threads = 0) const
    {
        LightmapRecipe recipe;
        std::string error;
        EXPECT_TRUE(read_recipe(recipe, *this / name, error)) << error;
        MakeOptions options;
        options.chain = { *this / name };
        options.threads = threads;
        OIIO::ImageBuf image;
        EXPECT_TRUE(make_image(image, recipe, options)) << image.geterror();
        return image;
    }
};

// Scenes of quads, 32x32 texels each, under a sky of 1 and with albedos of 1, unless a test writes others.
class QuadFolder : public Folder
{
public:
    QuadFolder()
    {
        image("sky.exr", 8, 4, [](int, int) { return 1.0f; });
        image("white.exr", 32, 32, [](int, int) { return 1.0f; });
    }
    void image(const std::string& name, int width, int height, const std::function<float(int x, int y)>& at) const
    {
        OIIO::ImageBuf image(OIIO::ImageSpec(width, height, 3, OIIO::TypeFloat));
        for (OIIO::ImageBuf::Iterator<float> pixel(image); !pixel.done(); ++pixel)
            pixel[0] = pixel[1] = pixel[2] = at(pixel.x(), pixel.y());
        EXPECT_TRUE(image.write(*this / name)) << image.geterror();
    }
    LightmapRecipe recipe(const std::string& map) const
    {
        LightmapRecipe recipe;
        write("map.vismap", "resolution = 32\nmargin = 0\nsamples = 256\n" + map);
        recipe.vismap = *this / "map.vismap";
        recipe.environment = *this / "sky.exr";
        recipe.albedo = *this / "white.exr";
        recipe.bounce_params.bounce = "auto";
        return recipe;
    }
    static std::vector<float> lit(const LightmapRecipe& recipe)
    {
        OIIO::ImageBuf image;
        EXPECT_TRUE(make_image(image, recipe)) << image.geterror();
        return image.initialized() ? all_pixels(image) : std::vector<float>(3 * 32 * 32);
    }
    // What the bounce adds.
    static std::vector<float> bounced(const LightmapRecipe& recipe)
    {
        LightmapRecipe direct = recipe;
        direct.bounce_params = {};
        std::vector<float> all = lit(recipe);
        const std::vector<float> of_sky = lit(direct);
        for (size_t i = 0; i < all.size(); ++i)
            all[i] -= of_sky[i];
        return all;
    }
    static double mean(const std::vector<float>& values)
    {
        double sum = 0;
        for (const float value : values)
            sum += double(value) / double(values.size());
        return sum;
    }
};

constexpr const char* kFacade = "v 0 0 -1\nv 0 0 1\nv 0 1 1\nv 0 1 -1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 1 0 0\n"
                                "f 1/1/1 4/4/1 3/3/1 2/2/1\n";

} // namespace

// A tower behind a facade hides sky from the ground before it.
TEST(BounceStage, OccludersThatNoTexelSeesShadeTheGround)
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
TEST(BounceStage, TexelsThatSeeNoSkyAreLit)
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
TEST(BounceStage, OtherPartsHaveTheMeanAlbedoOfTheTexels)
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
TEST(BounceStage, BacksOfAPartHaveTheirOwnAlbedo)
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

TEST(BounceStage, ColoursOfOccludersAreReadAgainWhenTheyChange)
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

TEST(BounceStage, WhatWasStoppedIsTracedAgain)
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

TEST(BounceStage, WhatCannotBounceIsSaidOrRefused)
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
                                                        : "does not store its mesh, which the bounce "
                                                          "needs: set --mesh (and --occluder)"));
    }
    stored.mesh = folder / "facade.obj";
    stored.occluder = { folder / "facade.obj" };
    OIIO::ImageBuf image;
    EXPECT_FALSE(make_image(image, stored));
    EXPECT_THAT(image.geterror(),
                testing::HasSubstr("baked with other occluders; list the same ones with --occluder, in "
                                   "the same order"));
}

// A tall wall, nearly all of whose hemisphere is open, under a sky that differs in all directions and is turned: its
// points need the right normal, B and basis. The difference of two references with the same rays is the bounce alone.
TEST(BounceStage, EveryModelLightsPointsOffTheMapAsTheReference)
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

TEST(BounceStage, AHostReadsWhatTheExecutablesMake)
{
    const BounceFolder folder;
    const std::vector<float> whole = all_pixels(folder.made("bounced.lightmap"));
    EXPECT_EQ(all_pixels(folder.made("bounced.lightmap", 1)), whole);
    const auto host = OIIO::ImageInput::open(folder / "bounced.lightmap");
    ASSERT_TRUE(host) << OIIO::geterror();
    EXPECT_EQ(all_pixels(*host), whole);
    EXPECT_EQ(host->spec().get_string_attribute("vmlight:bounce"), "auto");
    for (const float value : whole)
        ASSERT_TRUE(std::isfinite(value));
}

TEST(BounceStage, TilesShareOneTrace)
{
    const BounceFolder folder;
    const std::vector<float> whole = all_pixels(folder.made("bounced.lightmap"));
    const int64_t before = work_counts().bounces_made;
    const auto input = OIIO::ImageInput::open(folder / "bounced.lightmap");
    ASSERT_TRUE(input) << OIIO::geterror();
    std::vector<std::thread> threads;
    for (int k = 0; k < 4; ++k)
        threads.emplace_back([&] {
            const auto own = OIIO::ImageInput::open(folder / "bounced.lightmap");
            EXPECT_EQ(all_pixels(*own), whole);
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(work_counts().bounces_made, before + 1);
}

TEST(BounceStage, NoKeyNoWork)
{
    const BounceFolder folder;
    const int64_t rays = work_counts().bounce_rays, made = work_counts().bounces_made;
    const std::vector<float> plain = all_pixels(folder.made("plain.lightmap"));
    const auto host = OIIO::ImageInput::open(folder / "plain.lightmap");
    ASSERT_TRUE(host) << OIIO::geterror();
    EXPECT_EQ(all_pixels(*host), plain);
    EXPECT_EQ(host->spec().find_attribute("vmlight:bounce"), nullptr);
    EXPECT_EQ(work_counts().bounce_rays, rays);
    EXPECT_EQ(work_counts().bounces_made, made);
}

TEST(BounceStage, WhateverTheAlbedoLightIsFinite)
{
    const BounceFolder folder;
    for (const float value : { 0.0f, 1e-30f, 1.0f, 50.0f }) {
        OIIO::ImageBuf albedo(OIIO::ImageSpec(8, 8, 3, OIIO::TypeFloat));
        const float rgb[3] { value, value, value };
        OIIO::ImageBufAlgo::fill(albedo, rgb);
        ASSERT_TRUE(albedo.write(folder / "paint.exr")) << albedo.geterror();
        for (const float light : all_pixels(folder.made("bounced.lightmap")))
            ASSERT_TRUE(std::isfinite(light) && light >= 0) << value;
    }
}

// Each step that there is, one after the other: none may go on without asking.
TEST(BounceStage, WorkCanBeStoppedAtEveryStep)
{
    const BounceFolder folder;
    folder.add_sun();
    folder.write("ground.vismap", "mesh = \"spot.obj\"\nresolution = [40, 30]\nsamples = 4\nground = true\n");
    for (const char* name : { "bounced.lightmap", "sunny.lightmap" }) {
        LightmapRecipe recipe;
        std::string error;
        ASSERT_TRUE(read_recipe(recipe, folder / name, error)) << error;
        std::vector<std::string> steps, stopped;
        const auto lit = [&](size_t stop, OIIO::ImageBuf& image) {
            steps.clear();
            MakeOptions options;
            options.chain = { folder / name };
            options.threads = 1;
            options.progress = [&, stop](const std::string& step, int64_t texels) {
                const bool stops = texels > 0 && steps.size() == stop;
                if (texels > 0) // the others are names of steps alone
                    steps.push_back(step);
                return Progress([stops](double) { return !stops; });
            };
            return make_image(image, recipe, options);
        };
        for (OIIO::ImageBuf image; !lit(stopped.size(), image); image.clear()) {
            EXPECT_NE(image.geterror().find("interrupted"), std::string::npos) << steps.back() << image.geterror();
            ASSERT_EQ(steps.size(), stopped.size() + 1) << "goes on after " << steps.back();
            stopped.push_back(steps.back());
        }
        EXPECT_GE(std::count(stopped.begin(), stopped.end(), "bounce"), 3) << name; // traced, lit, summed up
        EXPECT_EQ(std::count(stopped.begin(), stopped.end(), "bounce points"), name[0] == 's' ? 2 : 1);
    }
}

// Names are those of vmcost. A header that is read before the light takes it that there is a sun.
TEST(BounceStage, TheModelIsNamedWithItsSuns)
{
    const BounceFolder folder;
    folder.add_sun();
    const auto model = [](const OIIO::ImageSpec& spec) { return spec.get_string_attribute("vmlight:model"); };
    const std::string name = model(folder.made("sunny.lightmap").spec());
    EXPECT_EQ(name, "lobe+suns");
    EXPECT_NE(cost::find_variant(name), nullptr);
    EXPECT_EQ(model(OIIO::ImageInput::open(folder / "sunny.lightmap")->spec()), "lobe+suns");
    for (const char* plain : { "bounced.lightmap", "plain.lightmap" }) {
        const std::string made = model(folder.made(plain).spec());
        EXPECT_EQ(made.find('+'), std::string::npos) << made;
        EXPECT_EQ(model(OIIO::ImageInput::open(folder / plain)->spec()), made);
    }
    // Without a sun to be found.
    folder.write("cloudy.lightmap",
                 "vismap = \"ground.vismap\"\nenvironment = \"studio.exr\"\nsuns = \"on\"\nmodel = \"paper\"\n");
    EXPECT_EQ(model(folder.made("cloudy.lightmap").spec()), "paper");
}
