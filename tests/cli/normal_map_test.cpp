// SPDX-License-Identifier: Apache-2.0
// --normal-map on the command line and in recipes.
#include "command_test.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <cmath>
#include <numeric>

using namespace vmlight;
using testing::HasSubstr;
using testing::Not;

namespace {

class NormalMaps : public CommandTest
{
protected:
    NormalMaps() { write("quad.obj", kQuad); }

    void make_map(const std::string& name, const std::vector<float>& color) const
    {
        OIIO::ImageBuf image(OIIO::ImageSpec(4, 4, int(color.size()), OIIO::TypeDesc::UINT8));
        OIIO::ImageBufAlgo::fill(image, color);
        ASSERT_TRUE(image.write(path(name))) << image.geterror();
    }
    float greatest_x(const std::string& name) const
    {
        const OIIO::ImageBuf image(path(name));
        const int channel = image.spec().channelindex("normal.x");
        EXPECT_GE(channel, 0);
        float greatest = -1;
        for (OIIO::ImageBuf::ConstIterator<float> texel(image); !texel.done(); ++texel)
            greatest = std::max(greatest, texel[channel]);
        return greatest;
    }
    static double mean(const Pixels& pixels)
    {
        return std::accumulate(pixels.values.begin(), pixels.values.end(), 0.0) / double(pixels.values.size());
    }
    const std::string small = " --resolution 8 --samples 16";
};

} // namespace

TEST_F(NormalMaps, TiltTexels)
{
    make_map("n.png", { 0.8f, 0.5f, 0.9f });
    EXPECT_THAT(done("makevismap quad.obj --normal-map n.png --channels normal -o a.exr" + small),
                HasSubstr("normal map: 4x4, in tangent space"));
    EXPECT_NEAR(greatest_x("a.exr"), 0.6f, 0.01f);
    EXPECT_NEAR(mean(visibility("a.exr")), 0.9, 0.02); // the surface itself is in the way
    EXPECT_EQ(attribute("a.exr", "vmlight:normal_map"), "n.png");
    EXPECT_EQ(attribute("a.exr", "vmlight:normal_map_green"), "up");
    done("makevismap quad.obj --normal-map n.png --channels normal -o a.vismap" + small);
    done("makevismap a.vismap -o b.exr");
    expect_same_pixels("a.exr", "b.exr", 0);
    make_sky({ 1, 1, 1 });
    done("makelightmap a.vismap sky.exr -o lit.exr");
    EXPECT_NEAR(mean(pixels("lit.exr")), 0.9, 0.02);
}

TEST_F(NormalMaps, AreAnEffect)
{
    make_map("n.png", { 0.8f, 0.5f, 0.9f });
    const std::string line = "makevismap quad.obj --normal-map n.png" + small;
    EXPECT_THAT(done(line + " --explain -o a.exr"),
                testing::ContainsRegex("normal-map +on .* normals of texels are mapped"));
    EXPECT_THAT(done(line + " --effects -normal-map -o b.exr"),
                testing::ContainsRegex(
                    "normal-map switched off, which changes this scene: V is off by about 0\\.(1|09[0-9]) "));
    done("makevismap quad.obj -o c.exr" + small);
    expect_same_pixels("b.exr", "c.exr", 0);
    // How far off a picture is without it takes the map itself.
    write("quad.vismap", "mesh = \"quad.obj\"\nnormal_map = \"no.png\"\neffects = \"-normal-map\"\n");
    refused(1, "\"quad.vismap\": \"no.png\": no such file", "makevismap quad.vismap -o d.exr" + small);
    refused(2, "+normal-map is impossible: no --normal-map is given",
            "makevismap quad.obj --effects +normal-map -o x.exr" + small);
}

TEST_F(NormalMaps, AFlatOneIsLeftOut)
{
    make_map("flat.png", { 0.5f, 0.5f, 1 });
    EXPECT_THAT(done("makevismap quad.obj --normal-map flat.png -o a.exr" + small),
                HasSubstr("normal map: 4x4, flat, so that it changes nothing: left out"));
    EXPECT_THAT(done("makevismap quad.obj -o b.exr" + small), Not(HasSubstr("normal map")));
    expect_same_pixels("a.exr", "b.exr", 0);
    EXPECT_EQ(attribute("b.exr", "vmlight:normal_map_space"), "");
}

TEST_F(NormalMaps, WhatCannotBeOneIsRefused)
{
    const std::string line = "makevismap quad.obj -o x.exr" + small + " --normal-map ";
    make_map("bump.png", { 0.5f });
    make_map("photo.png", { 0.4f, 0.5f, 0.5f });
    make_map("object.png", { 0.9f, 0.5f, 0.2f });
    refused(1, "\"no.png\"", line + "no.png");
    refused(1, "\"quad.obj\"", line + "quad.obj");
    refused(1, "\"bump.png\": one channel: a bump or height map", line + "bump.png");
    refused(1, "\"photo.png\": 100 % of its pixels are not unit vectors", line + "photo.png");
    refused(2, "with unwrap the mesh gets other UVs", line + "object.png --unwrap");
    refused(2, "--normal-map-green down: no normal map is given",
            "makevismap quad.obj -o x.exr --normal-map-green down");
    refused(2, "has no up and down", line + "object.png --normal-map-space object --normal-map-green down");
    EXPECT_THAT(done(line + "object.png"),
                HasSubstr("point into the surface; if it is in object space, set normal_map_space"));
    write("bad.vismap", "mesh = \"quad.obj\"\nnormal_map = \"no.png\"\n");
    refused(1, "\"no.png\"", "makevismap bad.vismap -o x.exr");
}

