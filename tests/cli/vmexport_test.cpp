// SPDX-License-Identifier: Apache-2.0
// vmexport on the command line: which files it writes for whom, and what it refuses.
#include "command_test.h"

#include <OpenImageIO/imagebuf.h>

#include <cmath>

using namespace vmlight;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

namespace {

class Vmexport : public CommandTest
{
protected:
    Vmexport() { make_vismap(); }
    std::vector<std::string> exported(const std::string& line, const std::string& folder = "out") const
    {
        done("vmexport " + line + " -o " + folder);
        return names("", folder);
    }
    // All texels of a picture have these values of 255.
    void expect_all(const std::string& name, const std::vector<float>& values) const
    {
        OIIO::ImageSpec config;
        config.attribute("oiio:UnassociatedAlpha", 1);
        OIIO::ImageBuf image(name, 0, 0, nullptr, &config);
        ASSERT_TRUE(image.read(0, 0, true, OIIO::TypeFloat)) << image.geterror();
        ASSERT_EQ(size_t(image.nchannels()), values.size()) << name;
        for (OIIO::ImageBuf::ConstIterator<float> pixel(image); !pixel.done(); ++pixel)
            for (int c = 0; c < image.nchannels(); ++c)
                ASSERT_EQ(std::round(255 * pixel[c]), values[size_t(c)]) << name << " " << c;
    }
    const std::string flat = " --resolution 8 --samples 16 -o ";
};

} // namespace

// An open quad in z = 0: AO is 1, the direction is the normal. 127.5 rounds up.
TEST_F(Vmexport, EachEngineGetsItsFiles)
{
    EXPECT_THAT(exported("vm.exr --for godot --mesh quad.obj", "godot"),
                ElementsAre("vm_ao.png", "vm_bent_normal.png"));
    expect_all("godot/vm_ao.png", { 255 });
    expect_all("godot/vm_bent_normal.png", { 128, 128, 255 });
    EXPECT_THAT(exported("vm.exr --for unity --mesh quad.obj", "unity"),
                ElementsAre("vm_bent_normal.png", "vm_mask_map.png"));
    expect_all("unity/vm_mask_map.png", { 0, 255, 0, 128 });
    for (const char* engine : { "unreal", "substance", "filament" })
        EXPECT_THAT(exported(std::string("vm.exr --mesh quad.obj --for ") + engine, engine),
                    ElementsAre("vm_ao.png", "vm_bent_normal.png"));
    expect_all("unreal/vm_bent_normal.png", { 128, 128, 255 }); // 1 - 0 is as far from 127
    for (const char* engine : { "three", "gltf" })
        EXPECT_THAT(exported(std::string("vm.exr --for ") + engine, engine), ElementsAre("vm_ao.png"));
}

TEST_F(Vmexport, TellsHowEachFileIsDecoded)
{
    EXPECT_EQ(done("vmexport vm.exr --for unreal --mesh quad.obj -o out"),
              "out/vm_ao.png: AO, linear\n"
              "out/vm_bent_normal.png: tangent space, green down, direction = (2 r - 1, 1 - 2 g, 2 b - 1)\n");
    EXPECT_EQ(done("vmexport vm.exr --for unity --mesh quad.obj --space object --ao-gamma 2.2 -o out"),
              "out/vm_mask_map.png: G: AO = value^2.2\n"
              "out/vm_bent_normal.png: object space, direction = 2 rgb - 1\n");
    EXPECT_EQ(done("vmexport vm.exr --for three -o out --quiet"), "");
}

TEST_F(Vmexport, MapsAndNamesAreChosen)
{
    EXPECT_THAT(exported("vm.exr --for three --maps bent_normal,sh --mesh quad.obj --name hero"),
                ElementsAre("hero_bent_normal.png", "hero_sh0.exr"));
    EXPECT_THAT(channel_names("out/hero_sh0.exr"), ElementsAre("R", "G", "B", "A"));
    EXPECT_THAT(exported("vm.exr --for godot --maps sh --sh-file png", "png"), ElementsAre("vm_sh0.png"));
    expect_all("png/vm_sh0.png", { 255, 128, 128, 213 }); // V = 1, B = (0, 0, 2/3)
    done("makevismap quad.obj --basis sh --order 4" + flat + "sh.exr");
    EXPECT_THAT(exported("sh.exr --for godot --maps sh", "more"),
                ElementsAre("sh_sh0.exr", "sh_sh1.exr", "sh_sh2.exr", "sh_sh3.exr"));
    for (const char* basis : { "mask", "cells" }) {
        done(std::string("makevismap quad.obj --basis ") + basis + flat + "basis.exr");
        EXPECT_THAT(exported("basis.exr --for three", basis), ElementsAre("basis_ao.png"));
    }
}

