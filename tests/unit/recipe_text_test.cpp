// SPDX-License-Identifier: Apache-2.0
// Recipes written as text.
#include "recipe_reading.h"

#include <functional>
#include <random>

using namespace vmlight;

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
    value = allowed.choices[random() % allowed.choices.size()].word;
}
void randomise(Random& random, std::vector<std::string>& value, const ChoiceSet& allowed)
{
    value.clear();
    for (auto choice = allowed.choices.rbegin(); choice != allowed.choices.rend(); ++choice)
        value.emplace_back(choice->word);
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
void randomise(Random& random, std::vector<std::string>& value, const Names&)
{
    randomise(random, value, Paths {});
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

// 0 for "infinite" beside 1e-30 for "next to nothing" is a trap.
TEST(RecipeText, ANumberNeverStandsForAWord)
{
    int words = 0;
    const auto check = [&](const char* name, auto&, const auto& allowed, const char*) {
        if constexpr (std::is_same_v<std::decay_t<decltype(allowed)>, Range>) {
            words += allowed.word != nullptr;
            EXPECT_FALSE(allowed.word && allowed.word_value >= allowed.min && allowed.word_value <= allowed.max)
                << name;
        }
    };
#define VMLIGHT_CHECK(Recipe) Recipe {}.visit(check);
    VMLIGHT_RECIPES(VMLIGHT_CHECK)
#undef VMLIGHT_CHECK
    EXPECT_GE(words, 3);
}
