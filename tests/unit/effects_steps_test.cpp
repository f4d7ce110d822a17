// SPDX-License-Identifier: Apache-2.0
// Progress names what runs: each step of the work, in its order, and none that the scene does not call for.
#include "stage_scene.h"

#include <vmlight/stage/make_stage.h>

#include <gmock/gmock.h>

using namespace vmlight;
using namespace vmlight::stage_scene;
using testing::ElementsAre;

namespace {

class EffectsSteps : public testing::Test
{
protected:
    // Names of steps, each once.
    template <class Recipe> std::vector<std::string> steps(const Recipe& recipe)
    {
        std::vector<std::string> names;
        MakeOptions options;
        options.progress = [&](const std::string& step, int64_t) {
            return [&names, step](double) {
                if (names.empty() || names.back() != step)
                    names.push_back(step);
                return true;
            };
        };
        OIIO::ImageBuf image;
        EXPECT_TRUE(make_image(image, recipe, options)) << image.geterror();
        return names;
    }
    VismapRecipe bake(const std::string& name)
    {
        VismapRecipe recipe;
        recipe.mesh = folder / name;
        recipe.vismap_params.resolution = { 16, 16 };
        recipe.vismap_params.samples = 4;
        return recipe;
    }
    Folder folder;
};

} // namespace

TEST_F(EffectsSteps, ABakeNamesThem)
{
    VismapRecipe recipe = bake("spot.obj");
    recipe.vismap_params.margin = 0;
    EXPECT_THAT(steps(recipe), ElementsAre("read", "build", "prove", "bake"));
    folder.write("wall.mtl", "newmtl Glass\nd 0.5\n");
    folder.write("wall.obj", "mtllib wall.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl Glass\nf 1 2 3\n");
    recipe.occluder = { folder / "wall.obj" };
    recipe.vismap_params.margin = 2;
    recipe.vismap_params.target_error = 0.5;
    EXPECT_THAT(steps(recipe),
                ElementsAre("read", "read cut-outs", "find what occluders reach", "sort cut-outs", "build", "prove",
                            "bake", "margin"));
}

TEST_F(EffectsSteps, ALightmapNamesThem)
{
    LightmapRecipe recipe;
    recipe.vismap = folder / "hero.vismap";
    recipe.environment = folder / "studio.exr";
    EXPECT_THAT(steps(recipe), ElementsAre("read", "build", "prove", "bake", "margin", "filter", "light"));
}