// The metadata say how the mesh was read: turned upright, or with UVs of its own.
TEST_F(Vmexport, TheMeshIsReadAsItWasBaked)
{
    done("makevismap quad.obj --up z" + flat + "up.exr");
    EXPECT_THAT(done("vmexport up.exr --for godot --mesh quad.obj -o up"), Not(HasSubstr("WARNING")));
    expect_all("up/up_bent_normal.png", { 128, 128, 255 });
    write("bare.obj", kQuadWithoutUv);
    done("makevismap bare.obj --unwrap --resolution 32 --samples 16 -o bare.exr");
    EXPECT_THAT(done("vmexport bare.exr --for godot --mesh bare.obj -o bare"), Not(HasSubstr("WARNING")));
    expect_all("bare/bare_bent_normal.png", { 128, 128, 255 });
}

TEST_F(Vmexport, AnotherMeshIsWarnedOf)
{
    std::string turned = kQuad; // seen from behind
    turned.replace(turned.find("f 1/1/1"), std::string::npos, "f 1/1/2 4/4/2 3/3/2 2/2/2\n");
    turned.replace(turned.find("vn 0 0 1"), 8, "vn 0 0 1\nvn 0 0 -1");
    write("turned.obj", turned);
    EXPECT_THAT(done("vmexport vm.exr --for godot --mesh turned.obj -o out"),
                AllOf(HasSubstr("WARNING: \"turned.obj\": not the mesh that the map was baked from"),
                      HasSubstr("100.0 % of its directions point into the surface of \"turned.obj\"")));
}

TEST_F(Vmexport, UdimTilesKeepTheirNumbers)
{
    std::string wide = kQuad;
    for (const char* v : { " 0\n", " 1\n" })
        wide.replace(wide.find(std::string("vt 1") + v), 4, "vt 2");
    write("wide.obj", wide);
    done("makevismap wide.obj --resolution 8 --samples 4 -o 'vm.<UDIM>.exr'");
    done("makelightmap 'vm.<UDIM>.exr' {sky} -o 'lit.<UDIM>.exr'");
    EXPECT_THAT(exported("'vm.<UDIM>.exr' --for godot --mesh wide.obj --lightmap 'lit.<UDIM>.exr'"),
                ElementsAre("vm_ao.1001.png", "vm_ao.1002.png", "vm_bent_normal.1001.png", "vm_bent_normal.1002.png",
                            "vm_lightmap.1001.exr", "vm_lightmap.1002.exr"));
    EXPECT_THAT(exported("vm.1002.exr --for godot --mesh wide.obj", "one"),
                ElementsAre("vm_ao.1002.png", "vm_bent_normal.1002.png"));
    refused(2, "--gltf: one tile at a time", "vmexport 'vm.<UDIM>.exr' --mesh wide.obj --gltf a.glb");
    refused(1, "\"none.<UDIM>.exr\": no files match", "vmexport 'none.<UDIM>.exr' --for three -o out");
    const Result result = run("vmexport vm.1002.exr --for godot --mesh quad.obj -o none");
    EXPECT_EQ(result.code, 1);
    EXPECT_THAT(result.err, HasSubstr("ERROR: \"quad.obj\": covers no texel of UDIM tile 1002"));
    EXPECT_FALSE(exists("none"));
}

