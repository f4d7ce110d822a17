// SPDX-License-Identifier: Apache-2.0
// Several poses of a mesh: makevismap --frames, --pose and --pose-error.
#include "command_test.h"

#include <vmlight/base/format.h>

#include <cmath>

using namespace vmlight;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::Not;

namespace {

// A box of four walls and a floor, 2 wide, 2 high and 8 long, and at one end of it a lid that opens about the x axis.
std::string lidded(double degrees, const std::string& first_x = "-1")
{
    const double angle = degrees * M_PI / 180, up = 2 + std::sin(angle), along = 3 + std::cos(angle);
    std::string text
        = format("v {} 0 -4\nv 1 0 -4\nv 1 0 4\nv -1 0 4\nv -1 2 -4\nv 1 2 -4\nv 1 2 4\nv -1 2 4\n", first_x);
    text += format("v -1 2 3\nv 1 2 3\nv 1 {0:.6f} {1:.6f}\nv -1 {0:.6f} {1:.6f}\nv 0 9 0\nv 0.01 9 0\nv 0 9 0.01\n",
                   up, along);
    for (int side = 0; side < 6; ++side) {
        const double u = side % 3 / 3.0 + 0.01, v = side / 3 / 2.0 + 0.01;
        text += format("vt {0:.4f} {1:.4f}\nvt {2:.4f} {1:.4f}\nvt {2:.4f} {3:.4f}\nvt {0:.4f} {3:.4f}\n", u, v,
                       u + 0.31, v + 0.47);
    }
    const int corners[6][4]
        = { { 1, 4, 3, 2 }, { 1, 2, 6, 5 }, { 2, 3, 7, 6 }, { 3, 4, 8, 7 }, { 4, 1, 5, 8 }, { 9, 12, 11, 10 } };
    text += "s off\n";
    for (int side = 0; side < 6; ++side) {
        text += "f";
        for (int k = 0; k < 4; ++k)
            text += format(" {}/{}", corners[side][k], 4 * side + k + 1);
        text += "\n";
    }
    return text + "f 13 14 15\n"; // the box around it stays
}

// By 90 degrees about y.
std::string quarter_turned(const std::string& obj)
{
    std::string text;
    for (const std::string& line : OIIO::Strutil::splits(obj, "\n")) {
        const std::vector<std::string> words = OIIO::Strutil::splits(line, " ");
        text += words.size() == 4 && words[0] == "v" ? format("v {} {} {}\n", words[3], words[2], -std::stod(words[1]))
                                                     : line + "\n";
    }
    return text;
}

class Poses : public CommandTest
{
protected:
    void SetUp() override
    {
        for (int frame = 1; frame <= 3; ++frame)
            write(format("lid.{:04d}.obj", frame), lidded(5.0 * (frame - 1)));
    }
    static constexpr const char* kFlags = " --resolution 64 --samples 64 ";
};

} // namespace

TEST_F(Poses, FramesKeepWhatDoesNotChange)
{
    const std::string said = done(std::string("makevismap lid.####.obj --frames 1-3 -o vm.####.exr") + kFlags);
    EXPECT_THAT(said, HasSubstr("frame 2: pose: V changes by at most "));
    EXPECT_THAT(said, HasSubstr(" % of the texels are traced again, the others are kept from frame 1"));
    EXPECT_EQ(names("vm"), (std::vector<std::string> { "vm.0001.exr", "vm.0002.exr", "vm.0003.exr" }));
    for (int frame = 1; frame <= 3; ++frame)
        done(format("makevismap lid.{0:04d}.obj -o alone.{0:04d}.exr{1}", frame, kFlags));
    EXPECT_EQ(read("vm.0001.exr"), read("alone.0001.exr"));
    EXPECT_EQ(attribute("vm.0001.exr", "vmlight:pose_base"), "");
    EXPECT_EQ(attribute("vm.0003.exr", "vmlight:pose_base"), "frame 1");
    EXPECT_EQ(attribute("vm.0003.exr", "vmlight:pose_error"), "0.02");
    EXPECT_EQ(attribute("vm.0003.exr", "vmlight:mesh"), "lid.0003.obj");
    const Pixels kept = visibility("vm.0003.exr"), whole = visibility("alone.0003.exr");
    int beyond = 0;
    for (size_t i = 0; i < kept.values.size(); ++i)
        beyond += std::abs(kept.values[i] - whole.values[i]) > 0.02f;
    EXPECT_LE(beyond, int(kept.values.size() / 100));
    // Proof alone: the same pixels.
    done(std::string("makevismap lid.####.obj --frames 1-3 --pose-error 0 -o proof.####.exr") + kFlags);
    expect_same_pixels("proof.0003.exr", "alone.0003.exr", 0);
}

