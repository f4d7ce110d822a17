// SPDX-License-Identifier: Apache-2.0
/// Command lines as tables: read back, they explain and refuse in the same words, before anything is loaded.
#include <vmlight/cli/early_answer.h>
#include <vmlight/cli/flag_table.h>
#include <vmlight/cli/help_text.h>
#include <vmlight/cli/param_options.h>
#include <vmlight/stage/recipe/recipe.h>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

using namespace vmlight;

namespace {

class FlagTables : public testing::Test
{
protected:
    FlagTables()
    {
        line.name = "maketest";
        line.purpose = "test";
        line.output_metavar = "OUTPUT.exr";
        line.stage = "vismap";
        line.operand_names = { "MESH" };
        line.options = options_of("Test:", recipe, "own_");
        line.options.push_back({ "Output:", "o", "OUTPUT.exr", "Image to write" });
        line.options.back().allowed = Text {};
        line.options.push_back({ "Test:", "judged", "WORD", "Of which only its code knows" });
    }

    std::optional<ExitCode> early(std::vector<const char*> words)
    {
        words.insert(words.begin(), "maketest");
        CommandLine read = read_flag_table(flag_table(line));
        answer.clear();
        error.clear();
        return early_answer(read, int(words.size()), words.data(), answer, error);
    }

    VismapRecipe recipe;
    CommandLine line;
    std::string answer, error;
};

} // namespace

TEST_F(FlagTables, ReadBackTheyAreTheSame)
{
    const CommandLine read = read_flag_table(flag_table(line));
    EXPECT_EQ(flag_table(read), flag_table(line));
    EXPECT_EQ(help_text(read), help_text(line));
    EXPECT_THROW(read_flag_table("{}"), nlohmann::json::exception);
}

// What a flag's code says of a value, its table says, word for word.
TEST_F(FlagTables, ValuesAreRefusedInTheSameWords)
{
    const CommandLine read = read_flag_table(flag_table(line));
    int refused = 0, taken = 0;
    for (const CommandLine::Option& option : line.options)
        for (const char* text : { "0", "-1", "1", "1.5", "1e31", "none", "infinite", "lowest", "8x8", "0x8", "1,2,3",
                                  "a,a", "visibility", "sobol", "true", "maybe", "x", "a\n\nb" }) {
            if (!option.take)
                continue;
            std::string expected, found;
            const bool is_taken = option.take(text, expected);
            const auto same = std::find_if(read.options.begin(), read.options.end(),
                                           [&](const auto& other) { return other.name == option.name; });
            ASSERT_NE(same, read.options.end());
            EXPECT_EQ(is_allowed(text, same->allowed, found), is_taken) << option.name << " " << text;
            EXPECT_EQ(found.empty() ? "" : option.parameter + ": " + found, expected) << option.name << " " << text;
            ++(is_taken ? taken : refused);
        }
    EXPECT_GT(refused, 100);
    EXPECT_GT(taken, 100);
}

TEST_F(FlagTables, WhatTheyCannotKnowIsLeftToTheWork)
{
    const std::optional<ExitCode> work;
    EXPECT_EQ(early({ "a.obj", "-o", "b.exr" }), work);
    EXPECT_EQ(early({ "a.obj", "-o", "b.exr", "--own-samples", "8" }), work);
    EXPECT_EQ(early({ "a.obj", "--judged", "x", "--own-samples", "none" }), work)
        << "which may be wrong too, and is first";
    EXPECT_EQ(early({ "a.vismap", "--own-samples", "none", "-o", "b.exr" }), work) << "the recipe is read first";
    EXPECT_EQ(early({ "a.VISMAP", "-o", "b.exr" }), work);
    EXPECT_EQ(early({ "what?.obj", "b.obj" }), work) << "may be a recipe's query";
}

TEST_F(FlagTables, WhatTheyKnowIsAnsweredAtOnce)
{
    EXPECT_EQ(early({ "--help" }), ExitCode::Done);
    EXPECT_EQ(answer, help_text(line));
    EXPECT_EQ(early({}), ExitCode::Usage);
    EXPECT_EQ(error, "MESH is missing");
    EXPECT_EQ(early({ "a.obj" }), ExitCode::Usage);
    EXPECT_EQ(error, "-o OUTPUT.exr is missing");
    EXPECT_EQ(early({ "a.obj", "--own-samples", "0", "-o", "b.exr" }), ExitCode::Usage);
    EXPECT_EQ(error, "--own-samples: 0 is not in [1, 1048576]");
    EXPECT_EQ(early({ "a.obj", "--own-samples=", "-o", "b.exr" }), ExitCode::Usage);
    EXPECT_EQ(error, "--own-samples has an empty value");
}
