// SPDX-License-Identifier: Apache-2.0
// UDIM tiles on the command line.
#include "command_test.h"

#include <vmlight/base/format.h>

#include <filesystem>

using namespace vmlight;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

namespace {

/// A floor in tile 1001, a wall in 1002, and a lid in 1011.
class Tiles : public CommandTest
{
protected:
    struct Corner
    {
        double u, v;
    };
    const std::string small = " --resolution 32 --samples 16 ";

    void SetUp() override
    {
        write_mesh("hero.obj", { { 0, 0 }, { 1, 0 }, { 0, 1 } });
        make_sky({ 1, 2, 3 });
    }
    void write_mesh(const std::string& name, const std::vector<Corner>& places) const
    {
        std::string text = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 1 -1 2\nv 1 1 2\nv -1 -1 2\nv -1 1 2\n";
        for (const auto& [u, v] : places)
            for (const auto& [x, y] : { Corner { .125, .125 }, { .875, .125 }, { .875, .75 }, { .125, .75 } })
                text += format("vt {} {}\n", x + u, y + v);
        write(name,
              text
                  + "vn 0 0 1\nvn -1 0 0\nvn 0 0 -1\nf 1/1/1 2/2/1 3/3/1 4/4/1\nf 2/5/2 5/6/2 6/7/2 3/8/2\n"
                    "f 7/9/3 8/10/3 6/11/3 5/12/3\n");
    }
    void bake() const { done("makevismap hero.obj -o vm.<UDIM>.exr" + small); }
};

} // namespace

TEST_F(Tiles, ATileIsTheMapOfTheMeshWithItsUvsMovedThere)
{
    const std::string printed = done("makevismap hero.obj -o vm.<UDIM>.exr" + small);
    EXPECT_THAT(names("vm"), ElementsAre("vm.1001.exr", "vm.1002.exr", "vm.1011.exr"));
    EXPECT_THAT(printed, Not(HasSubstr("WARNING"))) << "triangles of other tiles are no surprise";
    for (const auto& [udim, u, v] : { std::tuple(1001, 0, 0), { 1002, 1, 0 }, { 1011, 0, 1 } }) {
        EXPECT_THAT(printed, HasSubstr(format("tile {}: bake: ", udim)));
        write_mesh("moved.obj", { { 0. - u, 0. - v }, { 1. - u, 0. - v }, { 0. - u, 1. - v } });
        EXPECT_THAT(done("makevismap moved.obj -o moved.exr" + small), HasSubstr("triangles reach outside "));
        expect_same_pixels(format("vm.{}.exr", udim), "moved.exr", 0);
        done(format("makevismap hero.obj -o one.exr --udim {}", udim) + small);
        EXPECT_TRUE(read("one.exr") == read(format("vm.{}.exr", udim))) << udim;
        EXPECT_EQ(attribute("one.exr", "vmlight:udim"), std::to_string(udim));
    }
}

TEST_F(Tiles, AListChoosesTiles)
{
    done("makevismap hero.obj -o vm.<UDIM>.exr --udims 1011,1001-1002" + small);
    EXPECT_THAT(names("vm"), ElementsAre("vm.1001.exr", "vm.1002.exr", "vm.1011.exr"));
    EXPECT_THAT(done("makevismap hero.obj -o empty.<UDIM>.exr --udims=1033" + small),
                HasSubstr("WARNING: tile 1033: no texel centre is covered: the map is empty"));
    done("makevismap hero.obj -o one.<UDIM>.exr --udim=1002" + small);
    EXPECT_THAT(names("one"), ElementsAre("one.1002.exr"));
}

TEST_F(Tiles, TrianglesAcrossABorderOrOutsideAllTilesAreWarnedAbout)
{
    write_mesh("odd.obj", { { 0, 0 }, { 1.5, 0 }, { -3, 0 } });
    const std::string printed = done("makevismap odd.obj -o vm.<UDIM>.exr" + small);
    EXPECT_THAT(names("vm"), ElementsAre("vm.1001.exr", "vm.1002.exr", "vm.1003.exr"));
    EXPECT_THAT(printed, HasSubstr("WARNING: tile 1002: 2 of 6 triangles reach outside tile 1002 in UV"));
    EXPECT_EQ(count(printed, "2 of 6 triangles reach outside all UDIM tiles"), 1u) << "for each tile again";
}

