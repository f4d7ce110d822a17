// SPDX-License-Identifier: Apache-2.0
// Meshes on the command line: what is refused, warned about, and baked.
#include "command_test.h"

#include <OpenImageIO/strutil.h>

#include <filesystem>

using namespace vmlight;
using OIIO::Strutil::replace;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

namespace {

class Meshes : public CommandTest
{ };

// All 256 values of a byte, `times` over.
std::string noise(int times)
{
    std::string bytes;
    for (int i = 0; i < 256 * times; ++i)
        bytes += char(i);
    return bytes;
}

} // namespace

TEST_F(Meshes, WhatIsNotAMeshIsRefusedInWords)
{
    refused(1, "\"missing.obj\": no such file", "makevismap missing.obj -o x.exr");
    std::filesystem::create_directory("folder.obj");
    refused(1, "\"folder.obj\": not a file", "makevismap folder.obj -o x.exr");
    const std::pair<std::string, std::string> files[] = {
        { "empty.obj", "" },
        { "noise.obj", noise(64) },
        { "noise.glb", "glTF" + noise(64) },
        { "noise.ply", "ply\nformat ascii 1.0\nelement vertex 3\n" + noise(1) },
        { "huge.ply", "ply\nformat ascii 1.0\nelement vertex 99999999999\nproperty float x\nend_header\n" },
        { "text.txt", "hello" },
        { "points.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n" },
        { "cut.glb", std::string("glTF\2\0\0\0", 8) },
    };
    for (const auto& [name, bytes] : files)
        refused(1, "\"" + name + "\": ", "makevismap " + write(name, bytes) + " -o x.exr");
}

TEST_F(Meshes, AMeshWithoutUvsIsRefused)
{
    write("bare.obj", kQuadWithoutUv);
    refused(1, "\"bare.obj\": no texture coordinates", "makevismap bare.obj -o x.exr");
    std::filesystem::create_directory("meshes");
    write("meshes/bare.obj", kQuadWithoutUv);
    refused(1, "\"meshes/bare.obj\": no texture coordinates", "makevismap meshes/bare.obj -o x.exr");
    write("quad.obj", kQuad);
    refused(1, "no texture coordinates", "makevismap quad.obj -o x.exr --uv-set 1");
}

TEST_F(Meshes, AVertexThatIsNotFiniteIsNamed)
{
    write("nan.obj", replace(kQuad, "v 1 1 0", "v nan 1 0"));
    refused(1, "is not finite", "makevismap nan.obj -o x.exr");
}

TEST_F(Meshes, SurprisesAreWarnedAboutWithTheirCounts)
{
    const std::string triangle = "f 1/1/1 2/2/1 3/3/1\n";
    write("double.obj", kQuad + triangle);
    EXPECT_THAT(done("makevismap double.obj -o x.exr --resolution 8 --samples 4"),
                HasSubstr("WARNING: 36 texels (56.25 % of the covered ones) belong to more than one triangle"));
    write("outside.obj", replace(kQuad, "vt 1 1", "vt 2 2"));
    const std::string said = done("makevismap outside.obj -o x.exr --resolution 8 --samples 4");
    EXPECT_THAT(said, HasSubstr("WARNING: 2 of 2 triangles reach outside [0,1] in UV, into other UDIM tiles"));
    EXPECT_THAT(said, Not(HasSubstr("all UDIM tiles")));
    write("below.obj", replace(kQuad, "vt 1 1", "vt -1 -1"));
    const std::string below = done("makevismap below.obj -o x.exr --resolution 8 --samples 4");
    EXPECT_THAT(below, HasSubstr("WARNING: 2 of 2 triangles reach outside all UDIM tiles"));
    EXPECT_THAT(below, Not(HasSubstr("--udim"))) << "no tile has them";
    // A map of one texel, and one triangle of two.
    write("one.obj",
          replace(kQuad, "f 1/1/1 2/2/1 3/3/1 4/4/1\n", "vt 2 2\n" + triangle + triangle + "f 1/1/1 2/2/1 3/5/1\n"));
    const std::string printed = done("makevismap one.obj -o x.exr --resolution 1 --samples 4");
    EXPECT_THAT(printed, HasSubstr("uv: 3 triangles cover"));
    EXPECT_THAT(printed, HasSubstr("; 1 texel is shared;"));
    EXPECT_THAT(printed,
                HasSubstr("WARNING: 1 texel (100.00 % of the covered ones) belongs to more than one triangle: the "
                          "first triangle in the file wins"));
    EXPECT_THAT(printed, HasSubstr("WARNING: 1 of 3 triangles reaches outside [0,1]"));
}

TEST_F(Meshes, AnOccluderCasts)
{
    write("quad.obj", kQuad);
    write("lid.obj", "v -9 -9 0.1\nv 9 -9 0.1\nv 9 9 0.1\nv -9 9 0.1\nf 1 2 3 4\n");
    done("makevismap quad.obj -o open.exr --resolution 4 --samples 64");
    done("makevismap quad.obj --occluder lid.obj -o lid.exr --resolution 4 --samples 64");
    EXPECT_EQ(visibility("open.exr").least(), 1);
    EXPECT_LT(visibility("lid.exr").greatest(), 0.1);
    refused(1, "\"gone.obj\": no such file", "makevismap quad.obj --occluder gone.obj -o x.exr");
}
