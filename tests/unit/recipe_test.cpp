// SPDX-License-Identifier: Apache-2.0
// What a recipe says. Refusals: recipe_refusal_test.cpp; texts of recipes: recipe_text_test.cpp.
#include "recipe_reading.h"
#include "temporary_folder.h"

#include <algorithm>

using namespace vmlight;

TEST(Recipe, SaysWhatAStageReadsAndHow)
{
    const auto light
        = parsed("# comment\nvismap = \"hero.vismap\"\nenvironment = 'studio.exr'\nrotate = [0, 90.5, -1e1]\n"
                 "exposure = 1\ncfem_filter = \"sh\"\ncfem_resolution = [64, 16]\ncfem_sanitize = true\n");
    EXPECT_EQ(light.vismap, "hero.vismap");
    EXPECT_EQ(light.environment, "studio.exr");
    EXPECT_EQ(light.lightmap_params.rotate, (std::vector<double> { 0, 90.5, -10 }));
    EXPECT_EQ(light.lightmap_params.exposure, 1);
    EXPECT_EQ(light.cfem_params.filter, "sh");
    EXPECT_EQ(light.cfem_params.resolution.height, 16);
    EXPECT_TRUE(light.cfem_params.sanitize);

    const auto bake = parsed<VismapRecipe>("mesh = \"hero.obj\"\r\noccluder = [\"a, b.obj\", \"c.obj\"]\r\n"
                                           "max_distance = \"infinite\"\r\nmargin = \"infinite\"\r\nup = \"z\"\r\n");
    EXPECT_EQ(bake.occluder, (std::vector<std::string> { "a, b.obj", "c.obj" }));
    EXPECT_EQ(bake.vismap_params.margin, -1);
    EXPECT_EQ(bake.mesh_params.up, "z");
    EXPECT_EQ(parsed<VismapRecipe>("occluder = \"a.obj\"").occluder, std::vector<std::string> { "a.obj" });
}

TEST(Recipe, TakesASizeInEachOfItsForms)
{
    for (const char* text :
         { "resolution = 64", "resolution = \"64\"", "resolution = \"64x32\"", "resolution = [64, 32]" }) {
        const CfemRecipe recipe = parsed<CfemRecipe>(text);
        EXPECT_EQ(recipe.cfem_params.resolution.width, 64) << text;
        EXPECT_EQ(recipe.cfem_params.resolution.height, 32) << text;
    }
    EXPECT_EQ(parsed("rotate = \"0,90,0\"").lightmap_params.rotate, (std::vector<double> { 0, 90, 0 }));
    EXPECT_TRUE(parsed("rotate = []").lightmap_params.rotate.empty());
}

TEST(Recipe, TakesWordsAsAListOrAText)
{
    const std::vector<std::string> both { "normal", "coverage" };
    for (const char* text : { "channels = [\"coverage\", \"normal\"]", "channels = \"normal, coverage\"" })
        EXPECT_EQ(parsed<VismapRecipe>(text).vismap_params.channels, both) << text;
    EXPECT_TRUE(parsed<VismapRecipe>("channels = []").vismap_params.channels.empty());
    const std::string at = "\"hero.lightmap\" line 1: channels: ";
    EXPECT_EQ(refusal<VismapRecipe>("channels = true"), at + "a boolean where an array of words in quotes is needed");
    EXPECT_EQ(refusal<VismapRecipe>("channels = [1]"), at + "an integer where a word in quotes is needed");
    EXPECT_EQ(refusal<VismapRecipe>("channels = [\"\"]"), at + "one of its words is empty");
    EXPECT_EQ(refusal<VismapRecipe>("channels = [\"normal,coverage\"]"),
              at + "a word in a list cannot contain a comma");
    EXPECT_EQ(refusal<VismapRecipe>("channels = [\"normal\", \"normal\"]"), at + "\"normal\" is given twice");
}

TEST(Recipe, TextsAreAnyUnicode)
{
    const LightmapRecipe recipe = parsed("\xEF\xBB\xBF# caf\xC3\xA9 \"\"\"\n"
                                         "vismap = \"caf\xC3\xA9 '''\\\"\\\\\" # '''\n"
                                         "'cfem' = '\"\"\"\\\xF0\x9F\x90\x84'\n"
                                         "\"albedo\" = \"\\u00e9\\U0001F404\\\\u00e9\xEF\xBF\xBF\xED\x9F\xBF\"\n"
                                         "colorspace = 'u00e9\\'");
    EXPECT_EQ(recipe.vismap, "caf\xC3\xA9 '''\"\\");
    EXPECT_EQ(recipe.cfem, "\"\"\"\\\xF0\x9F\x90\x84");
    EXPECT_EQ(recipe.albedo, "\xC3\xA9\xF0\x9F\x90\x84\\u00e9\xEF\xBF\xBF\xED\x9F\xBF");
    EXPECT_EQ(recipe.colorspace, "u00e9\\");
}