TEST_F(Tiles, ALightmapOfEachTile)
{
    bake();
    remove("vm.1002.exr");
    const std::string printed = done("makelightmap vm.<UDIM>.exr sky.exr -o lit.<UDIM>.exr");
    EXPECT_THAT(names("lit"), ElementsAre("lit.1001.exr", "lit.1011.exr"));
    EXPECT_EQ(count(printed, "filter: "), 1u) << "filtered for each tile";
    for (const std::string udim : { "1001", "1011" }) {
        EXPECT_THAT(printed, HasSubstr("tile " + udim + ": light: 1 map"));
        done("makelightmap vm." + udim + ".exr sky.exr -o one.exr");
        expect_same_pixels("lit." + udim + ".exr", "one.exr", 0);
        done("makelightmap vm.<UDIM>.exr sky.exr -o one.exr --udim " + udim);
        EXPECT_TRUE(read("lit." + udim + ".exr") == read("one.exr")) << udim;
    }
    done("makelightmap vm.<UDIM>.exr sky.exr -o f.<UDIM>.##.exr --frames 1-2 --rotate-y=0:90");
    EXPECT_THAT(names("f."), ElementsAre("f.1001.01.exr", "f.1001.02.exr", "f.1011.01.exr", "f.1011.02.exr"));
}

TEST_F(Tiles, AlbedoOrEnvironmentMayDefineTheTiles)
{
    bake();
    for (const std::string udim : { "1002", "1003" })
        make_sky({ .5f, .5f, .5f }, "paint." + udim + ".exr");
    done("makelightmap vm.1001.exr sky.exr --albedo paint.<UDIM>.exr -o lit.<UDIM>.exr");
    EXPECT_THAT(names("lit"), ElementsAre("lit.1002.exr", "lit.1003.exr"));
    done("makecfem paint.<UDIM>.exr -o cfem.<UDIM>.exr --resolution=8");
    EXPECT_THAT(names("cfem"), ElementsAre("cfem.1002.exr", "cfem.1003.exr"));
}

TEST_F(Tiles, TheMeshOfAVismapRecipeDefinesTheTiles)
{
    bake();
    write("hero.vismap", "mesh = \"hero.obj\"\nresolution = 32\nsamples = 16\n");
    write("hero.lightmap", "vismap = \"hero.vismap?udim=<UDIM>\"\nenvironment = \"sky.exr\"\n");
    done("makelightmap hero.lightmap -o lit.<UDIM>.exr");
    done("makelightmap vm.<UDIM>.exr sky.exr -o stored.<UDIM>.exr");
    EXPECT_THAT(names("lit"), ElementsAre("lit.1001.exr", "lit.1002.exr", "lit.1011.exr"));
    for (const std::string udim : { "1001", "1002", "1011" })
        expect_same_pixels("lit." + udim + ".exr", "stored." + udim + ".exr", 0);
    refused(2, "vismap: \"hero.vismap\" is a single tile; did you mean \"hero.vismap?udim=<UDIM>\"?",
            "makelightmap hero.vismap sky.exr -o x.<UDIM>.exr");
}

TEST_F(Tiles, ARecipeUnderTheNameOfATileIsOfThatTile)
{
    bake();
    write("hero.lightmap", "vismap = \"vm.<UDIM>.exr\"\nenvironment = \"sky.exr\"\n");
    std::filesystem::create_symlink("hero.lightmap", "hero.1011.lightmap");
    done("makelightmap hero.1011.lightmap -o a.exr");
    done("makelightmap hero.lightmap --udim=1011 -o b.exr");
    done("makelightmap hero.lightmap?udim=1011 -o c.<UDIM>.exr");
    EXPECT_THAT(names("c."), ElementsAre("c.1011.exr"));
    EXPECT_TRUE(read("a.exr") == read("b.exr"));
    EXPECT_TRUE(read("a.exr") == read("c.1011.exr"));
    EXPECT_THAT(done("makelightmap hero.1011.lightmap --print-recipe"), HasSubstr("udim = 1011\n"));
    refused(2, "--udims cannot be saved in a recipe", "makelightmap hero.lightmap --udims=1001 --print-recipe");
}