TEST_F(Poses, SwitchedOnEachPoseIsBakedWhole)
{
    const std::string flags = std::string(" --effects +poses") + kFlags;
    EXPECT_THAT(done("makevismap lid.####.obj --frames 2,3 -o vm.####.exr" + flags), Not(HasSubstr("pose:")));
    for (int frame = 2; frame <= 3; ++frame) {
        done(format("makevismap lid.{0:04d}.obj -o alone.{0:04d}.exr{1}", frame, kFlags));
        EXPECT_EQ(read(format("vm.{:04d}.exr", frame)), read(format("alone.{:04d}.exr", frame)));
    }
    refused(1, "effects: +poses is impossible: one pose is given: give --frames or --pose",
            "makevismap lid.0001.obj -o x.exr" + flags);
}

TEST_F(Poses, AnotherPoseIsComparedBeforeTheBake)
{
    const std::string said
        = done(std::string("makevismap lid.0001.obj --pose lid.0002.obj --pose lid.0003.obj -o vm.exr") + kFlags);
    EXPECT_THAT(said, HasSubstr("pose \"lid.0002.obj\": V changes by at most "));
    EXPECT_THAT(said, HasSubstr(" % by more than 0.02 ("));
    EXPECT_LT(said.find("lid.0003.obj"), said.find("bake:"));
    done(std::string("makevismap lid.0001.obj -o alone.exr") + kFlags);
    EXPECT_EQ(read("vm.exr"), read("alone.exr"));
    write("same.obj", lidded(0));
    EXPECT_THAT(done(std::string("makevismap lid.0001.obj --pose same.obj -o vm.exr") + kFlags),
                HasSubstr("pose \"same.obj\": everything moves as one body: V stays, and B turns with it\n"));
    write("turned.obj", quarter_turned(lidded(0)));
    const std::string line = std::string("makevismap lid.0001.obj --pose turned.obj -o vm.exr") + kFlags,
                      stays = "pose \"turned.obj\": everything moves as one body: V stays, and B turns with it";
    EXPECT_THAT(done(line), HasSubstr(stays + "\n"));
    EXPECT_THAT(done(line + " --basis mask"), HasSubstr(stays + "; its basis must be baked again\n"));
}

TEST_F(Poses, PosesAreBakedWhereTheOutputHasANumber)
{
    done(std::string("makevismap lid.0001.obj --pose lid.0003.obj -o vm.##.exr") + kFlags);
    EXPECT_EQ(names("vm"), (std::vector<std::string> { "vm.00.exr", "vm.01.exr" }));
    EXPECT_EQ(attribute("vm.01.exr", "vmlight:pose_base"), "lid.0001.obj");
    EXPECT_EQ(attribute("vm.01.exr", "vmlight:mesh"), "lid.0003.obj");
}

TEST_F(Poses, OccludersMayBeWhatMoves)
{
    for (int frame = 1; frame <= 2; ++frame)
        write(format("cloud.{}.obj", frame), format("v {0} 5 -1\nv {0} 5 1\nv {1} 5 1\nf 1 2 3\n", -frame, 2 - frame));
    const std::string said
        = done(std::string("makevismap lid.0001.obj --occluder cloud.#.obj --frames 1-2 -o vm.#.exr") + kFlags);
    EXPECT_THAT(said, HasSubstr("are kept from frame 1"));
    done(std::string("makevismap lid.0001.obj --occluder cloud.2.obj -o alone.exr") + kFlags);
    const Pixels kept = visibility("vm.2.exr"), whole = visibility("alone.exr");
    int beyond = 0;
    for (size_t i = 0; i < kept.values.size(); ++i)
        beyond += std::abs(kept.values[i] - whole.values[i]) > 0.02f;
    EXPECT_LE(beyond, int(kept.values.size() / 100));
}

