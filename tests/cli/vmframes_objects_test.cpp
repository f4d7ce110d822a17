// SPDX-License-Identifier: Apache-2.0
// Objects of vmframes on the command line: several, with a file for each frame, of strands.
#include "vmframes_run.h"

#include <string>

using namespace vmlight;

namespace {

using Vmframes = VmframesTest;

} // namespace

TEST_F(Vmframes, SeveralObjectsAreInEachOthersWay)
{
    write("roof.obj",
          "v -9 2 -9\nv 9 2 -9\nv 9 2 9\nv -9 2 9\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 -1 0\n"
          "f 1/1/1 2/2/1 3/3/1 4/4/1\n");
    const std::string line = "vmframes quad.obj sky.exr --look-at 0,0,0 --elevation 0 -o ";
    done(line + "open.exr" + small);
    done(line + "under.exr --object roof.obj" + small);
    EXPECT_LT(pixels("under.exr").greatest(), 0.99f * pixels("open.exr").greatest());
    done(line + "shadow.exr --ground shadow" + small);
    expect_finite("shadow.exr");
}

// Each frame is the picture of its own files, where the first one's camera stands.
TEST_F(Vmframes, MeshesMayHaveAFileForEachFrame)
{
    const auto roof = [](const std::string& height) {
        return "v -9 " + height + " -9\nv 9 " + height + " -9\nv 9 " + height + " 9\nv -9 " + height
            + " 9\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 -1 0\nf 1/1/1 2/2/1 3/3/1 4/4/1\n";
    };
    write("roof.1.obj", roof("3"));
    write("roof.2.obj", roof("2"));
    const std::string lit = " sky.exr --look-at 0,0,0 --fov 0 --elevation 0";
    // A further object that moves shades one that stays.
    const std::string quad = "vmframes quad.obj" + lit + small;
    EXPECT_EQ(count(done(quad + " --object roof.#.obj --frames 1-2 -o over.#.exr"), "WARNING"), 0u);
    for (const std::string frame : { "1", "2" }) {
        done(quad + " --object roof." + frame + ".obj -o one.exr");
        expect_same_pixels("over." + frame + ".exr", "one.exr", 0);
    }
    EXPECT_NE(pixels("over.1.exr").values, pixels("over.2.exr").values);
    // The mesh itself, with a ground, by several models, and with the maps of makevismap --frames.
    for (const char* frame : { "1", "2" }) {
        std::string mesh = kQuad; // its upper edge leans
        mesh.replace(mesh.find("v 1 1 0\nv -1 1 0"), 16, std::string("v 1 1 .") + frame + "\nv -1 1 ." + frame);
        write(std::string("lean.") + frame + ".obj", mesh + "v -1 -1 1\nv 1 1 1\nv 1 1 0\nf 5 6 7\n");
    }
    const std::string ground = lit + " --ground white --side-by-side ao,lobe";
    done("vmframes lean.#.obj" + ground + small + " --frames 1-2 -o lean.#.exr");
    done("vmframes lean.2.obj" + ground + small + " -o one.exr");
    expect_same_pixels("lean.2.exr", "one.exr", 0);
    EXPECT_NE(pixels("lean.1.exr").values, pixels("lean.2.exr").values);
    done("makevismap lean.#.obj --frames 1-2 --resolution 16 --samples 4 -o vm.#.exr");
    const std::string given = few + " --cfem-resolution 16";
    EXPECT_EQ(count(done("vmframes lean.#.obj" + lit + given + " --vismap vm.#.exr --frames 1-2 -o given.#.exr"),
                    "another mesh"),
              0u);
    done("vmframes lean.2.obj" + lit + given + " --vismap vm.2.exr -o one.exr");
    expect_same_pixels("given.2.exr", "one.exr", 0);
    // A map of the first frame alone is one of another mesh in the second.
    EXPECT_EQ(count(done("vmframes lean.#.obj" + lit + given + " --vismap vm.1.exr --frames 1-2 -o given.#.exr"),
                    "\"vm.1.exr\": was baked from another mesh than \"lean.2.obj\""),
              1u);
    refused(1, "\"roof.4.obj\": no such file", quad + " --object roof.#.obj --frames 1,4 -o x.#.exr");
    EXPECT_FALSE(exists("x.1.exr"));
    const std::string reason = ": no such file, and no frames: a sequence needs --frames, such as 1-48";
    refused(2, "mesh: \"lean.#.obj\"" + reason, "vmframes lean.#.obj sky.exr -o x.png");
    refused(2, "object: \"roof.#.obj\"" + reason, "vmframes quad.obj sky.exr --object roof.#.obj -o x.png");
    refused(2, "vismap: \"vm.#.exr\"" + reason, "vmframes quad.obj sky.exr --vismap vm.#.exr -o x.png");
    refused(2, "--keep is for one map of each object",
            "vmframes lean.#.obj sky.exr --frames 1-2 --keep kept -o x.#.exr");
}

