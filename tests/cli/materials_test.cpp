// SPDX-License-Identifier: Apache-2.0
// Parts of a mesh on the command line: --material, --node, <MATERIAL> in -o, and what the bake says of its file.
#include "command_test.h"

#include "quad_files.h"
#include "room.h"
#include <numeric>

#include <vmlight/base/format.h>

#include <OpenImageIO/strutil.h>

#include <numeric>

#include <filesystem>

using namespace vmlight;
using OIIO::Strutil::replace;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

namespace {

class Materials : public CommandTest
{
protected:
    const std::string small = " --resolution 32 --samples 16 --margin 0 ";

    void SetUp() override { write("room.obj", room_obj()); }
};

// What pair_gltf() points to.
std::string pair_buffer()
{
    std::string bytes;
    for (const float x : { 0.f, 1.f })
        bytes += bytes_of<float>({ x, 0, 0, x + 1, 0, 0, x + 1, 1, 0, x, 1, 0 }) // positions
            + bytes_of<float>({ 0, 0, .5f, 0, .5f, 1, 0, 1 }) // UV set 0
            + bytes_of<float>({ x / 2, 0, x / 2 + .5f, 0, x / 2 + .5f, 1, x / 2, 1 }) // UV set 1
            + bytes_of<uint16_t>({ 0, 1, 2, 0, 2, 3 });
    return bytes;
}

// Two quads side by side, Left of Glass and Right of Brass, under the node Pair: on each other in UV set 0, apart in
// set 1.
std::string pair_gltf()
{
    std::string views, accessors, meshes;
    for (int quad = 0; quad < 2; ++quad) {
        const int start = quad * 124, first = quad * 4;
        const auto add = [&](int offset, int bytes, int number, int component, int count, const char* type) {
            const char* comma = first + number ? "," : "";
            views += format(R"({}{{"buffer":0,"byteOffset":{},"byteLength":{}}})", comma, start + offset, bytes);
            accessors += format(R"({}{{"bufferView":{},"componentType":{},"count":{},"type":"{}")", comma,
                                first + number, component, count, type);
            accessors += number ? "}" : format(R"(,"min":[{},0,0],"max":[{},1,0]}})", quad, quad + 1);
        };
        add(0, 48, 0, 5126, 4, "VEC3");
        add(48, 32, 1, 5126, 4, "VEC2");
        add(80, 32, 2, 5126, 4, "VEC2");
        add(112, 12, 3, 5123, 6, "SCALAR");
        meshes += format(R"({}{{"primitives":[{{"material":{},"attributes":{{"POSITION":{},"TEXCOORD_0":{},)"
                         R"("TEXCOORD_1":{}}},"indices":{}}}]}})",
                         quad ? "," : "", quad, first, first + 1, first + 2, first + 3);
    }
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"name":"Pair","children":[1,2]},)"
           R"({"name":"Left","mesh":0},{"name":"Right","mesh":1}],"materials":[{"name":"Glass"},{"name":"Brass"}],)"
           R"("buffers":[{"byteLength":248,"uri":"pair.bin"}],"bufferViews":[)"
        + views + R"(],"accessors":[)" + accessors + R"(],"meshes":[)" + meshes + "]}";
}

size_t covered(const Pixels& pixels)
{
    size_t count = 0;
    for (const float value : pixels.values)
        count += value != 0;
    return count;
}

} // namespace

TEST_F(Materials, APartIsBakedAndTheRestOccludes)
{
    done("makevismap room.obj --material Stone --node House -o lid.exr" + small);
    EXPECT_EQ(covered(visibility("lid.exr")), 256u);
    EXPECT_EQ(attribute("lid.exr", "vmlight:material"), "Stone");
    done("makevismap room.obj --material Stone --material Brick -o both.exr" + small);
    done("makevismap room.obj -o whole.exr" + small);
    expect_same_pixels("both.exr", "whole.exr", 0);
    EXPECT_LT(visibility("whole.exr").least(), .9f);
}

TEST_F(Materials, ARecipeKeepsTheNames)
{
    done("makevismap room.obj --material Stone --node House -o lid.vismap" + small);
    EXPECT_THAT(read("lid.vismap"), HasSubstr("material = [\n    \"Stone\",\n]\nnode = [\n    \"House\",\n]\n"));
    done("makevismap lid.vismap -o a.exr");
    done("makevismap room.obj --material Stone --node House -o b.exr" + small);
    expect_same_pixels("a.exr", "b.exr", 0);
    done("makevismap lid.vismap --material '' --node Ground -o floor.exr");
    done("makevismap room.obj --node Ground -o c.exr" + small);
    expect_same_pixels("floor.exr", "c.exr", 0);
}

