// SPDX-License-Identifier: Apache-2.0
#include "temporary_folder.h"

#include <vmlight/recipe.h>

#include <gtest/gtest.h>

#include <functional>
#include <random>

using namespace vmlight;

namespace {

template <class Recipe> std::vector<std::string> values(Recipe recipe)
{
    std::vector<std::string> texts;
    recipe.visit([&](const char* name, auto& value, const auto& allowed, const char*) {
        texts.push_back(std::string(name) + "=" + value_text(value, allowed));
    });
    return texts;
}

template <class Recipe = LightmapRecipe>
Recipe parsed(const std::string& text, const std::string& path = "hero.lightmap")
{
    Recipe recipe;
    std::string error;
    EXPECT_TRUE(read_recipe_text(recipe, text, path, error)) << error;
    return recipe;
}

// The recipe must be as it was.
template <class Recipe = LightmapRecipe> std::string refusal(const std::string& text)
{
    Recipe recipe;
    std::string error;
    EXPECT_FALSE(read_recipe_text(recipe, text, "hero.lightmap", error)) << text;
    EXPECT_EQ(values(recipe), values(Recipe {})) << text;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    return error;
}

template <class Recipe = LightmapRecipe> std::string name_refusal(const std::string& name)
{
    Recipe recipe;
    std::string error;
    EXPECT_FALSE(read_recipe(recipe, name, error)) << name;
    EXPECT_EQ(values(recipe), values(Recipe {})) << name;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    return error;
}

} // namespace

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
    EXPECT_EQ(refusal<VismapRecipe>("channels = [\"normal,coverage\"]"), at + "a word in a list cannot hold a comma");
    EXPECT_EQ(refusal<VismapRecipe>("channels = [\"normal\", \"normal\"]"), at + "\"normal\" comes twice");
}

TEST(Recipe, RefusesAnUnknownKeyWithLineAndNearest)
{
    EXPECT_EQ(refusal("vismap = \"a\"\n\nrotat = [0, 90, 0]"),
              "\"hero.lightmap\" line 3: unknown parameter \"rotat\"; did you mean \"rotate\"?");
    EXPECT_EQ(refusal("samples = 3"), "\"hero.lightmap\" line 1: unknown parameter \"samples\"");
    EXPECT_EQ(refusal("cfem_filtr = 3"),
              "\"hero.lightmap\" line 1: unknown parameter \"cfem_filtr\"; did you mean \"cfem_filter\"?");
    EXPECT_EQ(refusal("\"a\\nb\" = 3"), "\"hero.lightmap\" line 1: unknown parameter \"a\\x0ab\"");
    // The first fault of the file, not of the alphabet.
    EXPECT_EQ(refusal("zebra = 1\nants = 1"), "\"hero.lightmap\" line 1: unknown parameter \"zebra\"");
}

