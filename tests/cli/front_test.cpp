// SPDX-License-Identifier: Apache-2.0
// The fronts, bin/TOOL, answer as what works would: help, completion and wrong usage. (What they load is in
// startup_test.py.)
#include "command_test.h"

#include <cstdlib>

#include <sys/wait.h>

using namespace vmlight;

namespace {

using Words = std::vector<std::string>;

struct Tool
{
    const char* name;
    Words operands, wrong_number;
};

const Tool kTools[] = { { "makevismap", { "a.obj" }, { "--samples", "0" } },
                        { "makecfem", { "a.exr" }, { "--order", "-1" } },
                        { "makelightmap", { "a.exr", "b.exr" }, { "--bounce-albedo", "2" } },
                        { "vmframes", { "a.obj", "b.exr" }, { "--samples", "0.5" } },
                        { "vmcost", { "a.obj", "b.exr" }, { "--reference-samples", "none" } },
                        { "vmexport", { "a.exr" }, { "--for", "doom" } } };

Words joined(Words words, const Words& more)
{
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

class Front : public CommandTest
{
protected:
    Result front(const Words& words) const
    {
        std::string line = "'" + std::string(std::getenv("VMLIGHT_BIN")) + "/" + words[0] + "'";
        for (size_t i = 1; i < words.size(); ++i)
            line += " '" + words[i] + "'";
        const int status = std::system((line + " >front.out 2>front.err").c_str());
        const Result result { WIFEXITED(status) ? WEXITSTATUS(status) : -1, read("front.out"), read("front.err") };
        remove("front.out");
        remove("front.err");
        return result;
    }
};

} // namespace

TEST_F(Front, AnswersAreThoseOfWhatWorks)
{
#ifdef VMLIGHT_SANITIZED
    GTEST_SKIP() << "fronts are compared in optimised builds, which have all of them";
#endif
    ASSERT_TRUE(std::getenv("VMLIGHT_BIN")) << "the folder of the executables";
    for (const auto& [name, operands, wrong_number] : kTools)
        for (const Words& words : { Words { "--help" },
                                    { "--version" },
                                    { "--print-man" },
                                    { "--print-completion", "bash" },
                                    { "--print-flags" },
                                    { "--print-completion", "zsh" },
                                    { "--print-completion", "fish" },
                                    { "--help=x" },
                                    { "-h" },
                                    { "--" },
                                    { "--nonsense" },
                                    { "--threads" },
                                    operands,
                                    joined(joined(operands, wrong_number), { "-o", "x" }),
                                    joined(operands, { "--threads", "many", "-o", "x" }),
                                    joined(operands, { "-o", "" }),
                                    joined(operands, { "--samples", "8", "--sample", "8" }) }) {
            const Words line = joined({ name }, words);
            const Result answer = front(line), truth = run_words(line);
            EXPECT_EQ(answer.code, truth.code) << testing::PrintToString(line);
            EXPECT_EQ(answer.out, truth.out) << testing::PrintToString(line);
            EXPECT_EQ(answer.err, truth.err) << testing::PrintToString(line);
        }
}

TEST_F(Front, TheCommandsOfVmlightHaveAPageAndCompletion)
{
#ifdef VMLIGHT_SANITIZED
    GTEST_SKIP() << "fronts are compared in optimised builds, which have all of them";
#endif
    const std::string page = front({ "vmlight", "--print-man" }).out,
                      bash = front({ "vmlight", "--print-completion", "bash" }).out,
                      zsh = front({ "vmlight", "--print-completion", "zsh" }).out;
    EXPECT_THAT(page, testing::StartsWith(".TH VMLIGHT 1"));
    for (const Tool& tool : kTools) {
        EXPECT_THAT(page, testing::HasSubstr("\\fB" + std::string(tool.name) + "\\fR(1)"));
        for (const std::string& script : { bash, zsh })
            EXPECT_THAT(script, testing::HasSubstr("executable=" + std::string(tool.name) + " ;;"));
    }
    EXPECT_THAT(zsh, testing::StartsWith("#compdef vmlight"));
    write("complete.bash", bash);
    EXPECT_EQ(std::system(("bash -n '" + path("complete.bash") + "'").c_str()), 0);
    const Result wrong = front({ "vmlight", "--print-completion", "fish" });
    EXPECT_EQ(wrong.code, 2);
    EXPECT_THAT(wrong.err, testing::HasSubstr("\"fish\" is not one of bash, zsh"));
}
