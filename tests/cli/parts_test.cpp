// SPDX-License-Identifier: Apache-2.0
// Maps in parts: makevismap --part, --join and --resume.
#include "command_test.h"

#include <vmlight/base/format.h>

#include <OpenImageIO/imagebufalgo.h>

#include <filesystem>

using namespace vmlight;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

namespace {

class MapFiles : public CommandTest
{
protected:
    const std::string bake = "makevismap {spot} --resolution 200 --samples 4 ";

    std::string joined(const std::string& start, const std::string& output, const std::string& flags = "") const
    {
        std::string line = "makevismap --join ";
        for (const std::string& name : names(start))
            line += name + " ";
        return done(line + "-o " + output + " " + flags);
    }
    // The bytes of `vm.exr` baked with `flags` at once, and in parts that are joined.
    void expect_same(const std::string& mesh, const std::string& flags) const
    {
        done("makevismap " + mesh + " -o whole.exr " + flags);
        done("makevismap " + mesh + " -o vm.exr --part 1,3/3 " + flags);
        done("makevismap " + mesh + " -o vm.exr --part 2/3 " + flags);
        joined("vm.part", "vm.exr");
        EXPECT_TRUE(read("vm.exr") == read("whole.exr")) << flags;
    }
};

} // namespace

TEST_F(MapFiles, JoinedTheyAreTheBytesOfOneBake)
{
    done(bake + "-o whole.exr");
    for (const int count : { 1, 2, 16 }) {
        for (int part = 1; part <= count; ++part)
            done(bake + format("-o vm.exr --part {}/{}", part, count));
        EXPECT_THAT(joined("vm.part", "vm.exr"), HasSubstr(" to 200x200 texels"));
        EXPECT_TRUE(read("vm.exr") == read("whole.exr")) << count;
        for (const std::string& name : names("vm.part"))
            remove(name);
    }
    // A list of parts, on another number of threads; the shell may sort them as it likes.
    EXPECT_THAT(done(bake + "-o vm.exr --part 1-3,12-16/16 --threads 1"),
                HasSubstr("part: 3/16 in \"vm.part03of16.exr\"\n"));
    done(bake + "-o vm.exr --part 4-11/16");
    EXPECT_THAT(names("vm.part").front(), "vm.part01of16.exr");
    std::filesystem::rename("vm.part01of16.exr", "vm.part99.exr");
    joined("vm.part", "other.exr");
    EXPECT_TRUE(read("other.exr") == read("whole.exr"));
    for (const char* name : { "part", "partTiles", "partChannels", "partInputs", "partEmpty" })
        EXPECT_EQ(attribute("other.exr", format("vmlight:{}", name)), "") << name;
}

TEST_F(MapFiles, WhateverIsBaked)
{
    write("lid.obj", "v -9 3 -9\nv 9 3 -9\nv 0 3 9\nf 1 2 3\n");
    OIIO::ImageBuf normals(OIIO::ImageSpec(64, 64, 3, OIIO::TypeUInt8));
    const float lean[] = { .6f, .5f, .9f };
    OIIO::ImageBufAlgo::fill(normals, lean);
    ASSERT_TRUE(normals.write(path("normals.png"))) << normals.geterror();
    const std::string spot = "{spot}", size = "--resolution 150 --samples 4 ";
    expect_same(spot, size + "--occluder lid.obj --channels normal,error --margin infinite --seed 3");
    expect_same(spot, "--resolution 150 --target-error 0.1");
    expect_same(spot, size + "--reconstruct auto --basis sh --channels coverage");
    expect_same(spot, size + "--normal-map normals.png --basis cells");
    expect_same(spot, size + "--unwrap --sun-directions 0,1,0,5 --effects -self-occlusion");
    write("card.mtl", "newmtl Glass\nd 0.25\nnewmtl Stone\n");
    write("card.obj",
          "mtllib card.mtl\nusemtl Stone\n" + kQuad
              + "usemtl Glass\nv -9 -9 1\nv 9 -9 1\nv 9 9 1\nv -9 9 1\nf 5/1/1 6/2/1 7/3/1 8/4/1\n");
    expect_same("card.obj", size + "--material Stone");
}

TEST_F(MapFiles, StrandsAreBakedWhole)
{
    write("hair.obj", "v 0 0 0\nv 0 1 .5\nv 0 3 0\nl 1 2 3\n");
    for (const char* flag : { "--part 1/4", "--part 1-4/4", "--resume" })
        refused(2, "\"hair.obj\" has strands: --part and --resume only work for meshes",
                std::string("makevismap hair.obj --radius .1 -o a.exr ") + flag);
    EXPECT_THAT(names("a."), ElementsAre());
}

