// SPDX-License-Identifier: Apache-2.0
// Bounced light through recipes: what a host reads tile by tile is what the executables make.
#include "stage_scene.h"

#include <vmcost/models.h>
#include <vmlight/stage/make_stage.h>

#include <algorithm>
#include <thread>

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
        write("ground.vismap", "mesh = \"spot.obj\"\nresolution = [100, 75]\nsamples = 16\nground = true\n");
        write("plain.lightmap", "vismap = \"ground.vismap\"\ncfem = \"studio.cfem\"\nalbedo = \"paint.exr\"\n");
        write("bounced.lightmap",
              "vismap = \"ground.vismap\"\ncfem = \"studio.cfem\"\nalbedo = \"paint.exr\"\nbounce = \"auto\"\n"
              "ground_albedo = 0.4\nrotate = [0, 30, 0]\nexposure = 0.7\n");
    }
    // And a recipe that is lit by it.
    void add_sun() const
    {
        OIIO::ImageBuf sky(OIIO::ImageSpec(128, 64, 3, OIIO::TypeFloat));
        for (OIIO::ImageBuf::Iterator<float> p(sky); !p.done(); ++p) {
            const float light = p.x() == 40 && p.y() == 14 ? 5e4f : 1.0f;
            p[0] = light, p[1] = light, p[2] = light;
        }
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

} // namespace

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