TEST_F(NormalMaps, TilesHaveTheirOwn)
{
    write("two.obj", kQuad + "vt 1 0\nvt 2 0\nvt 2 1\nvt 1 1\nf 1/5/1 2/6/1 3/7/1 4/8/1\n");
    make_map("n.1001.png", { 0.5f, 0.5f, 1 });
    make_map("n.1002.png", { 0.8f, 0.5f, 0.9f });
    done("makevismap two.obj --normal-map 'n.<UDIM>.png' --channels normal -o 'a.<UDIM>.exr'" + small);
    EXPECT_EQ(greatest_x("a.1001.exr"), 0);
    EXPECT_NEAR(greatest_x("a.1002.exr"), 0.6f, 0.01f);
}

namespace {

// The quad of kQuad, its lower right half of material A and its upper left one of B; A's texture is as `statement`
// says.
class MaterialNormals : public NormalMaps
{
protected:
    MaterialNormals()
    {
        write("halves.obj",
              "mtllib halves.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n"
              "usemtl A\nf 1/1/1 2/2/1 3/3/1\nusemtl B\nf 1/1/1 3/3/1 4/4/1\n");
        make_map("n.png", { 0.8f, 0.5f, 0.9f });
    }
    std::string bake(const std::string& name, const std::string& statement, const std::string& flags) const
    {
        write("halves.mtl", "newmtl A\n" + statement + "\nnewmtl B\nKd 1 1 1\n");
        return done("makevismap halves.obj --channels normal --margin 0 -o " + name + " " + flags + small);
    }
};

} // namespace

TEST_F(MaterialNormals, EachTexelHasThatOfItsTriangle)
{
    EXPECT_THAT(bake("own.exr", "norm n.png", "--material-normals"), HasSubstr("normal maps: of 1 material"));
    bake("whole.exr", "Kd 1 1 1", "--normal-map n.png");
    bake("none.exr", "norm n.png", "");
    const Pixels own = pixels("own.exr"), whole = pixels("whole.exr"), none = pixels("none.exr");
    ASSERT_EQ(own.values.size(), whole.values.size());
    int mapped = 0, plain = 0;
    for (int y = 0; y < own.height; ++y)
        for (int x = 0; x < own.width; ++x) {
            const size_t first = size_t(y * own.width + x) * size_t(own.channels), end = first + size_t(own.channels);
            const bool is_own = x + y >= own.width; // row 0 is the top
            for (size_t i = first; i < end; ++i)
                EXPECT_TRUE(x + y == own.width - 1 || own.values[i] == (is_own ? whole.values[i] : none.values[i]))
                    << x << " " << y;
            mapped += is_own;
            plain += !is_own;
        }
    EXPECT_GT(std::min(mapped, plain), 10);
    EXPECT_EQ(attribute("own.exr", "vmlight:material_normals"), "true");
    EXPECT_EQ(attribute("none.exr", "vmlight:material_normals"), "");
    write("halves.vismap",
          "mesh = \"halves.obj\"\nmaterial_normals = true\nresolution = 8\nsamples = 16\nmargin = 0\n"
          "channels = [\"normal\"]\n");
    write("halves.mtl", "newmtl A\nnorm n.png\nnewmtl B\nKd 1 1 1\n");
    done("makevismap halves.vismap -o recipe.exr");
    expect_same_pixels("recipe.exr", "own.exr", 0);
    done("makevismap halves.vismap --effects -normal-map -o off.exr");
    expect_same_pixels("off.exr", "none.exr", 0);
}

TEST_F(MaterialNormals, AScaleMultipliesTheLean)
{
    bake("half.exr", "norm -bm 0.5 n.png", "--material-normals");
    // n.png leans by x / z = .6 / .8.
    const double lean = 0.5 * 0.6 / 0.8;
    EXPECT_NEAR(double(greatest_x("half.exr")), lean / std::sqrt(1 + lean * lean), 0.01);
    EXPECT_THAT(bake("zero.exr", "norm -bm 0 n.png", "--material-normals --explain"),
                testing::AllOf(HasSubstr("flat, so that nothing changes"),
                               HasSubstr("no material names one that is not flat")));
    bake("none.exr", "norm n.png", "");
    expect_same_pixels("zero.exr", "none.exr", 0);
}

TEST_F(MaterialNormals, WhatIsElsewhereIsLeftOutWithAWarning)
{
    EXPECT_THAT(bake("a.exr", "norm -s 2 2 1 n.png", "--material-normals"),
                HasSubstr("material \"A\": its normal map is moved, scaled or turned in the UVs: left out"));
    bake("none.exr", "norm n.png", "");
    expect_same_pixels("a.exr", "none.exr", 0);
    EXPECT_THAT(bake("a.exr", "map_Bump n.png", "--material-normals"), HasSubstr("normal maps: of 0 materials"));
    const std::string command = "makevismap halves.obj --material-normals -o x.exr";
    refused(2, "--material-normals: a normal map is given too", command + " --normal-map n.png");
    refused(2, "--material-normals: with unwrap", command + " --unwrap");
    refused(2, "normal maps of materials are in tangent space", command + " --normal-map-space object");
    write("halves.mtl", "newmtl A\nnorm gone.png\n");
    refused(1, "\"halves.obj\": material \"A\": its normal map: \"gone.png\": no such file", command);
    make_map("gray.png", { 0.5f });
    write("halves.mtl", "newmtl A\nnorm gray.png\n");
    refused(1, "material \"A\": its normal map: one channel: a bump or height map", command);
}
