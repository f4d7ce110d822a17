// SPDX-License-Identifier: Apache-2.0
// --explain, --dry-run, --effects and --ground.
#include "command_test.h"

#include <vmlight/base/work_counts.h>
#include <vmlight/stage/open_source.h>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

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
        HasSubstr("makevismap WARNING: --effects: occluders \"over.obj\", ground switched off, which changes this "
                  "scene: V is off by about 0."));
    expect_same_pixels("off.exr", "bare.exr", 0);
    EXPECT_EQ(attribute("off.exr", "vmlight:effects"), "-occluders,-ground");
    EXPECT_LT(visibility("full.exr").least(), visibility("off.exr").least());
    // Nothing is missing where the scene does not call for it.
    EXPECT_THAT(bake("a.exr", "--occluder under.obj --effects -occluders"), Not(HasSubstr("WARNING")));
}

TEST_F(Effects, TheImpossibleIsRefused)
{
    const std::string command = std::string(kBake) + "x.exr --effects ";
    refused(2, "effects: +ground is impossible: no --ground is given", command + "+ground");
    refused(2, "effects: -udim: cannot be left out", command + "-udim --udim 1001");
    refused(2, "effects: +cut-outs is impossible: cutouts is off", command + "+cut-outs --cutouts off");
    refused(1, "effects: +cut-outs is impossible: no material has an opacity below 1", command + "+cut-outs");
    refused(1, "effects: -half: cannot be left out: --format half", command + "-half --format half");
    done(command + "-half,-udim,-poses"); // not asked for
    remove("x.exr");
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
    EXPECT_THAT(said, Not(HasSubstr("expected in all")));
    refused(2, "--dry-run cannot be saved in a recipe", std::string(kBake) + "x.exr --dry-run --print-recipe");
}

TEST_F(Effects, ADryRunNeedsNoOutput)
{
    const std::string line = "makevismap quad.obj --resolution 16 --samples 16 ";
    const size_t files = names().size();
    EXPECT_THAT(done(line + "--dry-run"), testing::ContainsRegex("effects:(.|\n)*expected: "));
    EXPECT_THAT(done(line + "--dry-run --pose quad.obj"), HasSubstr("comparing 1 other pose comes on top"));
    write("quad.1001.obj", kQuad);
    write("quad.1002.obj", kQuad);
    const std::string tiles = "makevismap 'quad.<UDIM>.obj' --resolution 16 --samples 16 ";
    EXPECT_THAT(done(tiles + "--dry-run"), testing::AllOf(HasSubstr("tile 1002: "), HasSubstr("expected in all")));
    EXPECT_THAT(done(tiles + "--dry-run --udims 1001-1002"), HasSubstr("tile 1002: "));
    EXPECT_THAT(done(tiles + "--dry-run --udim 1002"), Not(HasSubstr("1001")));
    EXPECT_EQ(names().size(), files + 2) << "nothing is written";
    refused(2, "-o OUTPUT.exr is missing", line + "--explain");
}

TEST_F(Effects, QuietPrintsWhatIsAskedFor)
{
    const std::string said = bake("a.exr", "--explain --quiet");
    EXPECT_THAT(said, testing::AllOf(HasSubstr("effects:"), HasSubstr("took: "), Not(HasSubstr("bake: "))));
    EXPECT_THAT(bake("a.exr", "--dry-run --quiet"), testing::AllOf(HasSubstr("effects:"), HasSubstr("expected: ")));
    EXPECT_EQ(bake("a.exr", "--quiet"), "");
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
    refused(2, "--ground: \"up\" is not a number", std::string(kBake) + "x.exr --ground=up");
}

// Of a mesh that occludes itself: a floor, and a wall on it.
TEST_F(Effects, SelfOcclusionThatIsLeftOutIsMissed)
{
    write("corner.obj",
          "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv -1 2 -1\nv 1 2 -1\n"
          "vt 0 0\nvt 0.4 0\nvt 0.4 0.9\nvt 0 0.9\nvt 0.5 0\nvt 0.9 0\nvt 0.9 0.9\nvt 0.5 0.9\n"
          "f 4/1 3/2 2/3 1/4\nf 1/5 2/6 6/7 5/8\n");
    const std::string line = "makevismap corner.obj --resolution 32 --samples 64 -o a.exr --effects ";
    const int64_t built = work_counts().scenes_built;
    const std::string said = done(line + "-self-occlusion --explain");
    EXPECT_THAT(said,
                testing::ContainsRegex("self-occlusion +switched off +- +4 triangles, blocked|"
                                       "self-occlusion +switched off +- +something rises above"));
    EXPECT_THAT(said,
                testing::ContainsRegex("WARNING: --effects: self-occlusion switched off, which changes this scene: V "
                                       "is off by about 0\\.[0-9]*[1-9]"));
    EXPECT_EQ(work_counts().scenes_built - built, 2) << "the facts and the comparison share a scene";
    EXPECT_EQ(visibility("a.exr").least(), 1);
    // Of an open mesh nothing is missing.
    EXPECT_THAT(bake("a.exr", "--effects -self-occlusion"), Not(HasSubstr("WARNING")));
}