TEST_F(Vmframes, APartOfAMeshIsShown)
{
    const std::string corners = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 2 -1 0\nv 4 -1 0\nv 4 1 0\nv 2 1 0\n"
                                "vt 0 0\nvt .4 0\nvt .4 1\nvt 0 1\nvt .6 0\nvt 1 0\nvt 1 1\nvt .6 1\n",
                      left = "usemtl left\nf 1/1 2/2 3/3 4/4\n", right = "usemtl right\nf 5/5 6/6 7/7 8/8\n";
    write("both.obj", corners + left + right);
    write("left.obj", corners + left);
    const std::string flags = " sky.exr --resolution 16 --samples 4 --size 16 --spp 1 -o ";
    done("vmframes left.obj" + flags + "left.exr");
    done("vmframes both.obj --material left" + flags + "part.exr");
    expect_same_pixels("part.exr", "left.exr", 1e-5f);
    done("vmframes both.obj" + flags + "both.exr");
    EXPECT_NE(pixels("both.exr").values, pixels("left.exr").values) << "the camera stands farther off";
    refused(1, "vmframes ERROR: \"both.obj\": no material \"rigth\"; the file has \"left\" and \"right\"",
            "vmframes both.obj --material rigth" + flags + "x.exr");
}

TEST_F(Vmframes, StrandsAreDrawnOverAMesh)
{
    std::string obj = "v -.5 0 .2\nv .5 0 .3\nl 1 2\nv -.5 .2 .2\nv .5 .2 .3\nl 3 4\n";
    write("hair.obj", obj);
    done("vmframes quad.obj sky.exr -o bare.exr" + small);
    done("vmframes quad.obj sky.exr --object hair.obj --radius .3 --strand-color 0,1,0 -o both.exr --layers albedo"
         + small);
    EXPECT_LT(mean("both.exr"), mean("bare.exr"));
    const std::string hair = "vmframes quad.obj sky.exr --object hair.obj --radius .3 --strand-color 0,1,0 ";
    done(hair + "-o plain.exr" + small);
    done(hair + "--strand-specular .5 -o gloss.exr" + small);
    EXPECT_GT(mean("gloss.exr"), mean("plain.exr"));
    const Pixels all = pixels("both.exr");
    const float* centre = &all.values[size_t(8 * 16 + 8) * size_t(all.channels)];
    EXPECT_EQ(centre[0], 0); // green hair is in front
    EXPECT_GT(centre[1], 0);
    done("vmframes hair.obj sky.exr --radius .05 -o alone.png --samples 4" + few);
    for (const std::string flag : { "--format half", "--compression none" })
        refused(2, "only an EXR is stored so", "vmframes quad.obj sky.exr -o a.png " + flag + small);
    refused(2, "no object is strands", "vmframes quad.obj sky.exr --radius .1 -o a.png" + small);
    refused(2, "no object is strands", "vmframes quad.obj sky.exr --strand-color 1,0,0 -o a.png" + small);
    refused(2, "--strand-specular 1: no object is strands",
            "vmframes quad.obj sky.exr --strand-specular 1 -o a.png" + small);
    refused(2, "--strand-exponent 9: only --strand-specular uses it",
            "vmframes quad.obj sky.exr --object hair.obj --radius .1 --strand-exponent 9 -o a.png" + small);
    refused(2, "--strand-exponent: 501 is not in [1, 500]",
            "vmframes quad.obj sky.exr --object hair.obj --radius .1 --strand-specular 1 --strand-exponent 501 -o a.png"
                + small);
    refused(2, "--white shows all white",
            "vmframes quad.obj sky.exr --object hair.obj --radius .1 --strand-color 1,0,0 --white -o a.png" + small);
}