TEST(Recipe, AQueryOverridesTheFile)
{
    const TemporaryFolder folder;
    const std::string path = folder.write("hero.lightmap", "vismap = \"a.exr\"\nrotate = [0, 90, 0]\nexposure = 2\n");
    LightmapRecipe recipe;
    std::string error;
    ASSERT_TRUE(read_recipe(recipe, path + "?rotate=0,45,0&cfem=b.cfem?order=2&colorspace=a%20b", error)) << error;
    EXPECT_EQ(recipe.lightmap_params.rotate, (std::vector<double> { 0, 45, 0 }));
    EXPECT_EQ(recipe.lightmap_params.exposure, 2);
    EXPECT_EQ(recipe.cfem, "b.cfem?order=2"); // the first '?' behind an extension parts
    EXPECT_EQ(recipe.colorspace, "a%20b");
    EXPECT_EQ(name_refusal(path + "?rotate=abc"),
              "\"" + path + "?rotate=abc\": rotate: \"abc\" in \"abc\" is not a number");
    EXPECT_EQ(name_refusal(path + "?rotat=1"),
              "\"" + path + "?rotat=1\": unknown parameter \"rotat\"; did you mean \"rotate\"?");
    EXPECT_EQ(name_refusal(path + "?exposure"), "\"" + path + "?exposure\": \"exposure\" is not KEY=VALUE");
    EXPECT_EQ(name_refusal(path + "?exposure=1&&"), "\"" + path + "?exposure=1&&\": \"\" is not KEY=VALUE");
    EXPECT_EQ(name_refusal(path + "?exposure=1&exposure=1"),
              "\"" + path + "?exposure=1&exposure=1\": exposure: set twice");
    // The file is refused though the query would correct it.
    folder.write("hero.lightmap", "exposure = 99");
    EXPECT_EQ(name_refusal(path + "?exposure=1"), "\"" + path + "\" line 1: exposure: 99 is not in [-64, 64]");
}

TEST(Recipe, AQueryMaySayEverything)
{
    const TemporaryFolder folder;
    LightmapRecipe light;
    std::string error;
    const std::string none = folder.write("x.lightmap", "# none\n");
    ASSERT_TRUE(read_recipe(light, none + "?vismap=a.exr&cfem=b.exr", error)) << error;
    EXPECT_EQ(light.vismap, "a.exr");
    EXPECT_EQ(light.cfem, "b.exr");
    VismapRecipe bake;
    const std::string bare = folder.write("x.vismap", "# none\n");
    ASSERT_TRUE(read_recipe(bake, bare + "?occluder=a, b.obj&mesh=m.obj&occluder=c.obj", error)) << error;
    EXPECT_EQ(bake.mesh, "m.obj");
    EXPECT_EQ(bake.occluder, (std::vector<std::string> { "a, b.obj", "c.obj" }));
    ASSERT_TRUE(read_recipe(bake, bare + "?occluder=", error)) << error;
    EXPECT_TRUE(bake.occluder.empty());
}

TEST(Recipe, PathsOfAFileStartAtItsFolderThoseOfAQueryWhereTheUserStands)
{
    const TemporaryFolder folder;
    const std::string path
        = folder.write("hero.vismap", "mesh = \"../hero.obj\"\noccluder = [\"a.obj\", \"/b.obj\", \"c.obj\"]");
    VismapRecipe bake;
    std::string error;
    ASSERT_TRUE(read_recipe(bake, path, error)) << error;
    EXPECT_EQ(bake.mesh, folder / "../hero.obj");
    EXPECT_EQ(bake.occluder, (std::vector<std::string> { folder / "a.obj", "/b.obj", folder / "c.obj" }));
    ASSERT_TRUE(read_recipe(bake, path + "?mesh=x.obj", error)) << error;
    EXPECT_EQ(bake.mesh, "x.obj");
    EXPECT_EQ(bake.occluder[0], folder / "a.obj");

    EXPECT_EQ(parsed("vismap = \"a.exr\"", "hero.lightmap").vismap, "a.exr");
    EXPECT_EQ(parsed("vismap = \"a.exr\"", "/hero.lightmap").vismap, "/a.exr");
    EXPECT_EQ(parsed("vismap = \"a.exr\"", "sub/hero.lightmap").vismap, "sub/a.exr");
    EXPECT_EQ(parsed("vismap = \"a.vismap?samples=4\"", "sub/hero.lightmap").vismap, "sub/a.vismap?samples=4");
    const LightmapRecipe light = parsed("vismap = \"\"\ncolorspace = \"a\"\ncolorconfig = \"c\"", "sub/hero.lightmap");
    EXPECT_EQ(light.vismap, "");
    EXPECT_EQ(light.colorspace, "a"); // no path
    EXPECT_EQ(light.colorconfig, "sub/c");
    // Built into OpenColorIO: no file.
    EXPECT_EQ(parsed("colorconfig = \"ocio://default\"", "sub/hero.lightmap").colorconfig, "ocio://default");
}

