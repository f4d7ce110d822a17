// SPDX-License-Identifier: Apache-2.0
// Bounced light on the command line, against what radiosity says.
#include "bounce_corner.h"

#include <OpenImageIO/imagebuf.h>

#include <array>
#include <cmath>
#include <string>

using namespace vmlight;
using testing::HasSubstr;

namespace {

using Bounce = BounceTest;

// What a floor gets at a distance from a wall as high as it is wide, both white: from the sky, and from the wall. In
// two dimensions, by quadrature.
struct WhiteCorner
{
    double direct, bounced = 0;

    explicit WhiteCorner(double x)
        : direct(1 - hidden(x))
    {
        constexpr int n = 2000;
        for (int i = 0; i < n; ++i) {
            const double h = (i + 0.5) / n;
            bounced += (1 - hidden(h)) * 0.5 * x * h / std::pow(x * x + h * h, 1.5) / n;
        }
    }
    static double hidden(double x) { return 0.5 * (1 - x / std::sqrt(x * x + 1)); }
};

} // namespace

TEST_F(Bounce, AWhiteCornerGetsWhatRadiositySays)
{
    EXPECT_THAT(done("makelightmap corner.vismap sky.exr --albedo white.exr --bounce auto -o lit.exr"),
                HasSubstr("bounce: "));
    done("makelightmap corner.vismap sky.exr --albedo white.exr -o plain.exr");
    for (int x = 0; x < 64; ++x) {
        const WhiteCorner wanted((x % 32 + 0.5) / 32);
        EXPECT_NEAR(value("lit.exr", x), wanted.direct + wanted.bounced, 0.03) << x;
        EXPECT_NEAR(value("lit.exr", x) - value("plain.exr", x), wanted.bounced, 0.03) << x;
    }
}

TEST_F(Bounce, ColoursBleed)
{
    done("makelightmap corner.vismap sky.exr --albedo red_floor.exr --bounce auto -o lit.exr");
    done("makelightmap corner.vismap sky.exr --albedo red_floor.exr -o plain.exr");
    for (const int x : { 36, 40, 50, 60 }) { // the wall gets the red of the floor alone
        EXPECT_GT(value("lit.exr", x), 1.05f * value("plain.exr", x)) << x;
        EXPECT_EQ(value("lit.exr", x, 1), value("plain.exr", x, 1)) << x;
        EXPECT_EQ(value("lit.exr", x, 2), value("plain.exr", x, 2)) << x;
    }
    EXPECT_EQ(value("lit.exr", 10, 1), 0);
}

TEST_F(Bounce, OccludersWithoutAColourHaveTheAlbedoThatIsGiven)
{
    const std::string light = "makelightmap shaded.vismap sky.exr --albedo white.exr ";
    done(light + "-o plain.exr");
    done(light + "--bounce auto --bounce-albedo 1 -o white_wall.exr");
    done(light + "--bounce auto -o grey_wall.exr");
    done(light + "--bounce auto --bounce-albedo 0 -o black_wall.exr");
    expect_same_pixels("plain.exr", "black_wall.exr", 0);
    for (const int x : { 2, 8, 20, 40 }) {
        const WhiteCorner wanted((x + 0.5) / 64);
        const float plain = value("plain.exr", x), added = value("white_wall.exr", x) - plain;
        EXPECT_NEAR(value("grey_wall.exr", x) - plain, 0.5f * added, 1e-5f) << x;
        EXPECT_NEAR(added, wanted.bounced, 0.03) << x;
    }
    // One with a colour has that.
    write("wall.mtl", "newmtl paint\nKd 0.2 0.4 0.8\n");
    write("wall.obj", "mtllib wall.mtl\nusemtl paint\nv 0 0 10\nv 0 0 -10\nv 0 1 -10\nv 0 1 10\nf 1 2 3 4\n");
    done(light + "--bounce auto -o paint.exr");
    const std::array<float, 3> paint { 0.2f, 0.4f, 0.8f };
    for (int c = 0; c < 3; ++c) {
        const float plain = value("plain.exr", 8, c);
        EXPECT_NEAR(value("paint.exr", 8, c) - plain, paint[size_t(c)] * (value("white_wall.exr", 8, c) - plain),
                    0.002f);
    }
}

