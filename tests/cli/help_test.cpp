// SPDX-License-Identifier: Apache-2.0
// --help: its examples are command lines of the tool.
#include "command_test.h"

#include <OpenImageIO/strutil.h>

#include <regex>

using namespace vmlight;
using testing::HasSubstr;
using testing::Not;

namespace {

class HelpText : public CommandTest
{
protected:
    HelpText()
    {
        make_vismap();
        make_sky({ 1, 1, 1 });
    }
    // On one line.
    std::string help(const std::string& tool) const
    {
        return OIIO::Strutil::join(OIIO::Strutil::splits(done(tool + " --help")), " ");
    }
    std::vector<std::string> examples(const std::string& tool) const
    {
        const std::string text = done(tool + " --help"), heading = "Examples:\n";
        const size_t start = text.find(heading) + heading.size();
        return OIIO::Strutil::splits(text.substr(start, text.find("\n\n", start) - start), "\n");
    }
};

} // namespace

TEST_F(HelpText, SwitchesOfEffectsAreThoseOfTheTool)
{
    const std::pair<const char*, const char*> commands[]
        = { { "makevismap", "makevismap quad.obj --ground --resolution 8 --samples 4" },
            { "makelightmap", "makelightmap vm.exr sky.exr" } };
    for (const auto& [tool, command] : commands) {
        std::smatch found;
        const std::string text = help(tool);
        ASSERT_TRUE(std::regex_search(text, found, std::regex("or switches such as ([-+a-z,]+);"))) << text;
        done(std::string(command) + " -o a.exr --effects " + found[1].str());
    }
}

// The files are not there, or hold nothing to bake, but nothing is wrong with the usage.
TEST_F(HelpText, ExamplesAreCommandLines)
{
    write("walk.0001.obj", kQuad);
    write("hero_vismap.1001.exr", read("vm.exr"));
    write("hero.obj", "v 0 0 0\n");
    for (const char* tool : { "makevismap", "makecfem", "makelightmap", "vmexport", "vmframes" }) {
        EXPECT_GE(examples(tool).size(), 2u) << tool;
        for (std::string line : examples(tool)) {
            line = line.substr(0, line.find(" >"));
            line.erase(0, line.find_first_not_of(' '));
            EXPECT_EQ(line.rfind(tool, 0), 0u) << line;
            const Result result = run(line + " --quiet");
            EXPECT_NE(result.code, 2) << line << "\n" << result.err;
        }
    }
}

// There, materials are the albedo, further objects and the ground are meshes, and all of them are known.
TEST_F(HelpText, FramesSpeakOfFrames)
{
    const std::string text = help("vmframes");
    EXPECT_THAT(text, Not(HasSubstr("mesh is not known")));
    EXPECT_THAT(text, Not(HasSubstr("mesh is known")));
    EXPECT_THAT(text, Not(HasSubstr("the rest occludes")));
    EXPECT_THAT(text, Not(HasSubstr("--udim ")));
    EXPECT_THAT(text, HasSubstr("surfaces whose materials have no colour"));
    refused(2, "unknown flag \"--udim\"", "vmframes quad.obj sky.exr -o a.png --udim 1002");
}