TEST_F(MapFiles, HalfIsForTheWhole)
{
    done(bake + "-o whole.exr --format half");
    done(bake + "-o vm.exr --part 1-2/2");
    joined("vm.part", "vm.exr", "--format half --threads 1");
    EXPECT_TRUE(read("vm.exr") == read("whole.exr"));
    refused(2, "--part: parts are float", bake + "-o vm.exr --part 1/2 --format half");
    done(bake + "-o resumed.exr --resume --format half");
    EXPECT_TRUE(read("resumed.exr") == read("whole.exr"));
    EXPECT_THAT(names("resumed"), ElementsAre("resumed.exr"));
}

TEST_F(MapFiles, EachTileAndMaterialIsDivided)
{
    const std::string quads = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 1 -1 2\nv 1 1 2\n"
                              "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 2 0\nvt 2 1\nusemtl Floor\nf 1/1 2/2 3/3 4/4\n"
                              "usemtl Wall\nf 2/2 5/5 6/6 3/3\n";
    write("hero.obj", quads);
    const std::string flags = " --resolution 100 --samples 4 ";
    done("makevismap hero.obj -o whole.<UDIM>.exr" + flags);
    for (const char* part : { "1", "2,3" })
        done(format("makevismap hero.obj -o vm.<UDIM>.exr --part {}/3", part) + flags);
    EXPECT_EQ(names("vm.").size(), 6u);
    EXPECT_EQ(names("vm.1002")[0], "vm.1002.part1of3.exr");
    joined("vm.", "vm.<UDIM>.exr");
    for (const int udim : { 1001, 1002 })
        EXPECT_TRUE(read(format("vm.{}.exr", udim)) == read(format("whole.{}.exr", udim))) << udim;
    std::string parts;
    for (const std::string& name : names("vm.1"))
        parts += name.size() > 12 ? name + " " : "";
    refused(1, "the parts are of tiles 1001 and 1002, which need <UDIM> in the file name",
            "makevismap --join " + parts + "-o x.exr");

    done("makevismap hero.obj -o 'all_<MATERIAL>.<UDIM>.exr'" + flags);
    done("makevismap hero.obj -o 'm_<MATERIAL>.<UDIM>.exr' --part 1-2/2" + flags);
    joined("m_", "m_<MATERIAL>.<UDIM>.exr");
    for (const char* name : { "Floor.1001", "Wall.1002" })
        EXPECT_TRUE(read(format("m_{}.exr", name)) == read(format("all_{}.exr", name))) << name;
    // A bake of all of them can be resumed too, and leaves nothing else behind.
    done("makevismap hero.obj -o r.<UDIM>.exr --resume" + flags);
    EXPECT_THAT(names("r."), ElementsAre("r.1001.exr", "r.1002.exr"));
    EXPECT_TRUE(read("r.1002.exr") == read("whole.1002.exr"));
}

TEST_F(MapFiles, WhatIsMissingOrDoesNotFitIsNamed)
{
    done(bake + "-o vm.exr --part 1-8/8");
    done(bake + "-o seed.exr --part 3/8 --seed 1");
    done(bake + "-o few.exr --part 1/4");
    write("quad.obj", kQuad);
    done("makevismap quad.obj -o quad.exr --resolution 200 --samples 4 --part 3/8");
    done(bake + "-o whole.exr");
    write("text.exr", "no image");
    const auto join = [&](const std::string& more, const std::string& without) {
        std::string line = "makevismap --join ";
        for (const std::string& name : names("vm.part"))
            line += without.find(name[7]) == std::string::npos ? name + " " : "";
        return line + more + " -o x.exr";
    };
    refused(1, "\"vm.part1of8.exr\": parts 2, 4-6 of 8 are missing", join("", "2456"));
    refused(1, "\"vm.part1of8.exr\": part 8 of 8 is missing", join("", "8"));
    refused(1, "\"seed.part3of8.exr\" does not fit \"vm.part1of8.exr\": seed is 1, not 0",
            join("seed.part3of8.exr", "3"));
    refused(1, "\"quad.part3of8.exr\" does not fit \"vm.part1of8.exr\": mesh", join("quad.part3of8.exr", "3"));
    refused(1, "\"few.part1of4.exr\" is part 1/4, but \"vm.part1of8.exr\" is of 8 parts", join("few.part1of4.exr", ""));
    refused(1, "\"vm.part3of8.exr\" and \"vm.part3of8.exr\" are both part 3/8", join("vm.part3of8.exr", ""));
    refused(1, "\"whole.exr\": not a part of a visibility map: its vmlight:stage is \"vismap\"", join("whole.exr", ""));
    refused(1, "\"text.exr\": ", join("text.exr", ""));
    refused(1, "\"gone.exr\": no such file", join("gone.exr", ""));
    // Damaged beyond its header.
    std::string bytes = read("vm.part4of8.exr");
    std::fill(bytes.end() - long(bytes.size() / 2), bytes.end(), '\0');
    write("vm.part4of8.exr", bytes);
    write("x.exr", "the map of yesterday");
    refused(1, "\"vm.part4of8.exr\": ", join("", ""));
    EXPECT_EQ(read("x.exr"), "the map of yesterday");
    make_sky({ 1, 1, 1 });
    refused(1, "vismap part", "makelightmap vm.part1of8.exr sky.exr -o x.exr");
}