TEST_F(Tiles, MeshesInFilesByTile)
{
    std::filesystem::rename("hero.obj", "part.1002.obj");
    done("makevismap part.<UDIM>.obj -o vm.<UDIM>.exr" + small);
    EXPECT_THAT(names("vm"), ElementsAre("vm.1002.exr"));
}

TEST_F(Tiles, TilesThatCannotBeToldApartAreRefused)
{
    bake();
    const std::string bake_all = "makevismap hero.obj" + small, light = "makelightmap vm.<UDIM>.exr sky.exr ",
                      one = "makelightmap vm.1001.exr sky.exr ";
    refused(2, "\"x.exr\": 3 tiles need <UDIM> in the file name, for the number", light + "-o x.exr --udims 1001-1003");
    refused(2, "\"x.exr\": 2 tiles need", light + "-o x.exr --udims=1001,1002");
    for (const std::string& words : { bake_all, one }) {
        refused(2, "udims: no file name contains <UDIM>", words + "-o x.exr --udims=1001");
        refused(2, "udims: \"1001-\" is not a list of UDIM tiles", words + "-o x.<UDIM>.exr --udims=1001-");
        refused(2, "udims: 1000 is not a UDIM tile", words + "-o x.<UDIM>.exr --udims=1000-1003");
        refused(2, "udim: 1000 is not in [1001, 9999]", words + "-o x.exr --udim=1000");
        refused(2, "give only one of --udim and --udims", words + "-o x.<UDIM>.exr --udim=1001 --udims=1001");
    }
    refused(2, "vismap: \"vm.<UDIM>.exr\": which tile?", light + "-o x.exr");
    refused(2, "environment: \"sky.<UDIM>.exr\": which tile?", "makecfem sky.<UDIM>.exr -o x.exr");
    refused(2, "mesh: \"hero.<UDIM>.obj\": which tile?", "makevismap hero.<UDIM>.obj -o x.exr");
    refused(2, "\"x.<UDIM>.exr\": which tiles? No input contains <UDIM>", one + "-o x.<UDIM>.exr");
    refused(2, "all tiles would be identical", one + "-o x.<UDIM>.exr --udims=1001,1002");
    for (const auto& [key, line] :
         { std::pair<std::string, std::string>("vismap", "makelightmap gone.<UDIM>.exr sky.exr"),
           { "environment", "makecfem gone.<UDIM>.exr" },
           { "mesh", "makevismap gone.<UDIM>.exr" } })
        refused(2, key + ": \"gone.<UDIM>.exr\": no files match", line + " -o x.<UDIM>.exr");
    refused(2, "\"hero.<UDIM>.lightmap\": use <UDIM> in the paths of the recipe",
            "makelightmap hero.<UDIM>.lightmap -o x.<UDIM>.exr");
    write("hero.vismap", "mesh = \"gone.<UDIM>.obj\"\n");
    refused(1, "mesh: \"gone.<UDIM>.obj\": no files match",
            "makelightmap hero.vismap?udim=<UDIM> sky.exr -o x.<UDIM>.exr");
    refused(1, "no such folder: \"1001\"", light + "-o <UDIM>/x.exr");
}

TEST_F(Tiles, ATileThatFailsIsNamedAndThoseBeforeItStay)
{
    bake();
    write("vm.1002.exr", "no picture");
    const Result result = run("makelightmap vm.<UDIM>.exr sky.exr -o lit.<UDIM>.exr --quiet");
    EXPECT_EQ(result.code, 1);
    EXPECT_THAT(result.err, testing::StartsWith("makelightmap ERROR: tile 1002: \"vm.1002.exr\": "));
    EXPECT_THAT(names("lit"), ElementsAre("lit.1001.exr"));
}
