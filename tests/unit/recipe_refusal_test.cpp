// SPDX-License-Identifier: Apache-2.0
// What is not a recipe, and how that is reported.
#include "recipe_reading.h"
#include "temporary_folder.h"

using namespace vmlight;

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
    EXPECT_EQ(refusal<VismapRecipe>("max_distance = 0"),
              "\"hero.lightmap\" line 1: max_distance: 0 is not in [1e-30, 1e+30] or \"infinite\"; did you mean "
              "\"infinite\"?");
    EXPECT_EQ(refusal<VismapRecipe>("target_error = 0"),
              "\"hero.lightmap\" line 1: target_error: 0 is not in [1e-09, 1] or \"none\"; did you mean \"none\"?");
    EXPECT_EQ(refusal<VismapRecipe>("occluder = [\"a\", 1]"),
              "\"hero.lightmap\" line 1: occluder: an integer where a path in quotes is needed");
    EXPECT_EQ(refusal<VismapRecipe>("occluder = 1"),
              "\"hero.lightmap\" line 1: occluder: an integer where an array of paths in quotes is needed");
    EXPECT_EQ(refusal<VismapRecipe>("occluder = [\"\"]"),
              "\"hero.lightmap\" line 1: occluder: one of the names is empty");
    EXPECT_EQ(refusal<VismapRecipe>("occluder = [\"a\\nb\"]"),
              "\"hero.lightmap\" line 1: occluder: a name in a list cannot contain a line break");
}

TEST(Recipe, RefusesAValueOutOfRange)
{
    EXPECT_EQ(refusal("exposure = 65"), "\"hero.lightmap\" line 1: exposure: 65 is not in [-64, 64]");
    EXPECT_EQ(refusal("exposure = 64.5"), "\"hero.lightmap\" line 1: exposure: 64.5 is not in [-64, 64]");
    EXPECT_EQ(refusal("exposure = nan"), "\"hero.lightmap\" line 1: exposure: \"nan\" is not a number");
    EXPECT_EQ(refusal("exposure = -inf"), "\"hero.lightmap\" line 1: exposure: \"-inf\" is not a number");
    EXPECT_EQ(refusal("cfem_order = 9223372036854775807"),
              "\"hero.lightmap\" line 1: cfem_order: 9223372036854775807 is not in [1, 64]");
    EXPECT_EQ(refusal("rotate = [0, 90]"), "\"hero.lightmap\" line 1: rotate: \"0,90\" has 2 numbers, expected 3");
    EXPECT_EQ(refusal("cfem_filter = \"Exact\""),
              "\"hero.lightmap\" line 1: cfem_filter: \"Exact\" is not one of exact, sh");
    EXPECT_EQ(refusal("cfem_filter = \"a\\nb\""),
              "\"hero.lightmap\" line 1: cfem_filter: \"a\\x0ab\" is not one of exact, sh");
    EXPECT_EQ(refusal("cfem_resolution = [0, 32]"),
              "\"hero.lightmap\" line 1: cfem_resolution: \"0x32\" is not "
              "WIDTH or WIDTHxHEIGHT in pixels, each from 1 to 16384");
    EXPECT_EQ(refusal("vismap = \"a\\u0000b\""), "\"hero.lightmap\" line 1: vismap: a name cannot contain a zero byte");
}

// What follows "not TOML" are toml++'s words, which change with its version.
TEST(Recipe, RefusesWhatIsNotToml)
{
    const std::string twice = refusal("rotate = [0, 90, 0]\nexposure = 1\nrotate = [0, 0, 0]");
    EXPECT_EQ(twice.rfind("\"hero.lightmap\" line 3: not TOML: ", 0), 0u) << twice;
    EXPECT_NE(twice.find("cannot redefine existing array 'rotate'"), std::string::npos) << twice;
    EXPECT_NE(refusal("vismap = hero.exr").find("; strings need quotes"), std::string::npos);
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
        EXPECT_EQ(refusal(text), "\"hero.lightmap\" line 1: three quotes in a row: recipe strings are single-line");
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
    // Mostly misspelt: the query alone would be another picture.
    EXPECT_EQ(name_refusal("gone.lightmap?vismap=a.exr&cfem=b.exr"), "\"gone.lightmap\": no such file");
    EXPECT_EQ(name_refusal("gone?/hero.lightmap?exposure=1"), "\"gone?/hero.lightmap\": no such file");
    const std::string path = folder / ".";
    EXPECT_EQ(name_refusal(path), "\"" + path + "\": not a file");
    const std::string empty = folder.write("empty.lightmap", "");
    EXPECT_EQ(name_refusal(empty), "\"" + empty + "\": the file is empty");
    const std::string huge = folder.write("huge.lightmap", std::string((1 << 20) + 1, '\n'));
    EXPECT_EQ(name_refusal(huge), "\"" + huge + "\": 1048577 bytes are too large for a recipe; the limit is 1048576");
    const std::string largest = folder.write("largest.lightmap", std::string(1 << 20, '\n'));
    LightmapRecipe recipe;
    std::string error;
    EXPECT_TRUE(read_recipe(recipe, largest, error)) << error;
}