TEST_F(Vmexport, LightmapsAreEncoded)
{
    make_sky({ 1, 2, 3 });
    done("makelightmap vm.exr sky.exr -o lit.exr");
    const std::string line = "vmexport vm.exr --for three --maps ao --lightmap lit.exr -o out --lightmap-encoding ";
    EXPECT_THAT(done(line + "half"), HasSubstr("out/vm_lightmap.exr: linear Rec.709"));
    EXPECT_THAT(done(line + "rgbe"), HasSubstr("out/vm_lightmap.hdr: linear Rec.709"));
    EXPECT_THAT(done(line + "rgbm"), HasSubstr("out/vm_lightmap.png: light = 3 * alpha * rgb"));
    expect_all("out/vm_lightmap.png", { 85, 170, 255, 255 });
    EXPECT_THAT(done(line + "gain_map"), HasSubstr("out/vm_lightmap_gain.json: numbers of the gain"));
    expect_all("out/vm_lightmap.png", { 255, 255, 255 });
    EXPECT_TRUE(exists("out/vm_lightmap_gain.png"));
    expect_same_pixels("out/vm_lightmap.exr", "lit.exr", 1e-3f);
    expect_same_pixels("out/vm_lightmap.hdr", "lit.exr", 0.02f);
    refused(
        1, "\"lit.exr\": its greatest value is 3, and RGBM holds no more than its range, 2",
        "vmexport vm.exr --for three --maps sh --lightmap lit.exr -o other --lightmap-encoding rgbm --rgbm-range 2");
}

TEST_F(Vmexport, AGltfNeedsNoFolder)
{
    make_sky({ 1, 2, 3 });
    done("makelightmap vm.exr sky.exr -o lit.exr");
    EXPECT_EQ(done("vmexport vm.exr --mesh quad.obj --lightmap lit.exr --gltf a.glb"), "a.glb\n");
    done("makecfem sky.exr -o cfem.exr");
    refused(1, "\"cfem.exr\": not a lightmap: its vmlight:stage is \"cfem\", not \"lightmap\"",
            "vmexport vm.exr --mesh quad.obj --lightmap cfem.exr --gltf x.glb");
    done("makevismap " + kSpot + " -o cow.exr --resolution 16 --samples 1 --quiet");
    done("makelightmap cow.exr sky.exr -o cow_lit.exr");
    EXPECT_THAT(
        done("vmexport vm.exr --mesh quad.obj --lightmap cow_lit.exr --gltf c.glb"),
        HasSubstr("WARNING: \"cow_lit.exr\": lights the mesh \"spot.obj\", and the visibility map is of another, "
                  "\"quad.obj\""));
    EXPECT_EQ(read("a.glb").substr(0, 4), "glTF");
    EXPECT_THAT(done("vmexport vm.exr --mesh quad.obj --lightmap lit.exr --gltf b.glb --gltf-light unlit"),
                HasSubstr("WARNING: \"b.glb\": 1024 texels are brighter than 1"));
    EXPECT_TRUE(exists("b.glb"));
}

TEST_F(Vmexport, APageIsOneFileWithItsEnvironments)
{
    make_sky({ 1, 2, 3 });
    done("vmexport vm.exr --mesh quad.obj --environment {sky} --environment sky.exr --html a.html --quiet");
    const std::string page = read("a.html");
    EXPECT_EQ(page.rfind("<!DOCTYPE html>", 0), 0u);
    for (const char* name : { "studio_small_03.hdr", "sky.exr", "quad.obj" })
        EXPECT_THAT(page, HasSubstr(name));
    EXPECT_THAT(page, Not(HasSubstr("@s"))); // all parts are filled in
    done("makecfem sky.exr -o cfem.exr");
    EXPECT_THAT(run("vmexport vm.exr --mesh quad.obj --environment cfem.exr --html b.html").err,
                HasSubstr("\"cfem.exr\": a CFEM without the other lobes"));
    EXPECT_FALSE(exists("b.html"));
    refused(2, "--html needs --environment", "vmexport vm.exr --mesh quad.obj --html a.html");
    refused(2, "--html needs --mesh", "vmexport vm.exr --environment sky.exr --html a.html");
    refused(2, "--html \"a.htm\": the extension must be .html",
            "vmexport vm.exr --mesh quad.obj --environment sky.exr --html a.htm");
    refused(2, "no --html is given", "vmexport vm.exr --for three --environment sky.exr -o out");
}