TEST_F(Materials, WhatIsNotThereIsRefused)
{
    refused(1, "; did you mean \"Stone\"?", "makevismap room.obj --material Stome -o x.exr");
    refused(1, "\"room.obj\": no node \"Hose\"; the file has ", "makevismap room.obj --node Hose -o x.exr");
    refused(1, "no triangle has the material and is below the node \"Ground\"",
            "makevismap room.obj --material Brick --node Ground -o x.exr");
    refused(2, "--material has an empty value", "makevismap room.obj --material '' -o x.exr");
    refused(1, "no texture coordinates in UV set 1; the mesh has UV set 0", "makevismap room.obj --uv-set 1 -o x.exr");
}

TEST_F(Materials, OneMapAMaterial)
{
    const std::string printed = done("makevismap room.obj -o 'vm_<MATERIAL>.exr'" + small);
    EXPECT_THAT(names("vm"), ElementsAre("vm_Brick.exr", "vm_Stone.exr"));
    EXPECT_THAT(printed, HasSubstr("material Brick: bake: "));
    for (const char* material : { "Brick", "Stone" }) {
        done("makevismap room.obj -o alone.exr --material " + std::string(material) + small);
        EXPECT_EQ(read("alone.exr"), read("vm_" + std::string(material) + ".exr"));
    }
    done("makevismap room.obj --node Ground -o 'floor_<MATERIAL>.exr'" + small);
    EXPECT_THAT(names("floor"), ElementsAre("floor_Stone.exr"));
    write("room.vismap", "mesh = \"room.obj\"\nmaterial = \"B*\"\nresolution = 8\nsamples = 4\n");
    done("makevismap room.vismap -o 'wall_<MATERIAL>.exr'");
    EXPECT_THAT(names("wall"), ElementsAre("wall_Brick.exr"));
}

TEST_F(Materials, OneMapAMaterialAndTile)
{
    // The lid, and with it Stone, is in tile 1002 too.
    write("room.obj",
          replace(room_obj(), "vt 0 0.5\nvt 0.5 0.5\nvt 0.5 1\nvt 0 1\nvn", "vt 1 0.5\nvt 2 0.5\nvt 2 1\nvt 1 1\nvn"));
    const std::string printed = done("makevismap room.obj -o 'vm_<MATERIAL>.<UDIM>.exr'" + small);
    EXPECT_THAT(names("vm"), ElementsAre("vm_Brick.1001.exr", "vm_Stone.1001.exr", "vm_Stone.1002.exr"));
    EXPECT_THAT(printed, HasSubstr("material Stone: tile 1002: bake: "));
    EXPECT_THAT(printed, Not(HasSubstr("WARNING")));
    done("makevismap room.obj -o 'one_<MATERIAL>.exr' --udim 1001" + small);
    EXPECT_EQ(read("one_Stone.exr"), read("vm_Stone.1001.exr"));
    refused(2, "<MATERIAL> needs one mesh for all tiles", "makevismap room.<UDIM>.obj -o 'vm_<MATERIAL>.<UDIM>.exr'");
}

TEST_F(Materials, NamesAreMadeSafeForFiles)
{
    write("odd.obj", replace(replace(room_obj(), "Stone", "../a b", true), "Brick", ".B\xc3\xa4r#"));
    done("makevismap odd.obj -o 'vm-<MATERIAL>.exr'" + small);
    EXPECT_THAT(names("vm"), ElementsAre("vm-_._a_b.exr", "vm-_B\xc3\xa4r_.exr"));
    write("same.obj", replace(replace(room_obj(), "Stone", "a/b", true), "Brick", "a_b"));
    refused(1, "\"same.obj\": the materials \"a/b\" and \"a_b\" would both be \"a_b\" in file names",
            "makevismap same.obj -o 'vm-<MATERIAL>.exr'");
    done("makevismap same.obj --material a_b -o 'vm-<MATERIAL>.exr'" + small);
}

TEST_F(Materials, AFailureLeavesNothingBehind)
{
    std::filesystem::create_directory("vm_Stone.exr");
    refused(1, "vm_Stone.exr", "makevismap room.obj -o 'vm_<MATERIAL>.exr'" + small);
    refused(2, "<MATERIAL> is for the maps", "makevismap room.obj -o 'vm_<MATERIAL>.vismap'");
    make_vismap();
    refused(2, "<MATERIAL> is for visibility maps", "makelightmap vm.exr {sky} -o 'lit_<MATERIAL>.exr'");
}

TEST_F(Materials, HeavyOverlapNamesWhatOverlapsLess)
{
    write("room.obj", replace(room_obj(true), "usemtl Stone\nf 7", "usemtl Glass\nf 7"));
    EXPECT_THAT(done("makevismap room.obj -o x.exr" + small),
                HasSubstr("(100.00 % of the covered ones) belong to more than one triangle: the first triangle in the "
                          "file wins. materials Stone, Brick, Glass overlap 0 % each: try <MATERIAL> in -o"));
    EXPECT_THAT(done("makevismap room.obj --node House -o x.exr" + small),
                HasSubstr("materials Brick, Glass overlap 0 %"));
    EXPECT_THAT(done("makevismap room.obj -o 'y_<MATERIAL>.exr'" + small), Not(HasSubstr("WARNING")));
    write("one.obj", replace(room_obj(true), "Brick", "Stone"));
    EXPECT_THAT(done("makevismap one.obj -o x.exr" + small), Not(HasSubstr("<MATERIAL>")));
}