TEST(Recipe, RefusesAWrongType)
{
    EXPECT_EQ(refusal("\nexposure = \"1\""), "\"hero.lightmap\" line 2: exposure: a string where a number is needed");
    EXPECT_EQ(refusal("exposure = [1]"), "\"hero.lightmap\" line 1: exposure: an array where a number is needed");
    EXPECT_EQ(refusal("exposure = 2024-01-01"),
              "\"hero.lightmap\" line 1: exposure: a date or time where a number is needed");
    EXPECT_EQ(refusal("cfem_order = 3.0"), "\"hero.lightmap\" line 1: cfem_order: a float where an integer is needed");
    EXPECT_EQ(refusal("cfem_filter = 3"), "\"hero.lightmap\" line 1: cfem_filter: an integer where a string is needed");
    EXPECT_EQ(refusal("cfem_sanitize = 1"),
              "\"hero.lightmap\" line 1: cfem_sanitize: an integer where true or false is needed");
    EXPECT_EQ(refusal("colorspace = true"), "\"hero.lightmap\" line 1: colorspace: a boolean where a string is needed");
    EXPECT_EQ(refusal("vismap = [\"a\"]"),
              "\"hero.lightmap\" line 1: vismap: an array where a path in quotes is needed");
    EXPECT_EQ(refusal("rotate = 90"),
              "\"hero.lightmap\" line 1: rotate: an integer where an array of 3 numbers is needed");
    EXPECT_EQ(refusal("rotate = [0, \"90\", 0]"),
              "\"hero.lightmap\" line 1: rotate: a string where a number is needed");
    EXPECT_EQ(refusal("rotate = [[0, 90, 0]]"), "\"hero.lightmap\" line 1: rotate: an array where a number is needed");
    const std::string size = " where a width, [width, height] or \"WIDTHxHEIGHT\" is needed";
    EXPECT_EQ(refusal("cfem_resolution = 1.5"), "\"hero.lightmap\" line 1: cfem_resolution: a float" + size);
    EXPECT_EQ(refusal("cfem_resolution = [1, 2, 3]"), "\"hero.lightmap\" line 1: cfem_resolution: an array" + size);
    EXPECT_EQ(refusal("[cfem]\nfilter = \"sh\""),
              "\"hero.lightmap\" line 1: cfem: a table where a path in quotes is needed");
    EXPECT_EQ(refusal("cfem.filter = \"sh\""),
              "\"hero.lightmap\" line 1: cfem: a table where a path in quotes is needed");
    EXPECT_EQ(refusal("[[light]]"), "\"hero.lightmap\" line 1: unknown parameter \"light\"");
    EXPECT_EQ(refusal<VismapRecipe>("max_distance = true"),
              "\"hero.lightmap\" line 1: max_distance: a boolean where a number or \"infinite\" is needed");
    EXPECT_EQ(refusal<VismapRecipe>("max_distance = \"far\""),
              "\"hero.lightmap\" line 1: max_distance: \"far\" is neither a number nor \"infinite\"");
    EXPECT_EQ(refusal<VismapRecipe>("occluder = [\"a\", 1]"),
              "\"hero.lightmap\" line 1: occluder: an integer where a path in quotes is needed");
    EXPECT_EQ(refusal<VismapRecipe>("occluder = 1"),
              "\"hero.lightmap\" line 1: occluder: an integer where an array of paths in quotes is needed");
    EXPECT_EQ(refusal<VismapRecipe>("occluder = [\"\"]"),
              "\"hero.lightmap\" line 1: occluder: one of its names is empty");
    EXPECT_EQ(refusal<VismapRecipe>("occluder = [\"a\\nb\"]"),
              "\"hero.lightmap\" line 1: occluder: a name in a list cannot hold a line break");
}

TEST(Recipe, RefusesAValueOutOfRange)
{
    EXPECT_EQ(refusal("exposure = 65"), "\"hero.lightmap\" line 1: exposure: 65 is not in [-64, 64]");
    EXPECT_EQ(refusal("exposure = 64.5"), "\"hero.lightmap\" line 1: exposure: 64.5 is not in [-64, 64]");
    EXPECT_EQ(refusal("exposure = nan"), "\"hero.lightmap\" line 1: exposure: \"nan\" is not a number");
    EXPECT_EQ(refusal("exposure = -inf"), "\"hero.lightmap\" line 1: exposure: \"-inf\" is not a number");
    EXPECT_EQ(refusal("cfem_order = 9223372036854775807"),
              "\"hero.lightmap\" line 1: cfem_order: 9223372036854775807 is not in [1, 64]");
    EXPECT_EQ(refusal("rotate = [0, 90]"), "\"hero.lightmap\" line 1: rotate: \"0,90\" has 2 numbers, 3 are needed");
    EXPECT_EQ(refusal("cfem_filter = \"Exact\""),
              "\"hero.lightmap\" line 1: cfem_filter: \"Exact\" is not one of exact, sh");
    EXPECT_EQ(refusal("cfem_filter = \"a\\nb\""),
              "\"hero.lightmap\" line 1: cfem_filter: \"a\\x0ab\" is not one of exact, sh");
    EXPECT_EQ(refusal("cfem_resolution = [0, 32]"),
              "\"hero.lightmap\" line 1: cfem_resolution: \"0x32\" is not "
              "WIDTHxHEIGHT from 1x1 to 16384x16384");
    EXPECT_EQ(refusal("vismap = \"a\\u0000b\""), "\"hero.lightmap\" line 1: vismap: a name cannot hold a zero byte");
}