TEST_F(Vmexport, OcclusionIsPackedIntoATexture)
{
    done("makevismap quad.obj" + flat + "small.exr");
    make_sky({ 0, 0.5f, 0.25f }, "orm.exr", 8, 8);
    EXPECT_THAT(exported("small.exr --for gltf --pack orm.exr"), ElementsAre("small_orm.png"));
    expect_all("out/small_orm.png", { 255, 128, 64 });
    refused(1, "\"orm.exr\": 8x8, but the map is 32x32", "vmexport vm.exr --for gltf --pack orm.exr -o other");
    refused(1, "\"vm.exr/out\": ", "vmexport vm.exr --for three -o vm.exr/out");
}

TEST_F(Vmexport, TheSameBytesTwice)
{
    done("vmexport vm.exr --for godot --mesh quad.obj -o out --depth 16");
    const std::string first = read("out/vm_bent_normal.png");
    done("vmexport vm.exr --for godot --mesh quad.obj -o out --depth 16 --threads 1");
    EXPECT_EQ(read("out/vm_bent_normal.png"), first);
}

TEST_F(Vmexport, WrongUsageIsRefused)
{
    refused(2, "-o FOLDER is missing (or --gltf, or --html)", "vmexport vm.exr --for godot");
    refused(2, "the textures follow: godot, ", "vmexport vm.exr -o out");
    refused(2, "\"crayon\" is not one of godot, unity", "vmexport vm.exr --for crayon -o out");
    refused(2, "bent normals in tangent space need --mesh", "vmexport vm.exr --for godot -o out");
    refused(2, "--space object: godot reads bent normals in tangent space only",
            "vmexport vm.exr --for godot --space object --mesh quad.obj -o out");
    refused(2, "--gltf needs --mesh", "vmexport vm.exr --gltf a.glb");
    refused(2, "--gltf \"a.gltf\": the extension must be .glb", "vmexport vm.exr --mesh quad.obj --gltf a.gltf");
    refused(2, "the occlusion of a glTF is linear", "vmexport vm.exr --for gltf --ao-gamma 2 -o out");
    refused(2, "--name \"a/b\"", "vmexport vm.exr --for three --name a/b -o out");
    refused(2, "no bent normal is written", "vmexport vm.exr --for three --space object -o out");
    refused(2, "no bent normal in tangent space is written", "vmexport vm.exr --for three --green up -o out");
    refused(2, "no ambient occlusion is written", "vmexport vm.exr --for three --maps sh --ao-gamma 2 -o out");
    refused(2, "no spherical harmonics are written", "vmexport vm.exr --for three --sh-file png -o out");
    refused(2, "no --lightmap is given", "vmexport vm.exr --for three --lightmap-encoding rgbe -o out");
    refused(2, "no lightmap is encoded as RGBM", "vmexport vm.exr --for three --rgbm-range 3 -o out");
    refused(2, "no textures are written without -o", "vmexport vm.exr --mesh quad.obj --gltf a.glb --depth 16");
    refused(2, "no --gltf is given", "vmexport vm.exr --for three --lightmap vm.exr --gltf-light unlit -o out");
}

TEST_F(Vmexport, WrongInputsAreRefused)
{
    make_sky({ 1, 1, 1 });
    refused(1, "sky.exr", "vmexport sky.exr --for three -o out");
    refused(1, "none.exr", "vmexport none.exr --for three -o out");
    refused(1, "none.obj", "vmexport vm.exr --for godot --mesh none.obj -o out");
    refused(1, "\"vm.exr\": ", "vmexport vm.exr --for three --lightmap vm.exr -o out");
    write("hair.obj", "v 0 0 0\nv 0 1 0\nv 0 2 0\nl 1 2 3\n");
    done("makevismap hair.obj --radius 0.1 --strand-texels 4 --samples 4 -o hair.exr");
    refused(1, "\"hair.exr\": a visibility map of strands", "vmexport hair.exr --for three -o out");
    done("makevismap quad.obj --measure uniform" + flat + "uniform.exr");
    EXPECT_THAT(done("vmexport uniform.exr --for three -o out"),
                HasSubstr("baked with --measure uniform; engines expect directions weighted by the cosine"));
}