TEST_F(Effects, WhatDoesNotChangeVIsNoWarning)
{
    EXPECT_THAT(bake("a.exr", "--effects -margin --margin 4"), Not(HasSubstr("WARNING")));
    OIIO::ImageBuf flat(OIIO::ImageSpec(4, 4, 3, OIIO::TypeUInt8));
    OIIO::ImageBufAlgo::fill(flat, { 0.5f, 0.5f, 1.0f });
    ASSERT_TRUE(flat.write("flat.png"));
    const std::string said = bake("a.exr", "--explain --normal-map flat.png --effects -normal-map");
    EXPECT_THAT(said, testing::ContainsRegex("normal-map +off +- +it is flat"));
    EXPECT_THAT(said, Not(HasSubstr("WARNING")));
    EXPECT_THAT(bake("a.exr", "--explain --normal-map flat.png --effects +normal-map"),
                testing::ContainsRegex("normal-map +off +- +it is flat"));
}

TEST_F(Effects, AGroundIsJudgedByTheRaysThatAreTraced)
{
    const std::string said = bake("a.exr", "--explain --ground -5 --max-distance 1 --effects -max-distance");
    EXPECT_THAT(said, testing::ContainsRegex("ground +on .*the plane y = -5 is 4 below the mesh; no ray is traced"));
    EXPECT_THAT(said, testing::ContainsRegex("max-distance +switched off +- +rays end after 1, and"));
    EXPECT_THAT(bake("a.exr", "--explain --ground -5 --max-distance 1"),
                testing::ContainsRegex("ground +off .*, and rays reach 1"));
    // What faces straight up sees no ground, at whatever depth.
    write("floor.obj", "v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n");
    const std::string floor = "makevismap floor.obj --resolution 16 --samples 16 -o ";
    EXPECT_THAT(done(floor + "a.exr --ground -1 --explain"),
                testing::ContainsRegex("ground +off .*is 1 below the mesh, and every texel faces straight up"));
    EXPECT_THAT(done(floor + "b.exr --ground -1 --effects -ground"), Not(HasSubstr("WARNING")));
    expect_same_pixels("a.exr", "b.exr", 1e-6f);
    EXPECT_THAT(done(floor + "a.exr --ground 1 --explain"), testing::ContainsRegex("ground +on "));
}

TEST_F(Effects, TrianglesWithoutTexelsAreNotCounted)
{
    // Two that face up, one without area, one without UVs, and one in another tile.
    write("mixed.obj",
          "v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nv 3 0 1\nv 3 0 -1\n"
          "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 2 0\nvt 2 1\n"
          "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\nf 1/1 2/2 2/3\nf 5 6 2\nf 2/2 5/5 6/6\n");
    for (const char* tile : { "1001", "1002" }) {
        const std::string said
            = done(std::string("makevismap mixed.obj --resolution 16 --samples 16 --explain -o a.exr --udim ") + tile);
        EXPECT_THAT(said, HasSubstr("nothing rises above the tangent plane of any of 3 triangles"));
        EXPECT_THAT(said, HasSubstr("bake: 0.00 M rays"));
    }
}