TEST_F(Materials, AnotherUvSetIsSuggested)
{
    write("pair.bin", pair_buffer());
    write("pair.gltf", pair_gltf());
    EXPECT_THAT(done("makevismap pair.gltf -o x.exr" + small),
                HasSubstr("first triangle in the file wins. UV set 1 overlaps 0 %, set 0 100 %: try --uv-set 1; or "
                          "materials Glass, Brass overlap 0 % each: try <MATERIAL> in -o"));
    EXPECT_THAT(done("makevismap pair.gltf --uv-set 1 -o x.exr" + small), Not(HasSubstr("WARNING")));
    EXPECT_EQ(covered(visibility("x.exr")), 1024u);
    const std::string picture = "vmframes pair.gltf {sky} --vismap x.exr --size 16 --spp 1 -o x.png";
    EXPECT_THAT(done(picture),
                HasSubstr("\"x.exr\": was baked with UV set 1 of its mesh, and \"pair.gltf\" is read with set 0: pass "
                          "--uv-set 1\n"));
    EXPECT_THAT(done(picture + " --uv-set 1"), Not(HasSubstr("was baked ")));
    done("makevismap pair.gltf --node Pair --material Glass --uv-set 1 -o x.exr" + small);
    EXPECT_EQ(covered(visibility("x.exr")), 512u);
    refused(1, "no texture coordinates in UV set 2; the mesh has UV sets 0 and 1",
            "makevismap pair.gltf --uv-set 2 -o x.exr");
    EXPECT_THAT(done("makevismap pair.gltf --list"),
                HasSubstr("UV set 0: 4 triangles\nUV set 1: 4 triangles\nmaterial \"Glass\": 2 triangles\n"));
}

TEST_F(Materials, TheBakeSaysWhereNormalsAreFrom)
{
    EXPECT_THAT(done("makevismap room.obj -o x.exr" + small), HasSubstr("normals: from the file\n"));
    EXPECT_THAT(done("makevismap room.obj -o x.exr --normals flat" + small), HasSubstr("normals: flat\n"));
}

TEST_F(Materials, AListShowsWhatThereIs)
{
    const std::string list = done("makevismap room.obj --list");
    for (const char* line :
         { "\"room.obj\": 6 triangles\nUV set 0: 6 triangles\n", "material \"Stone\": 4 triangles\n",
           "material \"Brick\": 2 triangles\n", "node \"Ground\": 2 triangles\n", "node \"House\": 4 triangles\n" })
        EXPECT_THAT(list, HasSubstr(line));
    EXPECT_THAT(names("room"), ElementsAre("room.obj"));
    refused(1, "\"none.obj\": no such file", "makevismap none.obj --list");
}

TEST_F(Materials, CutOutsAreReportedOrSwitchedOff)
{
    // A roof over the floor that stops a quarter of the light.
    write("card.mtl", "newmtl Glass\nd 0.25\nnewmtl Stone\n");
    write("card.obj",
          "mtllib card.mtl\nusemtl Stone\n" + kQuad
              + "usemtl Glass\nv -9 -9 1\nv 9 -9 1\nv 9 9 1\nv -9 9 1\nf 5/1/1 6/2/1 7/3/1 8/4/1\n");
    const std::string bake = "makevismap card.obj --material Stone" + small;
    EXPECT_THAT(done(bake + "-o auto.exr"),
                HasSubstr("cut-outs: 2 triangles, 0 opaque, 0 transparent, 2 in part: 100 % of their cells need the "
                          "texture"));
    EXPECT_EQ(attribute("auto.exr", "vmlight:cutouts"), "auto");
    const Pixels seen = visibility("auto.exr");
    EXPECT_NEAR(std::accumulate(seen.values.begin(), seen.values.end(), 0.0) / double(seen.values.size()), 0.75, 0.05);
    // The same as an effect, with what it costs to leave it out.
    EXPECT_THAT(done(bake + "--effects -cut-outs -o left.exr"),
                HasSubstr("cut-outs switched off, which changes this scene: V is off by about 0.7"));
    EXPECT_THAT(done(bake + "--cutouts off -o off.exr"), Not(HasSubstr("cut-outs:")));
    expect_same_pixels("left.exr", "off.exr", 0);
    EXPECT_EQ(attribute("off.exr", "vmlight:cutouts"), "off");
    EXPECT_LT(visibility("off.exr").greatest(), 0.1f);
    refused(2, "cutouts", bake + "--cutouts on -o x.exr");
    EXPECT_THAT(done(bake + "--cutouts off --print-recipe"), HasSubstr("cutouts = \"off\""));
    write("card.mtl", "newmtl Glass\nmap_d lost leaf.png\nnewmtl Stone\n");
    refused(1, "lost leaf.png", bake + "-o x.exr");
    refused(1, "--cutouts off", bake + "-o x.exr");
    done(bake + "--cutouts off -o y.exr");
}