TEST(Recipe, ItsNameSaysItsStage)
{
    EXPECT_EQ(recipe_stage("a.exr/hero.vismap"), "vismap");
    EXPECT_EQ(recipe_stage("hero.CFEM?environment=a.exr"), "cfem");
    EXPECT_EQ(recipe_stage("hero.lightmap?vismap=a.exr"), "lightmap");
    for (const char* name : { "", "vismap", "hero.exr", "hero.exr?a=b.vismap", "hero.vismap.exr", "hero.vismaps" })
        EXPECT_FALSE(is_recipe_name(name)) << name;
    EXPECT_TRUE(is_recipe_name("hero.cfem"));
    EXPECT_EQ(recipe_path("hero.cfem?a=b?c"), "hero.cfem");
    EXPECT_EQ(recipe_path("hero.cfem?environment=a.cfem?b=c"), "hero.cfem");
    EXPECT_EQ(recipe_path("what?/hero.cfem"), "what?/hero.cfem");
    EXPECT_EQ(recipe_path("what?/he?ro.cfem?a=b"), "what?/he?ro.cfem");
    EXPECT_EQ(recipe_stage("what?/hero.cfem?a=b.lightmap"), "cfem");
    // Where names alone leave it open, the file that exists decides.
    const TemporaryFolder folder;
    const std::string odd = folder.write("a.cfem?b=c.lightmap", "x = 1\n"), inner = folder / "a.vismap?samples=2";
    EXPECT_EQ(recipe_path(odd), odd);
    EXPECT_EQ(recipe_stage(odd + "?d=e"), "lightmap");
    std::filesystem::create_directory(inner);
    EXPECT_EQ(recipe_path(inner + "/a.cfem?d=e"), folder / "a.vismap");
    folder.write("a.vismap?samples=2/a.cfem", "x = 1\n");
    EXPECT_EQ(recipe_path(inner + "/a.cfem?d=e"), inner + "/a.cfem");
}

TEST(Recipe, APlaceIsALineOrTheQuery)
{
    const TemporaryFolder folder;
    const std::string path = folder.write("hero.lightmap", "vismap = \"a.exr\"\n\ncfem = \"b.exr\"\n");
    EXPECT_EQ(recipe_place(path, "cfem"), "\"" + path + "\" line 3: cfem");
    EXPECT_EQ(recipe_place(path + "?exposure=1", "cfem"), "\"" + path + "\" line 3: cfem");
    EXPECT_EQ(recipe_place(path + "?cfem=c.exr", "cfem"), "\"" + path + "?cfem=c.exr\": cfem");
    EXPECT_EQ(recipe_place(path, "albedo"), "\"" + path + "\": albedo");
    EXPECT_EQ(recipe_place("gone.lightmap", "albedo"), "\"gone.lightmap\": albedo");
}

// visit() makes up these names as it goes.
TEST(Recipe, PrefixedNamesAreParametersLikeAnyOther)
{
    LightmapRecipe recipe;
    std::string error;
    const std::vector<std::string> names = param_names(recipe);
    EXPECT_NE(std::find(names.begin(), names.end(), "cfem_resolution"), names.end());
    EXPECT_TRUE(set_param(recipe, "cfem_resolution", "32", error)) << error;
    EXPECT_EQ(recipe.cfem_params.resolution.height, 16);
    EXPECT_FALSE(set_param(recipe, "cfem_order", "99", error));
    EXPECT_EQ(error, "cfem_order: 99 is not in [1, 64]");
    recipe.cfem_params.order = 99;
    EXPECT_FALSE(check_params(recipe, error));
    EXPECT_EQ(error, "cfem_order: 99 is not in [1, 64]");
    OIIO::ImageSpec spec;
    append_params(spec, recipe);
    EXPECT_EQ(spec.get_string_attribute("vmlight:cfem_resolution"), "32x16");
}