TEST_F(Bounce, ASunBouncesToo)
{
    // From the right and above: it lights the wall, and the floor; the wall lights the floor more than the sky alone
    // would have it.
    OIIO::ImageBuf sky(OIIO::ImageSpec(512, 256, 3, OIIO::TypeFloat));
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 512; ++x) {
            const bool sun = (x == 127 || x == 128) && (y == 63 || y == 64);
            const float value = sun ? 1e4f : 1, rgb[3] { value, value, value };
            sky.setpixel(x, y, rgb);
        }
    ASSERT_TRUE(sky.write(path("sunny.exr"))) << sky.geterror();
    const std::string light = "makelightmap corner.vismap sunny.exr --suns auto --albedo white.exr ";
    done(light + "-o plain.exr");
    done(light + "--bounce auto -o lit.exr");
    const double flux = 1e4 * 4 * std::pow(M_PI / 256, 2) * std::sin(M_PI / 4) / M_PI, sun = flux * std::sin(M_PI / 4);
    // The wall is evenly lit by the sun: floor texels get its light times what they see of the wall.
    for (const int x : { 4, 12, 24 }) {
        const double at = (x + 0.5) / 32;
        const WhiteCorner wanted(at);
        EXPECT_NEAR(value("lit.exr", x) - value("plain.exr", x), wanted.bounced + sun * WhiteCorner::hidden(at),
                    0.03 * (1 + sun))
            << x;
    }
    // An occluder's points see the sun as well.
    done("makelightmap shaded.vismap sunny.exr --suns auto --albedo white.exr -o plain.exr");
    done("makelightmap shaded.vismap sunny.exr --suns auto --albedo white.exr --bounce auto --bounce-albedo 1 "
         "-o lit.exr");
    for (const int x : { 8, 24, 48 }) {
        const double at = (x + 0.5) / 64;
        const WhiteCorner wanted(at);
        EXPECT_NEAR(value("lit.exr", x) - value("plain.exr", x), wanted.bounced + sun * WhiteCorner::hidden(at),
                    0.03 * (1 + sun))
            << x;
    }
}

TEST_F(Bounce, TilesOfUdimLightEachOther)
{
    // The floor is on the first tile, the wall on the next.
    write("tiles.obj",
          "v 0 0 10\nv 1 0 10\nv 1 0 -10\nv 0 0 -10\nv 0 1 10\nv 0 1 -10\n"
          "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 2 0\nvt 2 1\nvn 0 1 0\nvn 1 0 0\n"
          "f 1/1/1 2/2/1 3/3/1 4/4/1\nf 1/2/2 4/3/2 6/6/2 5/5/2\n");
    done("makevismap tiles.obj --resolution 64 --samples 256 -o 'vm.<UDIM>.exr'");
    const std::string light = "makelightmap 'vm.<UDIM>.exr' sky.exr --albedo white.exr ";
    done(light + "--mesh tiles.obj --bounce auto -o 'lit.<UDIM>.exr'");
    done(light + "-o 'plain.<UDIM>.exr'");
    // What is off the map sends light in cells of 1/128 of the mesh at least, which is 20 long: not beside the edge.
    for (const char* tile : { "1001", "1002" })
        for (int x = 10; x < 64; ++x) {
            const WhiteCorner wanted((x + 0.5) / 64);
            const std::string suffix = std::string(".") + tile + ".exr";
            EXPECT_NEAR(value("lit" + suffix, x) - value("plain" + suffix, x), wanted.bounced, 0.03)
                << tile << " " << x;
        }
}

TEST_F(Bounce, WhatIsTransparentChangesNothing)
{
    write("glass.mtl", "newmtl glass\nKd 1 0 0\nd 0\n");
    write("glass.obj", "mtllib glass.mtl\nusemtl glass\nv .3 0 9\nv .3 0 -9\nv .3 1 -9\nv .3 1 9\nf 1 2 3 4\n");
    done("makevismap floor.obj --occluder wall.obj --resolution 64 --samples 64 -o vm.exr");
    done("makevismap floor.obj --occluder wall.obj --occluder glass.obj --resolution 64 --samples 64 -o both.exr");
    const std::string light = " sky.exr --albedo white.exr --bounce auto --mesh floor.obj --occluder wall.obj";
    done("makelightmap vm.exr" + light + " -o a.exr");
    done("makelightmap both.exr" + light + " --occluder glass.obj -o b.exr");
    expect_same_pixels("a.exr", "b.exr", 0);
    done("makelightmap vm.exr sky.exr --albedo white.exr -o plain.exr");
    EXPECT_GT(value("b.exr", 20), value("plain.exr", 20) + 0.02f);
}

TEST_F(Bounce, ANormalMapIsThatOfTheRecipe)
{
    // Leaning away from the wall by 45 degrees: less of it, and some of the floor itself.
    OIIO::ImageBuf normals(OIIO::ImageSpec(4, 4, 3, OIIO::TypeFloat));
    const float leaning = 0.5f + 0.5f * std::sqrt(0.5f);
    for (OIIO::ImageBuf::Iterator<float> p(normals); !p.done(); ++p)
        p[0] = leaning, p[1] = 0.5f, p[2] = leaning;
    ASSERT_TRUE(normals.write(path("lean.exr"))) << normals.geterror();
    write("lean.vismap",
          "mesh = \"floor.obj\"\noccluder = [\"wall.obj\"]\nresolution = 64\nsamples = 256\nnormal_map = "
          "\"lean.exr\"\n");
    const std::string light = " sky.exr --albedo white.exr ";
    done("makelightmap lean.vismap" + light + "-o plain.exr");
    done("makelightmap lean.vismap" + light + "--bounce auto --bounce-albedo 0 -o own.exr");
    // Far from the wall: V of the leaning normal, and that much of what the floor sends back.
    const double self = (1 - std::sqrt(0.5)) / 2, sky = value("plain.exr", 60);
    EXPECT_NEAR(value("own.exr", 60) - value("plain.exr", 60), self * sky, 0.02);
    done("makevismap lean.vismap -o vm.exr");
    refused(1, "baked with the normal map \"lean.exr\"",
            "makelightmap vm.exr" + light + "--bounce auto --mesh floor.obj --occluder wall.obj -o c.exr");
}
