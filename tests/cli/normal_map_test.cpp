// SPDX-License-Identifier: Apache-2.0
// --normal-map on the command line and in recipes.
#include "command_test.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
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
                testing::ContainsRegex("calls for normal-map, left out: V is off by about 0\\.1"));
    done("makevismap quad.obj -o c.exr" + small);
    expect_same_pixels("b.exr", "c.exr", 0);
    // How far off a picture is without it takes the map itself.
    write("quad.vismap", "mesh = \"quad.obj\"\nnormal_map = \"no.png\"\neffects = \"-normal-map\"\n");
    refused(1, "\"quad.vismap\": \"no.png\": no such file", "makevismap quad.vismap -o d.exr" + small);
    refused(1, "+normal-map is impossible: no --normal-map is given",
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
    refused(1, "\"photo.png\": 100 % of its pixels are no directions", line + "photo.png");
    refused(2, "with unwrap the mesh gets other UVs", line + "object.png --unwrap");
    refused(2, "--normal-map-green down: no normal map is given",
            "makevismap quad.obj -o x.exr --normal-map-green down");
    refused(2, "has no up and down", line + "object.png --normal-map-space object --normal-map-green down");
    EXPECT_THAT(done(line + "object.png"), HasSubstr("point into the surface"));
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
