// SPDX-License-Identifier: Apache-2.0
// --unwrap and --write-mesh on the command line.
#include "command_test.h"

#include <vmlight/base/text.h>

using namespace vmlight;
using testing::HasSubstr;
using testing::Not;

namespace {

class Unwrap : public CommandTest
{
protected:
    const std::string m_bare = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 0 0 1\nf 1 2 3 4\nf 1 2 5\nf 2 3 5\n";
};

} // namespace

TEST_F(Unwrap, AMeshWithoutUvsIsBaked)
{
    write("bare.obj", m_bare);
    refused(1, "unwrap the mesh with makevismap --unwrap", "makevismap bare.obj -o x.exr");
    const std::string said = done("makevismap bare.obj --unwrap -o x.exr --resolution 64 --samples 4 --margin 2");
    EXPECT_THAT(said, HasSubstr("unwrap: "));
    EXPECT_THAT(said, HasSubstr("% of 64x64 texels, 2 texels apart"));
    EXPECT_GT(visibility("x.exr").greatest(), 0.5f);
    EXPECT_EQ(attribute("x.exr", "vmlight:unwrap"), "true");
}

TEST_F(Unwrap, UvsThatOverlapAreReplaced)
{
    write("stacked.obj", kQuad + "v 3 0 0\nv 4 0 0\nv 4 1 0\nf 5/1/1 6/2/1 7/3/1\n");
    EXPECT_THAT(done("makevismap stacked.obj -o a.exr --resolution 64 --samples 4"),
                HasSubstr("more than one triangle"));
    EXPECT_EQ(attribute("a.exr", "vmlight:unwrap"), "");
    EXPECT_THAT(done("makevismap stacked.obj -o b.exr --unwrap --resolution 64 --samples 4 --margin 2"),
                HasSubstr("; 0 texels are shared"));
}

TEST_F(Unwrap, ARecipeGivesTheSamePixels)
{
    write("bare.obj", m_bare);
    const std::string flags = " --unwrap --resolution 64 --samples 4 --margin 2";
    done("makevismap bare.obj -o a.exr" + flags);
    done("makevismap bare.obj -o a.vismap" + flags);
    EXPECT_THAT(read("a.vismap"), HasSubstr("unwrap = true\n"));
    done("makevismap a.vismap -o b.exr");
    expect_same_pixels("a.exr", "b.exr", 0);
    // As a reader reads it, tile by tile; and the atlas is that of the resolution.
    make_sky({ 1, 2, 3 });
    done("makelightmap a.exr sky.exr -o lit_a.exr");
    done("makelightmap a.vismap sky.exr -o lit_b.exr");
    expect_same_pixels("lit_a.exr", "lit_b.exr", 0);
    done("makevismap bare.obj -o c.exr --unwrap --resolution 128 --samples 4 --margin 2");
    done("makelightmap a.vismap?resolution=128 sky.exr -o lit_c.exr");
    done("makelightmap c.exr sky.exr -o lit_d.exr");
    expect_same_pixels("lit_c.exr", "lit_d.exr", 0);
}

TEST_F(Unwrap, OnlyOneTileHasTheAtlas)
{
    write("bare.obj", m_bare);
    refused(2, "unwrap: the atlas is tile 1001, and tile 1002 is empty",
            "makevismap bare.obj --unwrap --udim 1002 -o x.exr");
    done("makevismap bare.obj --unwrap --resolution 32 --samples 4 --margin 1 -o 'x.<UDIM>.exr'");
    EXPECT_EQ(names("x."), std::vector<std::string>(1, "x.1001.exr"));
}

TEST_F(Unwrap, ChartsThatDoNotFitAreRefused)
{
    write("bare.obj", m_bare + "v 9 9 9\nv 9 8 9\nv 8 8 9\nf 6 7 8\n");
    refused(1, "do not fit into 4x4 texels with a margin of 16: choose a larger resolution or a smaller margin",
            "makevismap bare.obj --unwrap -o x.exr --resolution 4");
}

TEST_F(Unwrap, TheMeshIsWrittenAsBaked)
{
    write("bare.obj", m_bare);
    for (const std::string name : { "out.obj", "out.glb" }) {
        const std::string flags = " --resolution 64 --samples 4 --margin 2";
        done("makevismap bare.obj --unwrap --write-mesh " + name + " -o a.exr" + flags);
        done("makevismap " + name + " -o b.exr" + flags);
        expect_same_pixels("a.exr", "b.exr", 1e-5f);
        make_sky({ 1, 1, 1 });
        const auto lit = [&](const std::string& mesh) {
            return done("vmframes " + mesh + " sky.exr --vismap a.exr -o frame.png --size 16 --spp 1");
        };
        EXPECT_THAT(lit(name), Not(HasSubstr("another mesh"))) << "though the last digits of its normals are others";
        write("moved.obj", replaced(read("out.obj"), "v 0 0 1\n", "v 0 0 1.1\n"));
        EXPECT_THAT(lit("moved.obj"), HasSubstr("another mesh"));
    }
    // Without --unwrap too, with what the flags made of it.
    write("quad.obj", kQuad);
    done("makevismap quad.obj --up z --write-mesh up.obj -o a.exr --resolution 8 --samples 4");
    EXPECT_THAT(read("up.obj"), HasSubstr("\nv -1 0 1\n"));
    write("hair.obj", "v 0 0 0\nv 0 1 .5\nv 0 3 0\nv 1 0 0\nv 1 1 0\nl 1 2 3\nl 4 5\n");
    const std::string strands = " --radius .1 --strand-texels 4 --samples 4 ";
    for (const std::string again : { "again.obj", "again.glb" }) {
        done("makevismap hair.obj -o a.exr --write-mesh " + again + strands);
        done("makevismap " + again + " -o b.exr" + strands);
        expect_same_pixels("a.exr", "b.exr", 0);
    }
    // Lines alone are an occluder of strands too, in either format.
    for (const std::string hair : { "hair.obj", "again.glb" })
        done("makevismap quad.obj --occluder " + hair + " --radius .1 -o of_" + hair
             + ".exr --resolution 16 --samples 16");
    expect_same_pixels("of_hair.obj.exr", "of_again.glb.exr", 0);
    EXPECT_LT(visibility("of_hair.obj.exr").least(), 1);
    refused(2, "\"up.stl\": a mesh is written as .glb or .obj", "makevismap quad.obj --write-mesh up.stl -o x.exr");
    refused(2, "--write-mesh cannot be saved in a recipe", "makevismap quad.obj --write-mesh up.obj -o x.vismap");
    refused(1, "no such folder", "makevismap quad.obj --write-mesh none/up.obj -o x.exr --resolution 8");
}