// Its metadata have the name alone.
TEST_F(MapFiles, ANormalMapOfTheSameNameMustBeTheSame)
{
    const auto write_normals = [&](float x) {
        OIIO::ImageBuf image(OIIO::ImageSpec(16, 16, 3, OIIO::TypeUInt8));
        const float normal[] = { x, .5f, .9f };
        OIIO::ImageBufAlgo::fill(image, normal);
        EXPECT_TRUE(image.write(path("fresh.png"))) << image.geterror();
        std::filesystem::rename("fresh.png", "normals.png");
    };
    const std::string bake_normals = bake + "--normal-map normals.png -o vm.exr ";
    write_normals(.6f);
    done(bake_normals + "--part 1/2");
    write_normals(.7f);
    done(bake_normals + "--part 2/2");
    refused(1, "\"vm.part2of2.exr\" does not fit \"vm.part1of2.exr\": hash of the textures is ",
            "makevismap --join vm.part1of2.exr vm.part2of2.exr -o x.exr");
    EXPECT_THAT(done(bake_normals + "--part 1-2/2 --resume"), HasSubstr("resume: 1 of 2 parts was there already"));
}

TEST_F(MapFiles, ABakeGoesOnWhereItWasKilled)
{
    done(bake + "-o whole.exr");
    EXPECT_THAT(done(bake + "-o vm.exr --part 1-8/8 --resume"), HasSubstr("resume: 0 of 8 parts were there already"));
    std::string damaged = read("vm.part5of8.exr");
    std::fill(damaged.end() - long(damaged.size() / 2), damaged.end(), '\0');
    write("vm.part5of8.exr", damaged);
    remove("vm.part2of8.exr");
    done("makevismap {spot} --resolution 200 --samples 5 -o vm.exr --part 7/8"); // other parameters
    const std::string kept = read("vm.part1of8.exr");
    EXPECT_THAT(done(bake + "-o vm.exr --part 1-8/8 --resume"), HasSubstr("resume: 5 of 8 parts were there already"));
    EXPECT_TRUE(read("vm.part1of8.exr") == kept);
    joined("vm.part", "vm.exr");
    EXPECT_TRUE(read("vm.exr") == read("whole.exr"));

    // As a killed --resume leaves it: some of its own parts.
    done(bake + "-o vm.exr --part 1-6/16");
    for (int part = 1; part <= 6; ++part)
        std::filesystem::rename(format("vm.part{:02d}of16.exr", part), format("on.resume{:02d}of16.exr", part));
    const std::string said = done(bake + "-o on.exr --resume");
    EXPECT_THAT(said, HasSubstr("resume: 6 of 16 parts were there already"));
    EXPECT_THAT(names("on"), ElementsAre("on.exr"));
    EXPECT_TRUE(read("on.exr") == read("whole.exr"));
}

TEST_F(MapFiles, WhatMakesNoSenseIsRefused)
{
    write("quad.obj", kQuad);
    for (const char* flag : { "--part 1/2", "--resume" }) {
        const std::string line = format("makevismap quad.obj -o x.exr {} ", flag);
        refused(2, "a --time-budget depends on the machine", line + "--time-budget 1");
        refused(2, "is for one pose: of several, each keeps texels of those before", line + "--pose quad.obj");
        refused(2, "--dry-run is about the whole map", line + "--dry-run");
        refused(2, "--explain counts what a whole bake takes", line + "--explain");
        refused(2, "cannot be saved in a recipe", format("makevismap quad.obj -o x.vismap {}", flag));
        write("walk.1.obj", kQuad);
        write("walk.2.obj", kQuad);
        refused(2, "is for one pose", format("makevismap walk.#.obj --frames 1-2 -o x.#.exr {}", flag));
    }
    done("makevismap walk.#.obj --frames 2 -o walk.#.exr --resolution 8 --part 1/1");
    EXPECT_THAT(names("walk.2.p"), ElementsAre("walk.2.part1of1.exr"));
    refused(2, "part: \"5/4\": parts are numbered from 1 to 4", "makevismap quad.obj -o x.exr --part 5/4");
    refused(2, "-o OUTPUT.exr is missing", "makevismap quad.obj --part 1/4");
    refused(2, "PART.exr is missing", "makevismap --join -o x.exr");
    refused(2, "-o OUTPUT.exr is missing", "makevismap --join a.exr");
    refused(2, "output must be .exr", "makevismap --join a.exr -o x.vismap");
    for (const char* flag : { "--samples 4", "--print-recipe", "--udim 1001", "--part 1/2", "--resume", "--list" })
        refused(2, "the parts are baked already", format("makevismap --join a.exr -o x.exr {}", flag));
}
