// SPDX-License-Identifier: Apache-2.0
// --explain, --dry-run, --effects and --ground.
#include "command_test.h"

using namespace vmlight;
using testing::HasSubstr;
using testing::Not;

namespace {

class Effects : public CommandTest
{
protected:
    void SetUp() override
    {
        write("quad.obj", kQuad);
        // Above the quad, and below it.
        write("over.obj", "v -1 -1 1\nv 0 -1 1\nv 0 1 1\nf 1 2 3\n");
        write("under.obj", "v -1 -1 -1\nv 0 -1 -1\nv 0 1 -1\nf 1 2 3\n");
    }
    static constexpr const char* kBake = "makevismap quad.obj --resolution 16 --samples 16 -o ";
    std::string bake(const std::string& name, const std::string& flags) const
    {
        return done(kBake + name + " " + flags);
    }
    bool same_bytes(const std::string& a, const std::string& b) const { return read(a) == read(b); }
};

} // namespace

TEST_F(Effects, ExplainSaysWhatTheSceneCallsForAndWhatItTook)
{
    const std::string said = bake("a.exr", "--explain --occluder over.obj --occluder under.obj --margin 0");
    EXPECT_THAT(said, HasSubstr("self-occlusion         on"));
    EXPECT_THAT(said, HasSubstr("may rise above the horizon of a texel"));
    EXPECT_THAT(said, HasSubstr("1 triangle, all below the tangent plane of each of 2 triangles"));
    EXPECT_THAT(said, HasSubstr("no margin is asked for"));
    EXPECT_LT(said.find("effects:"), said.find("bake:"));
    EXPECT_GT(said.find("took:"), said.find("bake:"));
    EXPECT_THAT(bake("a.exr", ""), Not(HasSubstr("effects")));
}

TEST_F(Effects, AnOpenMeshTracesNoRay)
{
    EXPECT_THAT(bake("a.exr", ""), HasSubstr("bake: 0.00 M rays"));
    EXPECT_THAT(bake("a.exr", "--explain"), HasSubstr("100.0 % of covered texels traced none"));
    EXPECT_THAT(bake("a.exr", "--explain --effects +self-occlusion"),
                testing::AllOf(HasSubstr("forced on"), HasSubstr("took: 0.00 M rays (16.0 per covered texel)")));
}

TEST_F(Effects, AutoAndAllAreTheSameFile)
{
    const std::string scene = "--occluder over.obj --occluder under.obj --max-distance 1.5 --ground -0.5 ";
    bake("auto.exr", scene);
    bake("explained.exr", scene + "--explain");
    bake("all.exr", scene + "--effects all");
    EXPECT_TRUE(same_bytes("auto.exr", "explained.exr"));
    EXPECT_TRUE(same_bytes("auto.exr", "all.exr"));
    EXPECT_EQ(attribute("auto.exr", "vmlight:effects"), "");
}

TEST_F(Effects, WhatIsSwitchedOffIsGoneAndSaidToBe)
{
    bake("bare.exr", "");
    bake("full.exr", "--occluder over.obj --ground 0");
    const std::string said = bake("off.exr", "--occluder over.obj --ground 0 --effects -ground,-occluders");
    EXPECT_THAT(
        said,
        HasSubstr("makevismap WARNING: effects: the scene calls for occluders \"over.obj\", ground, left out: V "
                  "is off by about 0."));
    expect_same_pixels("off.exr", "bare.exr", 0);
    EXPECT_EQ(attribute("off.exr", "vmlight:effects"), "-occluders,-ground");
    EXPECT_LT(visibility("full.exr").least(), visibility("off.exr").least());
    // Nothing is missing where the scene does not call for it.
    EXPECT_THAT(bake("a.exr", "--occluder under.obj --effects -occluders"), Not(HasSubstr("WARNING")));
}

TEST_F(Effects, TheImpossibleIsRefused)
{
    refused(1, "effects: +ground is impossible: no --ground is given", std::string(kBake) + "x.exr --effects +ground");
    refused(1, "effects: -udim: cannot be left out", std::string(kBake) + "x.exr --effects -udim");
    refused(2, "effects: \"gruond\" is not an effect: did you mean \"ground\"?",
            std::string(kBake) + "x.exr --effects -gruond");
    refused(2, "--ground-height 1: no ground is given", std::string(kBake) + "x.exr --ground-height 1");
    write("x.vismap", "mesh = \"quad.obj\"\neffects = \"-sun\"\n");
    refused(1, "effects: \"sun\" is not an effect", "makevismap x.vismap -o x.exr");
}

TEST_F(Effects, ADryRunBakesNothing)
{
    const std::string said = bake("a.exr", "--dry-run --occluder over.obj");
    EXPECT_THAT(
        said, testing::ContainsRegex("expected: [0-9.]+ s: start [0-9.]+ s, read and build [0-9.]+ s, bake [0-9.]+ s"));
    EXPECT_THAT(said, HasSubstr("MB of memory"));
    EXPECT_FALSE(exists("a.exr"));
    refused(2, "--dry-run cannot be saved in a recipe", std::string(kBake) + "x.exr --dry-run --print-recipe");
}

TEST_F(Effects, TheGroundIsAtAHeightOrAtTheLowestPoint)
{
    bake("lowest.exr", "--ground");
    bake("given.exr", "--ground -1");
    bake("equals.exr", "--ground=-1");
    bake("far.exr", "--ground -5 --max-distance 2");
    expect_same_pixels("lowest.exr", "given.exr", 0);
    EXPECT_TRUE(same_bytes("given.exr", "equals.exr"));
    EXPECT_FLOAT_EQ(visibility("lowest.exr").greatest(), 0.5f); // a wall on the ground
    EXPECT_EQ(visibility("far.exr").least(), 1);
    EXPECT_EQ(attribute("given.exr", "vmlight:ground_height"), "-1");
    write("x.vismap", done(std::string(kBake) + "x.exr --ground -1 --print-recipe"));
    EXPECT_THAT(read("x.vismap"), testing::AllOf(HasSubstr("ground = true"), HasSubstr("ground_height = -1")));
    done("makevismap x.vismap -o recipe.exr");
    expect_same_pixels("recipe.exr", "given.exr", 0);
    refused(2, "ground_height: \"up\" is not a number", std::string(kBake) + "x.exr --ground=up");
}