TEST_F(Poses, ExplainCountsThem)
{
    const std::string said
        = run(std::string("makevismap lid.####.obj --frames 1-3 --explain -o vm.####.exr") + kFlags).out;
    EXPECT_THAT(said, HasSubstr("3 poses; texels are traced again where V may change by more than 0.02"));
    // After all of them, and what each says of itself beside its seconds.
    const size_t table = said.find("took, pose by pose, with their files: ");
    ASSERT_NE(table, std::string::npos);
    EXPECT_THAT(said.substr(table),
                MatchesRegex("[^\n]*: [0-9.]+ s\n"
                             "  frame 1: [0-9.]+ s; baked whole\n"
                             "  frame 2: [0-9.]+ s; [0-9.]+ % of covered texels traced again\n"
                             "  frame 3: [0-9.]+ s; [0-9.]+ % of covered texels traced again\n"));
    for (const int frame : { 2, 3 }) {
        const std::string pose = said.substr(said.find(format("frame {}: pose: ", frame)));
        const std::string text = pose.substr(0, pose.find(" % of the texels are traced again"));
        EXPECT_THAT(
            said.substr(table),
            ContainsRegex(format("frame {}: [0-9.]+ s; {} % of covered", frame, text.substr(text.rfind(' ') + 1))));
    }
    EXPECT_THAT(
        done(std::string("makevismap lid.####.obj --frames 1-2 --explain --effects +poses -o vm.####.exr") + kFlags),
        ContainsRegex("  frame 1: [0-9.]+ s; baked whole\n  frame 2: [0-9.]+ s; baked whole\n"));
    EXPECT_THAT(
        done(std::string("makevismap lid.0001.obj --pose lid.0002.obj --explain -o vm.exr") + kFlags),
        ContainsRegex("took, pose by pose[^\n]*\n  lid.0002.obj: compared in [0-9.]+ s; [1-9][0-9]* texels looked at"));
    EXPECT_THAT(done(std::string("makevismap lid.0001.obj --pose lid.0002.obj -o vm.exr") + kFlags),
                Not(HasSubstr("took")));
    EXPECT_THAT(done(std::string("makevismap lid.0001.obj --explain -o vm.exr") + kFlags),
                HasSubstr("one pose is given"));
}

TEST_F(Poses, AFrameOfAnotherMeshIsBakedWhole)
{
    write("lid.0002.obj", lidded(0) + "f 1/1 2/2 3/3\n");
    EXPECT_THAT(done(std::string("makevismap lid.####.obj --frames 1-2 -o vm.####.exr") + kFlags),
                HasSubstr("frame 2: pose: \"lid.0002.obj\" has 14 triangles, "
                          "and \"lid.0001.obj\" has 13: poses have the same triangles"));
    done(std::string("makevismap lid.0002.obj -o alone.exr") + kFlags);
    EXPECT_EQ(read("vm.0002.exr"), read("alone.exr"));
    refused(1, "\"lid.0002.obj\" has 14 triangles, and \"lid.0001.obj\" has 13",
            std::string("makevismap lid.0001.obj --pose lid.0002.obj -o x.exr") + kFlags);
}

TEST_F(Poses, WhatMakesNoSenseIsRefused)
{
    const std::string bake = "makevismap lid.####.obj -o x.####.exr ";
    refused(2, "3 frames need #### in the file name", "makevismap lid.####.obj --frames 1-3 -o x.exr");
    refused(2, "give only one of --frames and --pose", bake + "--frames 1-2 --pose lid.0001.obj");
    refused(2, "--pose-error is for several poses", "makevismap lid.0001.obj -o x.exr --pose-error 0.1");
    refused(2, "--pose-error: 2 is not in [0, 1]", bake + "--frames 1-2 --pose-error 2");
    refused(2, "--time-budget is for one map", bake + "--frames 1-2 --time-budget 1");
    refused(2, "is the same in all frames", "makevismap lid.0001.obj --frames 1-2 -o x.####.exr");
    refused(2, "--write-mesh writes one mesh", bake + "--frames 1-2 --write-mesh x.glb");
    refused(2, "--unwrap would give each pose UVs of its own", bake + "--frames 1-2 --unwrap");
    refused(2, "--frames cannot be saved in a recipe", bake + "--frames 1-2 --print-recipe");
    refused(1, "\"lid.0007.obj\": no such file", bake + "--frames 1,7");
    EXPECT_FALSE(exists("x.0001.exr")) << "before any is baked";
    write("nan.obj", lidded(0, "nan"));
    refused(1, "\"nan.obj\"", std::string("makevismap lid.0001.obj --pose nan.obj -o x.exr") + kFlags);
}

#if !VMLIGHT_HAS_ALEMBIC
TEST_F(Poses, FramesOfAnAlembicFileThatIsNotReadSayWhatToDo)
{
    write("walk.abc", std::string("Ogawa\xff\0\1\x10\0\0\0\0\0\0\0", 16) + std::string(8, '\0'));
    refused(1, "OBJ or PLY, a file for each frame", "makevismap walk.abc --frames 1-2 -o x.#.exr");
}
#endif
