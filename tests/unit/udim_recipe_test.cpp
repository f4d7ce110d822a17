// SPDX-License-Identifier: Apache-2.0
#include "temporary_folder.h"

#include <vmlight/stage/recipe/udim.h>

#include <gtest/gtest.h>

using namespace vmlight;

namespace {

template <class Recipe> Recipe recipe_of(const std::string& name)
{
    Recipe recipe;
    std::string error;
    EXPECT_TRUE(read_recipe(recipe, name, error)) << error;
    return recipe;
}

} // namespace

TEST(UdimRecipe, APatternStandsForTheTileInEveryPath)
{
    LightmapRecipe lightmap;
    std::string error;
    const std::string text
        = "vismap = \"vm.<UDIM>.exr\"\ncfem = \"s.cfem\"\nalbedo = \"/<UDIM>/a.vismap?udim=<UDIM>\"\n"
          "udim = 1012\n";
    ASSERT_TRUE(read_recipe_text(lightmap, text, "dir/hero.lightmap", error)) << error;
    EXPECT_EQ(lightmap.vismap, "dir/vm.<UDIM>.exr") << "resolved too early: a recipe would not print as it was";
    const LightmapRecipe tile = resolve_udim(lightmap);
    EXPECT_EQ(tile.vismap, "dir/vm.1012.exr");
    EXPECT_EQ(tile.cfem, "dir/s.cfem");
    EXPECT_EQ(tile.albedo, "/1012/a.vismap?udim=1012");

    VismapRecipe vismap;
    vismap.mesh = "a.<UDIM>.obj";
    vismap.occluder = { "b.obj", "c.<UDIM>.obj" };
    EXPECT_EQ(resolve_udim(vismap).mesh, "a.1001.obj");
    vismap.vismap_params.udim = 9999;
    EXPECT_EQ(resolve_udim(vismap).occluder, (std::vector<std::string> { "b.obj", "c.9999.obj" }));
}

TEST(UdimRecipe, APrintedRecipeKeepsThePatternAndATileThatWasGiven)
{
    for (const std::string text : { "vismap = \"/vm.<UDIM>.exr\"\n", "vismap = \"/vm.<UDIM>.exr\"\nudim = 1001\n",
                                    "vismap = \"/vm.<UDIM>.exr\"\nudim = 1033\n" }) {
        LightmapRecipe recipe;
        std::string error;
        ASSERT_TRUE(read_recipe_text(recipe, text, "x.lightmap", error)) << error;
        EXPECT_EQ(recipe_text(recipe), text);
        EXPECT_EQ(recipe.udim_given, text.find("udim =") != std::string::npos);
    }
}

TEST(UdimRecipe, AFilesOwnNameSaysTheTileUnlessTheRecipeDoes)
{
    const TemporaryFolder folder;
    folder.write("hero.vismap", "mesh = \"a.obj\"\n");
    folder.write("hero.1013.vismap", "mesh = \"a.obj\"\n");
    folder.write("said.1013.vismap", "mesh = \"a.obj\"\nudim = 1002\n");
    std::filesystem::create_symlink("hero.vismap", folder / "link.1014.vismap");
    std::filesystem::create_symlink("hero.1013.vismap", folder / "plain.vismap");
    const auto udim = [&](const std::string& name) {
        VismapRecipe recipe = recipe_of<VismapRecipe>(folder / name);
        EXPECT_EQ(recipe.udim_given, udim_of(recipe) != 1001) << name;
        return udim_of(recipe);
    };
    EXPECT_EQ(udim("hero.vismap"), 1001);
    EXPECT_EQ(udim("hero.1013.vismap"), 1013);
    EXPECT_EQ(udim("said.1013.vismap"), 1002);
    EXPECT_EQ(udim("said.1013.vismap?udim=1003"), 1003);
    EXPECT_EQ(udim("link.1014.vismap"), 1014);
    EXPECT_EQ(udim("plain.vismap"), 1001);
    folder.write("none.1015.vismap", "# none\n");
    EXPECT_EQ(udim("none.1015.vismap?mesh=a.obj"), 1015);
    EXPECT_TRUE(recipe_of<VismapRecipe>(folder / "hero.vismap?udim=1001").udim_given);
    folder.write("hero.1016.cfem", "environment = \"a.exr\"\n");
    folder.write("hero.1017.lightmap", "vismap = \"a.exr\"\n");
    EXPECT_EQ(recipe_of<CfemRecipe>(folder / "hero.1016.cfem").udim, 1016);
    EXPECT_EQ(recipe_of<LightmapRecipe>(folder / "hero.1017.lightmap").udim, 1017);
}

TEST(UdimRecipe, WhatIsNoTileIsRefused)
{
    VismapRecipe recipe;
    std::string error;
    EXPECT_FALSE(read_recipe_text(recipe, "udim = 1000", "hero.vismap", error));
    EXPECT_EQ(error, "\"hero.vismap\" line 1: udim: 1000 is not in [1001, 9999]");
    EXPECT_FALSE(read_recipe_text(recipe, "udim = \"1002\"", "hero.vismap", error));
    EXPECT_EQ(error, "\"hero.vismap\" line 1: udim: a string where an integer is needed");
    const TemporaryFolder folder;
    const std::string path = folder.write("hero.vismap", "# none\n");
    EXPECT_FALSE(read_recipe(recipe, path + "?udim=<UDIM>", error));
    EXPECT_EQ(error, "\"" + path + "?udim=<UDIM>\": udim: \"<UDIM>\" is not a whole number");
}