// What follows "not TOML" are toml++'s words, which change with its version.
TEST(Recipe, RefusesWhatIsNotToml)
{
    const std::string twice = refusal("rotate = [0, 90, 0]\nexposure = 1\nrotate = [0, 0, 0]");
    EXPECT_EQ(twice.rfind("\"hero.lightmap\" line 3: not TOML: ", 0), 0u) << twice;
    EXPECT_NE(twice.find("cannot redefine existing array 'rotate'"), std::string::npos) << twice;
    EXPECT_NE(refusal("vismap = hero.exr").find("; texts need quotes"), std::string::npos);
    for (const char* text : { "vismap = hero.exr", "vismap: a", "a\nb", "rotate = [0, 90", "\x89PNG\r\n\x1a\n",
                              "vismap = \"\xff\xfe\"", "vismap = \"a", "vismap = [[[[[[[[[[[[[[]]]]]]]]]]]]]]", "= 1",
                              "vismap = ", "vismap = 1 2", "vismap = \"a\" cfem = \"b\"", "[a", "\x01" })
        EXPECT_EQ(refusal(text).rfind("\"hero.lightmap\" line 1: not TOML: ", 0), 0u) << refusal(text);
    EXPECT_EQ(refusal(std::string("\n\0", 2)), "\"hero.lightmap\" line 2: not TOML: a control character (0)");
    EXPECT_EQ(refusal("# \x0b"), "\"hero.lightmap\" line 1: not TOML: a control character (11)");
    EXPECT_EQ(refusal("exposure = 1\rrotate = []\n"), "\"hero.lightmap\" line 1: not TOML: a control character (13)");
    for (const char* text : { "\x80", "\xc3", "\xc1\xbf", "\xe0\x80\x80", "\xed\xa0\x80", "\xf5\x80\x80\x80",
                              "\xf4\x90\x80\x80", "\xf0\x80\x80\x80", "\xc3x", "\xff" })
        EXPECT_EQ(refusal(std::string("\nvismap = '") + text + "'"),
                  "\"hero.lightmap\" line 2: not TOML: its bytes are not UTF-8");
}

