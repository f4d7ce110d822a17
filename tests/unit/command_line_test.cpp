// SPDX-License-Identifier: Apache-2.0
/// How command lines are split, and what is made of their description: help, man page, completion.
#include <vmlight/cli/command_line.h>
#include <vmlight/cli/param_options.h>
#include <vmlight/cli/stage_command.h>
#include <vmlight/stage/recipe/recipe.h>

#include <OpenImageIO/strutil.h>

#include <gtest/gtest.h>

using namespace vmlight;

namespace {

class CommandLines : public testing::Test
{
protected:
    CommandLines()
    {
        line.name = "maketest";
        line.purpose = "test";
        line.output_metavar = "OUTPUT.exr";
        line.stage = "vismap";
        line.operand_names = { "MESH" };
        line.options = options_of("Test:", recipe, "");
    }

    /// The reason why the words are refused, or "".
    std::string refusal(std::vector<const char*> words)
    {
        words.insert(words.begin(), "maketest");
        CommandLine fresh = line;
        std::string error;
        const bool parsed = fresh.parse(int(words.size()), words.data(), answer, error);
        EXPECT_EQ(parsed, error.empty());
        given.clear();
        for (const auto& [option, value] : fresh.given)
            given.push_back(option->name + "=" + value);
        operands = fresh.operands;
        return error;
    }

    VismapRecipe recipe;
    CommandLine line;
    std::string answer;
    std::vector<std::string> given, operands;
};

} // namespace

TEST_F(CommandLines, ValuesFollowTheirFlagOrAnEqualsSign)
{
    EXPECT_EQ(refusal({ "a.obj", "--samples=4", "--max-distance", "-1", "--channels=a=b" }), "");
    EXPECT_EQ(given, (std::vector<std::string> { "samples=4", "max_distance=-1", "channels=a=b" }));
    EXPECT_EQ(operands, std::vector<std::string> { "a.obj" });
    EXPECT_EQ(refusal({ "-" }), "") << "is an operand";
}

TEST_F(CommandLines, RefusalsNameTheWord)
{
    EXPECT_EQ(refusal({ "a.obj", "--sample", "4" }), "unknown flag \"--sample\"; did you mean --samples or --sampler?");
    EXPECT_EQ(refusal({ "a.obj", "--samples" }), "--samples needs a value: 1..1048576");
    EXPECT_EQ(refusal({ "a.obj", "--samples", " " }), "--samples has an empty value");
    EXPECT_EQ(refusal({ "a.vismap", "--samples", "" }), "") << "clears a recipe's key";
    EXPECT_EQ(refusal({}), "MESH is missing");
    EXPECT_EQ(refusal({ "a.obj", "b.obj" }), "unexpected argument \"b.obj\"");
    EXPECT_EQ(refusal({ "--help=1" }), "--help takes no value");
    EXPECT_EQ(refusal({ "--print-completion", "fish" }), "print_completion: \"fish\" is not one of bash, zsh");
}

TEST_F(CommandLines, AnUnknownFlagSuggestsWhatOtherToolsMeanByIt)
{
    const auto suggestion = [&](const std::string& flag) {
        const std::string unknown = "unknown flag \"" + flag + "\"", error = refusal({ "a.obj", flag.c_str(), "4" });
        EXPECT_EQ(error.substr(0, unknown.size()), unknown);
        return error.substr(unknown.size());
    };
    EXPECT_EQ(suggestion("--spp"), "; did you mean --samples?");
    EXPECT_EQ(suggestion("-Edge_Padding"), "; did you mean --margin?");
    EXPECT_EQ(suggestion("--res"), "; did you mean --resolution?") << "and not the nearest by letters, --mesh";
    EXPECT_EQ(suggestion("--crease"), "; did you mean --crease-angle?");
    EXPECT_EQ(suggestion("--m"), "");
    EXPECT_EQ(suggestion("--uv-s"), "; did you mean --uv-set?");
    EXPECT_EQ(suggestion("--angle"), "; did you mean --crease-angle?");
    EXPECT_EQ(suggestion("--sun"), "; did you mean --sun-directions?");
    EXPECT_EQ(suggestion("--wibble"), "");
}

TEST_F(CommandLines, HelpAnswersWhateverElseIsMissing)
{
    EXPECT_EQ(refusal({ "--samples", "", "--help", "--none" }), "");
    for (const std::string& text : OIIO::Strutil::splits(answer, "\n"))
        EXPECT_LE(text.size(), 79u) << text;
    EXPECT_NE(answer.find("  --samples 1..1048576      Rays per texel [64]\n"), std::string::npos) << answer;
    EXPECT_NE(answer.find("\n                              halton     Halton sequence"), std::string::npos) << answer;
    EXPECT_LT(answer.find("--samples"), answer.find("Advanced:"));
    EXPECT_GT(answer.find("--seed"), answer.find("Advanced:"));
}

TEST_F(CommandLines, ManPageAndCompletionHaveEveryFlag)
{
    for (const char* flag : { "--print-man", "--print-completion=bash", "--print-completion=zsh" }) {
        ASSERT_EQ(refusal({ flag }), "");
        const std::string plain = OIIO::Strutil::replace(answer, "\\-", "-", true);
        for (const CommandLine::Option& option : line.options)
            EXPECT_NE(plain.find(option.flag()), std::string::npos) << option.name << " in " << flag;
    }
}

TEST(Help, ExplainsEveryParameterAndWord)
{
    const auto check = [](auto params) {
        params.visit([](const char* name, auto&, const auto& allowed, const char* help) {
            EXPECT_FALSE(std::string(help).empty()) << name;
            EXPECT_NE(std::string(help).back(), '.') << name;
            for (const Choice& choice : choices_of(allowed))
                EXPECT_GT(std::string(choice.meaning).size(), 5u) << name << " " << choice.word;
        });
    };
    check(VismapRecipe {});
    check(CfemRecipe {});
    check(LightmapRecipe {});
    check(FileParams {});
    check(RunParams {});
}
