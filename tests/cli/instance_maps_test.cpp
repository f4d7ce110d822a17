// SPDX-License-Identifier: Apache-2.0
// <INSTANCE> in -o: one map for each instance of a scene list, or node of a glTF, that is baked.
#include "command_test.h"
#include "quad_files.h"

#include <vmlight/base/format.h>

#include <gmock/gmock.h>

using namespace vmlight;
using testing::ElementsAre;
using testing::HasSubstr;

namespace {

class InstanceMaps : public CommandTest
{
protected:
    const std::string small = " --resolution 16 --samples 16 ";
    const std::string list = "[[instance]]\nmesh = \"quad.obj\"\nname = \"mill\"\nbake = true\n"
                             "[[instance]]\nmesh = \"quad.obj\"\nname = \"town hall\"\nbake = true\n"
                             "translate = [0.5, 0, 0.5]\n"
                             "[[instance]]\nmesh = \"quad.obj\"\ntranslate = [-1, 0, 0.25]\n";

    void SetUp() override
    {
        write("quad.obj", kQuad);
        write("village.toml", list);
    }
};

} // namespace

TEST_F(InstanceMaps, EachIsWhatTheNodeAloneIs)
{
    const std::string printed = done("makevismap village.toml -o 'vm_<INSTANCE>.exr'" + small);
    EXPECT_THAT(names("vm_"), ElementsAre("vm_mill.exr", "vm_town_hall.exr"));
    EXPECT_THAT(printed, HasSubstr("instance town hall: bake: "));
    done("makevismap village.toml --node mill -o mill.exr" + small);
    done("makevismap village.toml --node 'town hall' -o hall.exr" + small);
    EXPECT_TRUE(read("vm_mill.exr") == read("mill.exr"));
    EXPECT_TRUE(read("vm_town_hall.exr") == read("hall.exr"));
    EXPECT_FALSE(read("mill.exr") == read("hall.exr")) << "the one that stands higher sees more";
}

TEST_F(InstanceMaps, OneMapOfAllHasTheHint)
{
    EXPECT_THAT(done("makevismap village.toml -o all.exr" + small),
                HasSubstr("instances mill, town hall overlap 0 % each: try <INSTANCE> in -o, for one map an instance"));
}

TEST_F(InstanceMaps, FewAreSaidToBeTriangles)
{
    EXPECT_THAT(done("makevismap quad.obj --occluder village.toml -o x.exr" + small),
                HasSubstr("instances: none kept; 3 copies are triangles\n"));
}

TEST_F(InstanceMaps, AreDividedAndJoined)
{
    done("makevismap village.toml -o 'all_<INSTANCE>.exr'" + small);
    done("makevismap village.toml -o 'p_<INSTANCE>.exr' --part 1-2/2" + small);
    std::string parts;
    for (const std::string& name : names("p_"))
        parts += name + " ";
    refused(1, "the parts are of instances \"mill\" and \"town hall\", which need <INSTANCE> in the file name",
            "makevismap --join " + parts + "-o x.exr");
    done("makevismap --join " + parts + "-o 'j_<INSTANCE>.exr'");
    for (const char* name : { "mill", "town_hall" })
        EXPECT_TRUE(read(format("j_{}.exr", name)) == read(format("all_{}.exr", name))) << name;
}

TEST_F(InstanceMaps, ThoseOfOneNameAreRefused)
{
    write("village.toml", list + "[[instance]]\nmesh = \"quad.obj\"\nname = \"mill\"\nbake = true\n");
    refused(1,
            "\"village.toml\": the instances \"mill\" and \"mill\" would both be \"mill\" in file names: rename one of "
            "them, or bake them one by one with --node",
            "makevismap village.toml -o 'vm_<INSTANCE>.exr'" + small);
    EXPECT_THAT(names("vm_"), ElementsAre());
}

TEST_F(InstanceMaps, WhatItCannotStandForIsRefused)
{
    refused(
        1, "\"quad.obj\": no instances, which only scene lists, glTF and Alembic files have: remove <INSTANCE> from -o",
        "makevismap quad.obj -o 'vm_<INSTANCE>.exr'" + small);
    refused(2, "--write-mesh writes one mesh: not with <INSTANCE>; bake and write each instance with --node NAME",
            "makevismap village.toml -o 'vm_<INSTANCE>.exr' --write-mesh 'vm_<INSTANCE>.glb'" + small);
    refused(2, "give one of <MATERIAL> and <INSTANCE>", "makevismap village.toml -o 'vm_<INSTANCE>_<MATERIAL>.exr'");
    refused(2, "<INSTANCE> is for the maps, not for the recipe", "makevismap village.toml -o 'vm_<INSTANCE>.vismap'");
    make_sky({ 1, 1, 1 });
    done("makevismap quad.obj -o vm.exr" + small);
    refused(2, "<INSTANCE> is for visibility maps: only makevismap knows the instances of a mesh",
            "makelightmap vm.exr sky.exr -o 'lit_<INSTANCE>.exr'");
}

TEST_F(InstanceMaps, NoFrameIsDrawnOfThem)
{
    make_sky({ 1, 1, 1 });
    refused(1, "\"village.toml\": a scene list, whose instances are not drawn; bake it with makevismap",
            "vmframes village.toml sky.exr --resolution 16 --size 16 -o lit.png");
    EXPECT_TRUE(names("lit").empty());
}