TEST_F(Effects, ReconstructionIsOffWhereItIsUnsoundAndSaidToBe)
{
    const std::string scene = "--explain --occluder over.obj --margin 0 ";
    EXPECT_THAT(
        bake("auto.exr", scene),
        testing::AllOf(testing::ContainsRegex("reconstruction +on +[0-9<]+ [^ ]* *each of 256 texels is averaged "
                                              "with those of the 48 around it that see the same"),
                       HasSubstr("  reconstruction: 0.000 M texels")));
    EXPECT_EQ(attribute("auto.exr", "vmlight:reconstruct"), "auto");
    EXPECT_EQ(attribute("auto.exr", "vmlight:no_reconstruct"), "");
    write("mask.vismap", "mesh = \"quad.obj\"\nresolution = 16\nbasis = \"mask\"\n");
    EXPECT_THAT(
        done("makevismap mask.vismap --explain -o mask.exr"),
        testing::ContainsRegex("reconstruction +off +- +what the basis mask packs of each ray has no mean: each "
                               "of 256 texels has what its own rays see"));
    EXPECT_EQ(attribute("mask.exr", "vmlight:reconstruct"), "");
    EXPECT_EQ(attribute("mask.exr", "vmlight:no_reconstruct"), "what the basis mask packs of each ray has no mean");
    EXPECT_THAT(bake("off.exr", scene + "--reconstruct off"),
                testing::ContainsRegex("reconstruction +off +- +reconstruct is off: each of 256 texels"));
    EXPECT_EQ(attribute("off.exr", "vmlight:reconstruct") + attribute("off.exr", "vmlight:no_reconstruct"), "");
    EXPECT_THAT(bake("switched.exr", scene + "--effects -reconstruction"),
                testing::AllOf(testing::ContainsRegex("reconstruction +switched off"), Not(HasSubstr("WARNING"))));
    EXPECT_EQ(attribute("switched.exr", "vmlight:effects"), "-reconstruction");
    expect_same_pixels("switched.exr", "off.exr", 0);
    refused(2, "effects: +reconstruction is impossible: reconstruct is off",
            std::string(kBake) + "x.exr --reconstruct off --effects +reconstruction");
}

// The same flags in a recipe, by the tool and by a reader.
TEST_F(Effects, ARecipeIsRefusedByWhoeverOpensIt)
{
    const auto opened = [&](const std::string& effects) {
        write("x.vismap", "mesh = \"quad.obj\"\nresolution = 16\nsamples = 16\neffects = \"" + effects + "\"\n");
        VismapRecipe recipe;
        std::string error;
        EXPECT_TRUE(read_recipe(recipe, "x.vismap", error)) << error;
        const PixelSourcePointer source = open_source(recipe, error, { "x.vismap" }, Sharing::none);
        std::vector<float> pixels(16 * 16 * 4);
        if (source)
            source->read({ 0, 16, 0, 16 }, pixels.data(), error);
        return error;
    };
    EXPECT_THAT(opened("+ground"), HasSubstr("+ground is impossible: no --ground is given"));
    EXPECT_THAT(opened("+cut-outs"), HasSubstr("+cut-outs is impossible: no material has an opacity below 1"));
    EXPECT_EQ(opened("-margin,+self-occlusion"), "");
    write("x.vismap", "mesh = \"quad.obj\"\neffects = \"+ground\"\n");
    refused(1, "line 2: effects: +ground is impossible", "makevismap x.vismap -o x.exr");
}

TEST_F(Effects, ADryRunOfTilesAndPosesAddsThemUp)
{
    write("two.obj", kQuad + "vt 1 0\nvt 2 0\nvt 2 1\nvt 1 1\nf 1/5/1 2/6/1 3/7/1 4/8/1\n");
    const std::string tiles = done("makevismap two.obj --resolution 16 --samples 16 -o 'a.<UDIM>.exr' --dry-run");
    EXPECT_EQ(count(tiles, "expected: "), 2u);
    EXPECT_EQ(count(tiles, "expected in all: "), 1u);
    EXPECT_THAT(tiles, testing::ContainsRegex("tile 1002: expected: [0-9.]+ s: start 0.00 s,"));
    write("quad.0001.obj", kQuad);
    write("quad.0002.obj", kQuad);
    EXPECT_THAT(done("makevismap quad.####.obj --frames 1-2 --resolution 16 -o a.####.exr --dry-run"),
                testing::ContainsRegex("expected: at most .*; each of 2 poses baked whole"));
    EXPECT_THAT(bake("a.exr", "--pose quad.0001.obj --dry-run"), HasSubstr("; comparing 1 other pose comes on top"));
}

TEST_F(Effects, StrandsAmongTheOccludersAreSaidToBe)
{
    write("hair.obj", "v -1 0 1\nv 1 0 1\nl 1 2\n");
    const std::string said = bake("a.exr", "--explain --occluder hair.obj --radius .1");
    EXPECT_THAT(said, HasSubstr("1 strand, 0.9 away, may rise above the horizon of a texel"));
    EXPECT_LT(visibility("a.exr").least(), 1);
    EXPECT_THAT(done("makevismap quad.obj --dry-run --occluder hair.obj --radius .1"), HasSubstr("1 strand, 0.9 away"));
    EXPECT_THAT(bake("a.exr", "--explain --occluder hair.obj --radius .1 --max-distance .5"),
                HasSubstr("1 strand, 0.9 away, and rays reach 0.5"));
}