// The fuzzer found that toml++ 3.3 answers the first two with undefined behaviour; the others are their kin.
TEST(Recipe, RefusesWhatItsParserCannotTake)
{
    const std::string outside = ": not TOML: a character outside quotes that is not ASCII";
    EXPECT_EQ(refusal("\nen\xEF\xBB\x82"), "\"hero.lightmap\" line 2" + outside);
    EXPECT_EQ(refusal("vismap =0\"caf\xC3\xA9\"").rfind("\"hero.lightmap\" line 1: not TOML: ", 0), 0u);
    EXPECT_EQ(refusal("vismap = \"a\\\\\"\xC3\xA9\""), "\"hero.lightmap\" line 1" + outside);
    for (const char* text : { "[=", "rotate = [ }", "rotate = [ 0, }" }) // asserted against, or assumed never to come
        EXPECT_EQ(refusal(text).rfind("\"hero.lightmap\" line 1: not TOML: ", 0), 0u) << text;
    for (const char* text : { "vismap = \"\"\"a\"\"\"", "vismap = '''a'''" })
        EXPECT_EQ(refusal(text), "\"hero.lightmap\" line 1: three quotes in a row: a recipe's texts are of one line");
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

TEST(Recipe, AMessageIsOfReadableLength)
{
    const std::string error = refusal("a" + std::string(100000, 'b') + " = 1");
    EXPECT_LT(error.size(), 600u);
    EXPECT_EQ(error.substr(error.size() - 3), "...");
}

// Each part of a dotted key is a table in a table, and the parser takes them down by recursion.
TEST(Recipe, RefusesAKeyOfADeepNest)
{
    std::string key = "a";
    for (int i = 0; i < 400000; ++i)
        key += ".a";
    EXPECT_EQ(refusal(key + " = 1"), "\"hero.lightmap\" line 1: more than 100 dots outside quotes");
    EXPECT_EQ(refusal("\n[" + key + "]"), "\"hero.lightmap\" line 2: more than 100 dots outside quotes");
}

TEST(Recipe, RefusesWhatIsNoReadableFile)
{
    const TemporaryFolder folder;
    EXPECT_EQ(name_refusal("gone.lightmap"), "\"gone.lightmap\": no such file");
    EXPECT_EQ(name_refusal("gone.lightmap?"), "\"gone.lightmap\": no such file");
    const std::string path = folder / ".";
    EXPECT_EQ(name_refusal(path), "\"" + path + "\": not a file");
    const std::string empty = folder.write("empty.lightmap", "");
    EXPECT_EQ(name_refusal(empty), "\"" + empty + "\": an empty file");
    const std::string huge = folder.write("huge.lightmap", std::string((1 << 20) + 1, '\n'));
    EXPECT_EQ(name_refusal(huge), "\"" + huge + "\": 1048577 bytes are too many for a recipe; 1048576 are allowed");
    const std::string largest = folder.write("largest.lightmap", std::string(1 << 20, '\n'));
    LightmapRecipe recipe;
    std::string error;
    EXPECT_TRUE(read_recipe(recipe, largest, error)) << error;
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
    EXPECT_EQ(recipe.cfem, "b.cfem?order=2"); // the first '?' parts, as in OIIO
    EXPECT_EQ(recipe.colorspace, "a%20b");
    EXPECT_EQ(name_refusal(path + "?rotate=abc"),
              "\"" + path + "?rotate=abc\": rotate: \"abc\" in \"abc\" is not a number");
    EXPECT_EQ(name_refusal(path + "?rotat=1"),
              "\"" + path + "?rotat=1\": unknown parameter \"rotat\"; did you mean \"rotate\"?");
    EXPECT_EQ(name_refusal(path + "?exposure"), "\"" + path + "?exposure\": \"exposure\" is not KEY=VALUE");
    EXPECT_EQ(name_refusal(path + "?exposure=1&&"), "\"" + path + "?exposure=1&&\": \"\" is not KEY=VALUE");
    EXPECT_EQ(name_refusal(path + "?exposure=1&exposure=1"),
              "\"" + path + "?exposure=1&exposure=1\": exposure: given twice");
    // The file is refused though the query would mend it.
    folder.write("hero.lightmap", "exposure = 99");
    EXPECT_EQ(name_refusal(path + "?exposure=1"), "\"" + path + "\" line 1: exposure: 99 is not in [-64, 64]");
}

TEST(Recipe, AQueryMaySayEverything)
{
    LightmapRecipe light;
    std::string error;
    ASSERT_TRUE(read_recipe(light, "x.lightmap?vismap=a.exr&cfem=b.exr", error)) << error;
    EXPECT_EQ(light.vismap, "a.exr");
    EXPECT_EQ(light.cfem, "b.exr");
    VismapRecipe bake;
    ASSERT_TRUE(read_recipe(bake, "x.vismap?occluder=a, b.obj&mesh=m.obj&occluder=c.obj", error)) << error;
    EXPECT_EQ(bake.mesh, "m.obj");
    EXPECT_EQ(bake.occluder, (std::vector<std::string> { "a, b.obj", "c.obj" }));
    ASSERT_TRUE(read_recipe(bake, "x.vismap?occluder=", error)) << error;
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

namespace {

using Random = std::mt19937;

std::string random_text(Random& random, bool lines)
{
    const std::vector<std::string> parts { "a",
                                           "/",
                                           ".obj",
                                           " ",
                                           ",",
                                           "\"",
                                           "\\",
                                           "\t",
                                           "#",
                                           "=",
                                           "'",
                                           "?",
                                           "[",
                                           "\x7f",
                                           "\x01",
                                           "é",
                                           "\xF0\x9F\x90\x84",
                                           "\"\"\"",
                                           "%20",
                                           "\r" };
    std::string text = "x";
    for (int i = int(random() % 8); i > 0; --i)
        text += parts[random() % parts.size()];
    return lines && random() % 4 == 0 ? text + "\nx" : text;
}

void randomise(Random& random, int& value, const Range& allowed)
{
    value = int(std::uniform_real_distribution<double>(allowed.min, allowed.max)(random));
    if (allowed.word && random() % 2)
        value = int(allowed.word_value);
}
void randomise(Random& random, double& value, const Range& allowed)
{
    value = std::uniform_real_distribution<double>(allowed.min, allowed.max)(random);
    if (allowed.word && random() % 2)
        value = allowed.word_value;
}
void randomise(Random& random, Size& value, const SizeRange& allowed)
{
    value = { int(1 + random() % allowed.max), int(1 + random() % allowed.max) };
}
void randomise(Random& random, std::string& value, const Choices& allowed)
{
    value = allowed.words[random() % allowed.words.size()];
}
void randomise(Random& random, std::vector<std::string>& value, const Words& allowed)
{
    value.assign(allowed.words.rbegin(), allowed.words.rend());
    value.resize(random() % (value.size() + 1));
}
void randomise(Random& random, std::string& value, const Text&)
{
    value = random_text(random, true);
}
void randomise(Random& random, std::string& value, const Path&)
{
    value = random_text(random, true);
}
void randomise(Random& random, std::vector<std::string>& value, const Paths&)
{
    value.clear();
    for (int i = int(random() % 4); i > 0; --i)
        value.push_back(random_text(random, false));
}
void randomise(Random& random, std::vector<double>& value, const Numbers& allowed)
{
    value.resize(allowed.count);
    for (double& number : value)
        number = std::ldexp(std::uniform_real_distribution<double>(-1, 1)(random), int(random() % 80) - 40);
}
void randomise(Random& random, bool& value, const Flag&)
{
    value = random() % 2;
}

template <class Recipe> void expect_round_trips()
{
    Random random(7);
    for (int trial = 0; trial < 500; ++trial) {
        Recipe recipe;
        recipe.visit([&](const char*, auto& value, const auto& allowed, const char*) {
            if (random() % 2)
                randomise(random, value, allowed);
        });
        const std::string text = recipe_text(recipe);
        Recipe back;
        std::string error;
        ASSERT_TRUE(read_recipe_text(back, text, "x", error)) << error << "\n" << text;
        ASSERT_EQ(values(back), values(recipe)) << text;
        ASSERT_EQ(recipe_text(back), text);
        ASSERT_TRUE(check_params(recipe, error)) << error;
    }
    EXPECT_EQ(recipe_text(Recipe {}), "");
}

} // namespace

TEST(Recipe, ItsTextReadsBackToTheSameRecipe)
{
    expect_round_trips<VismapRecipe>();
    expect_round_trips<CfemRecipe>();
    expect_round_trips<LightmapRecipe>();
}

TEST(Recipe, ItsTextIsWhatAUserWouldWrite)
{
    LightmapRecipe light;
    light.vismap = "hero.vismap";
    light.cfem = "C:\\a \"b\".exr";
    light.lightmap_params.rotate = { 0, 90, 0.1 };
    light.cfem_params.resolution = { 64, 32 };
    EXPECT_EQ(recipe_text(light),
              "vismap = \"hero.vismap\"\ncfem = \"C:\\\\a \\\"b\\\".exr\"\nrotate = [0, 90, 0.1]\n"
              "cfem_resolution = \"64x32\"\n");
    VismapRecipe bake;
    bake.occluder = { "a.obj", "b.obj" };
    bake.vismap_params.margin = -1;
    bake.vismap_params.channels = { "coverage", "normal" };
    EXPECT_EQ(recipe_text(bake),
              "occluder = [\n    \"a.obj\",\n    \"b.obj\",\n]\nmargin = \"infinite\"\nchannels = [\"normal\", "
              "\"coverage\"]\n");
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
