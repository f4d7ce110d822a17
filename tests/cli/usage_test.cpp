// SPDX-License-Identifier: Apache-2.0
// Command lines: help, flags, values, and what does not go together.
#include "command_test.h"

using namespace vmlight;
using testing::HasSubstr;
using testing::Not;

namespace {

class Usage : public CommandTest
{
protected:
    const std::vector<std::pair<std::string, std::string>> tools { { "makevismap", "quad.obj" },
                                                                   { "makecfem", "sky.exr" },
                                                                   { "makelightmap", "vm.exr sky.exr" } };

    void SetUp() override
    {
        make_vismap();
        make_sky({ 1, 1, 1 });
    }
};

} // namespace

TEST_F(Usage, HelpAndVersionEndWith0)
{
    for (const auto& [tool, operands] : tools) {
        EXPECT_THAT(done(tool + " --help"), HasSubstr("Usage: " + tool));
        EXPECT_THAT(done(tool + " --version"), testing::ContainsRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
        EXPECT_THAT(done(tool + " -o '' --help"), HasSubstr("Usage: " + tool));
    }
}

TEST_F(Usage, QuietPrintsNothing)
{
    for (const auto& [tool, operands] : tools) {
        const std::string small = tool == "makelightmap" ? "" : " --resolution 32";
        EXPECT_EQ(done(tool + " " + operands + small + " -o x.exr --quiet"), "") << tool;
    }
}

TEST_F(Usage, AnUnknownFlagIsRefusedWithTheNearest)
{
    refused(2, "unknown flag \"--sample\"; did you mean --samples or --sampler?",
            "makevismap quad.obj -o x.exr --sample 4");
    refused(2, "unknown flag \"-x\"", "makecfem sky.exr -x -o x.exr");
    refused(2, "unknown flag \"--rotation\"", "makelightmap vm.exr sky.exr -o x.exr --rotation=1,2,3");
}

TEST_F(Usage, AMissingOrSurplusArgumentIsNamed)
{
    refused(2, "-o OUTPUT.exr is missing", "makevismap quad.obj");
    for (const auto& [tool, operands] : tools) {
        refused(2, " is missing", tool + " -o x.exr");
        refused(2, "unexpected argument \"surplus\"", tool + " " + operands + " surplus -o x.exr");
    }
    refused(2, "", "makevismap quad.obj -o");
    refused(2, "", "makevismap quad.obj -o x.exr --samples");
}

TEST_F(Usage, ValuesAreParsedStrictly)
{
    const struct
    {
        const char *flag, *value, *error;
    } cases[] = {
        { "--samples", "0", "--samples: 0 is not in [1, 1048576]" },
        { "--samples", "4x", "samples: \"4x\" is not a whole number" },
        { "--samples", "", "--samples has an empty value" },
        { "--occluder", " ", "--occluder has an empty value" },
        { "--resolution", "0", "resolution: \"0\" is not WIDTH or WIDTHxHEIGHT in pixels, each from 1 to 32768" },
        { "--resolution", "99999", "resolution:" },
        { "--sampler", "random", "sampler: \"random\" is not one of fibonacci, sobol, halton" },
        { "--max-distance", "far", "--max-distance: \"far\" is not a number or \"infinite\"" },
        { "--max-distance", "nan", "--max-distance: \"nan\" is not a number" },
        { "--max-distance", "-1", "--max-distance: -1 is not in [1e-30, 1e+30] or \"infinite\"" },
        { "--max-distance", "0",
          "--max-distance: 0 is not in [1e-30, 1e+30] or \"infinite\"; did you mean \"infinite\"?" },
        { "--target-error", "0", "--target-error: 0 is not in [1e-09, 1] or \"none\"; did you mean \"none\"?" },
        { "--margin", "-2", "margin: -2 is not in" },
        { "--channels", "normals",
          "channels: \"normals\" is not one of normal, coverage, error; did you mean \"normal\"?" },
        { "--channels", "normal,normal", "channels: \"normal\" is given twice" },
        { "--format", "double", "format: \"double\" is not one of float, half" },
        { "--compression", "dwaa", "compression: \"dwaa\" is not one of zip, none" },
        { "--threads", "-1", "threads: -1 is not in [0, 1024]" },
        { "--uv-set", "8", "--uv-set: 8 is not in [0, 7]" },
    };
    for (const auto& [flag, value, error] : cases) {
        refused_words(2, error, { "makevismap", "quad.obj", "-o", "x.exr", flag, value });
        refused_words(2, error, { "makevismap", "quad.obj", "-o", "x.exr", std::string(flag) + "=" + value });
    }
    refused(2, "--quiet takes no value", "makevismap quad.obj -o x.exr --quiet=1");
}

TEST_F(Usage, ValuesMayBeginWithAMinusOrFollowAnEqualsSign)
{
    done("makelightmap vm.exr sky.exr -o a.exr --rotate -90,0,0 --exposure -1");
    done("makelightmap vm.exr sky.exr -o=b.exr --rotate=-90,0,0 --exposure=-1");
    EXPECT_EQ(read("a.exr"), read("b.exr"));
}

TEST_F(Usage, FramesAreRefusedInWords)
{
    const std::string light = "makelightmap vm.exr sky.exr -o ";
    refused(2, "is not a frame range", light + "x.#.exr --frames 1-x");
    refused(2, "--frames has an empty value", light + "x.#.exr --frames ''");
    refused(2, "is not FIRST:LAST or one number", light + "x.#.exr --rotate-y 0:b");
    for (const char* endless : { "1-2000000000", "1-3x0", "1-3x", "1-3x00,5" })
        refused(2, "up to 999999", light + "x.#.exr --frames " + endless);
    refused(2, "0 to 90 degrees needs --frames", light + "x.exr --rotate-y 0:90");
    refused(2, "4 frames need #### in the file name", light + "x.exr --frames 1-4");
}

TEST_F(Usage, ErrorsNameTheFlagAsItIsTyped)
{
    refused(2, "makevismap ERROR: --max-distance: -1 is not in ", "makevismap quad.obj -o x.exr --max-distance -1");
    refused(2, "makevismap ERROR: --part: \"3\" is not a part", "makevismap quad.obj -o x.exr --part 3");
    refused(2, "makelightmap ERROR: --rotate-y: 0 to 90 degrees",
            "makelightmap vm.exr sky.exr -o x.exr --rotate-y 0:90");
    // What is given without a flag has none; a recipe's keys stay keys.
    refused(2, "makelightmap ERROR: vismap: \"vm.<UDIM>.exr\": ", "makelightmap vm.<UDIM>.exr sky.exr -o x.exr");
    write("far.vismap", "mesh = \"quad.obj\"\nmax_distance = -1\n");
    refused(1, "\"far.vismap\" line 2: max_distance: -1 is not in ", "makevismap far.vismap -o x.exr");
}

TEST_F(Usage, PlaceholdersThatStayInAFileNameAreWarnedOf)
{
    const std::string bake = "makevismap quad.obj --resolution 16 --samples 4 -o ",
                      light = "makelightmap vm.exr sky.exr -o ";
    const std::string stays = " stays in the file name: ";
    EXPECT_THAT(done(bake + "'a_<INST>.exr'"),
                HasSubstr("makevismap WARNING: \"a_<INST>.exr\": <INST>" + stays
                          + "the placeholders are <UDIM>, <MATERIAL> and <INSTANCE>"));
    EXPECT_TRUE(exists("a_<INST>.exr"));
    EXPECT_THAT(done(light + "'a_<udim>.exr'"), HasSubstr("<udim>" + stays + "the placeholders are <UDIM>\n"));
    EXPECT_THAT(done("vmframes quad.obj sky.exr --size 16 --vismap vm.exr -o 'a_<UDIM>.png'"),
                HasSubstr("<UDIM>" + stays + "vmframes replaces nothing in it"));
    for (const std::string& tool : { bake, light })
        EXPECT_THAT(done(tool + "a.####.exr"), HasSubstr("#" + stays + "pass --frames, such as 1-48"));
    EXPECT_TRUE(exists("a.####.exr"));
    // Names that are only odd; and what is replaced.
    for (const std::string name : { "a#1.exr", "<>.exr", "a<b.exr", "a>b<.exr", "<a b>.exr", "<UDIM>.exr" })
        EXPECT_THAT(done(bake + "'" + name + "'"), Not(HasSubstr(stays))) << name;
    EXPECT_THAT(done(light + "a.##.exr --frames 1"), Not(HasSubstr(stays)));
}

TEST_F(Usage, FlagsThatDoNotGoTogetherAreWrongUsageBeforeAnyWork)
{
    const std::string mirror = "--matrix -1,0,0,0,1,0,0,0,1";
    const std::pair<std::string, std::string> cases[] = {
        { "only one of rotate, matrix and quaternion", "--rotate 1,2,3 " + mirror },
        { "--matrix: a reflection, not a rotation", mirror },
        { "--matrix: not a rotation", "--matrix 1,0,0,0,1,0,0,0,2" },
        { "--quaternion: 0,0,0,0 is zero or not finite", "--quaternion 0,0,0,0" },
        { "environment is set too", "--cfem sky.exr" },
        { "--vismap has an empty value", "--vismap ''" },
        { "--environment has an empty value", "--environment ''" },
    };
    for (const auto& [error, flags] : cases) {
        refused(2, "makelightmap ERROR: " + error, "makelightmap vm.exr sky.exr -o x.exr " + flags);
        // Nothing was read: none of these files is there.
        refused(2, error, "makelightmap gone.exr gone.exr -o x.exr " + flags);
    }
    refused(2, " is missing", "makevismap '' -o x.exr");
    refused(2, " is missing", "makecfem '' -o x.exr");
    refused(2, " is missing", "makelightmap '' '' -o x.exr");
    // A recipe's fault is not the command line's, unless its flags caused it.
    write("mirror.lightmap", "vismap = \"vm.exr\"\nenvironment = \"sky.exr\"\nmatrix = [-1, 0, 0, 0, 1, 0, 0, 0, 1]\n");
    refused(1, "\"mirror.lightmap\" line 3: matrix: a reflection", "makelightmap mirror.lightmap -o x.exr");
    refused(2, "only one of rotate", "makelightmap mirror.lightmap -o x.exr --rotate 0,90,0");
    done("makelightmap mirror.lightmap -o x.exr --rotate 0,90,0 --matrix=");
}

TEST_F(Usage, AFlagThatCannotChangeThePictureIsRefused)
{
    done("makecfem sky.exr -o cfem.exr --order 2 --filter sh");
    const std::string bake = "makevismap quad.obj -o x.exr ", environment = "makelightmap vm.exr sky.exr -o x.exr ",
                      lit = "makelightmap vm.exr cfem.exr -o x.exr ", filtered = "\"cfem.exr\" is already filtered";
    const std::pair<std::string, std::string> cases[] = {
        { "--order 3: only the filter sh uses it", "makecfem sky.exr -o x.exr --order 3" },
        { "--cfem-order 2: only the filter sh uses it", environment + "--cfem-order=2" },
        { "--albedo-colorspace ACEScg: no albedo is given", environment + "--albedo-colorspace ACEScg" },
        { "--cfem-filter sh: no environment to filter: " + filtered, lit + "--cfem-filter sh" },
        { "--cfem-sanitize: no environment to filter: " + filtered, lit + "--cfem-sanitize" },
        { "--layer a: no environment to read: " + filtered, lit + "--layer a" },
        { "--layout latlong: no environment to read: " + filtered, lit + "--layout latlong" },
        { "--albedo-layer a: no albedo is given", environment + "--albedo-layer a" },
        { "--cfem-resolution 8: no environment to filter", environment + "--is-cfem --cfem-resolution 8" },
        { "--crease-angle 30: flat normals", bake + "--normals flat --crease-angle 30" },
        { "--frame 3: only Alembic files have frames", bake + "--frame 3" },
        { "--fps 25: no frame is given", bake + "--fps 25" },
        { "--reconstruct auto: what the basis mask packs of each ray has no mean",
          bake + "--reconstruct auto --basis mask" },
        { "--samples 8: target_error sets the number", bake + "--samples 8 --target-error 0.1" },
        { "--samples 8: time_budget sets the number", bake + "--time-budget=1 --samples 8" },
        { "--time-budget 1: target_error sets the number", bake + "--time-budget=1 --target-error=0.1" },
        { "--resolution 8: width and height", bake + "--resolution 8 --width 4 --height 4" },
    };
    for (const auto& [error, line] : cases)
        refused(2, line.substr(0, line.find(' ')) + " ERROR: " + error, line);
    // By flags only: a recipe may keep what it does not use just now.
    write("a.lightmap", "vismap = \"vm.exr\"\ncfem = \"cfem.exr\"\ncfem_order = 5\ncolorspace = \"data\"\n");
    done("makelightmap a.lightmap -o x.exr");
    done(environment + "--cfem-filter=sh --cfem-order=2");
    done(bake + "--resolution=8x9 --height=4 --samples=1");
}
