// SPDX-License-Identifier: Apache-2.0
#include "mesh_fixture.h"
#include "strand_files.h"

#include <vmlight/mesh/export/write_mesh.h>
#include <vmlight/mesh/import/strands/read_strands.h>
#include <vmlight/mesh/strand_curve.h>

#include <gmock/gmock.h>

#include <cmath>

using namespace mesh_files;
using namespace vmlight::strand_files;
using testing::HasSubstr;

namespace {

class StrandFiles : public MeshFiles
{
protected:
    Strands strands(const char* name, const std::string& bytes, const std::string& radius = "0.1",
                    const MeshParams& params = {})
    {
        Strands result;
        std::string error;
        EXPECT_TRUE(read_strands(result, folder.write(name, bytes), params, radius, error)) << error;
        return result;
    }
    /// What is said, less the path at its head if that is there.
    std::string refused(const char* name, const std::string& bytes, const std::string& radius = "0.1")
    {
        Strands result;
        std::string error;
        const std::string path = folder.write(name, bytes), head = "\"" + path + "\": ";
        EXPECT_FALSE(read_strands(result, path, {}, radius, error));
        EXPECT_EQ(error.find('\n'), std::string::npos) << error;
        return error.compare(0, head.size(), head) == 0 ? error.substr(head.size()) : error;
    }
};

// A line strip (0,0,0) (1,0,0) (0,1,0) under a node that is moved by (5, 0, 0) and scaled by 2.
std::string gltf_line(const std::string& more_of_node = "", const std::string& mode = "3")
{
    const std::string bytes = raw<float>({ 0, 0, 0, 1, 0, 0, 0, 1, 0 });
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"translation":[5,0,0],
"scale":[2,2,2])"
        + more_of_node + R"(}],"meshes":[{"name":"hair","primitives":[{"mode":)" + mode
        + R"(,"attributes":{"POSITION":0}}]}],"skins":[{"joints":[0]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,)"
        + base64(bytes) + "\"}]}";
}

} // namespace

TEST_F(StrandFiles, TressFxHasStrandsOfEqualCounts)
{
    const Strands hair = strands("a.tfx", tfx(2, 3), "0.2:0.1");
    ASSERT_EQ(hair.count(), 2u);
    EXPECT_EQ(hair.begin(1), 3u);
    EXPECT_EQ(hair.end(1), 6u);
    EXPECT_EQ(hair.points[5], V3d(1, 2, 0));
    EXPECT_NEAR(hair.radii[3], .2, 1e-15);
    EXPECT_NEAR(hair.radii[4], .15, 1e-15);
    EXPECT_NEAR(hair.radii[5], .1, 1e-15);
    EXPECT_TRUE(is_strand_file(folder / "a.tfx"));
}

TEST_F(StrandFiles, HairHasStrandsOfUnequalCountsAndHalfItsThicknessAsRadius)
{
    const Strands own = strands("a.hair", hair(true), "");
    EXPECT_EQ(own.ends, (std::vector<uint32_t> { 2, 5 }));
    EXPECT_EQ(own.points[3], V3d(3, 1, 0));
    EXPECT_NEAR(own.radii[2], .2, 1e-8);
    EXPECT_NEAR(strands("b.hair", hair(true), "0.3").radii[2], .3, 1e-15);
    EXPECT_NEAR(strands("c.hair", hair(false, 5, .5f), "").radii[0], .25, 1e-8);
    // By its content, whatever its name.
    EXPECT_TRUE(is_strand_file(folder.write("a.bin", hair(true))));
}

TEST_F(StrandFiles, LinesOfAnObjThatMeetAreOneStrand)
{
    const std::string points = "v 0 0 0\nv 0 1 0\nv 0 2 0\nv 4 0 0\nv 4 1 0\n";
    const Strands edges = strands("a.obj", points + "l 1 2\nl 2 3\nl 4 5\n");
    EXPECT_EQ(edges.ends, (std::vector<uint32_t> { 3, 5 }));
    EXPECT_EQ(edges.points[2], V3d(0, 2, 0));
    const Strands polylines = strands("b.obj", points + "l 1/1 2/2 3/3\nl -2 -1\nf 1 2 3\n");
    EXPECT_EQ(polylines.points, edges.points);
    EXPECT_EQ(polylines.ends, edges.ends);
    EXPECT_FALSE(is_strand_file(folder / "b.obj"));
}

TEST_F(StrandFiles, LineStripsOfAGltfAreWhereTheirNodesAre)
{
    const Strands line = strands("a.gltf", gltf_line());
    EXPECT_EQ(line.ends, (std::vector<uint32_t> { 3 }));
    EXPECT_EQ(line.points, (std::vector<V3d> { { 5, 0, 0 }, { 7, 0, 0 }, { 5, 2, 0 } }));
    EXPECT_FALSE(is_strand_file(folder / "a.gltf"));
}

TEST_F(StrandFiles, WhatIsWrittenIsReadAgain)
{
    const Strands written = strands("a.hair", hair(false));
    const std::vector<Imath::V2f> uvs { { .25f, .75f }, { .5f, .75f }, { .25f, .25f }, { .5f, .25f }, { .75f, .25f } };
    for (const char* name : { "b.obj", "b.glb" }) {
        SCOPED_TRACE(name);
        std::string error;
        ASSERT_TRUE(write_strands(written, uvs, folder / name, error)) << error;
        Strands again;
        ASSERT_TRUE(read_strands(again, folder / name, {}, "0.1", error)) << error;
        EXPECT_EQ(again.ends, written.ends);
        EXPECT_EQ(again.points, written.points);
    }
    EXPECT_THAT(folder.bytes("b.obj"), HasSubstr("\nvt 0.75 0.25\nl 1/1 2/2\nl 3/3 4/4 5/5\n"));
    std::string error;
    EXPECT_FALSE(write_strands(written, uvs, folder / "b.ply", error));
    EXPECT_THAT(error, HasSubstr("is written as .glb or .obj"));
}

TEST_F(StrandFiles, ZUpTurnsToYUp)
{
    MeshParams params;
    params.up = "z";
    EXPECT_EQ(strands("a.obj", "v 1 2 3\nv 1 2 4\nl 1 2\n", "1", params).points[0], V3d(1, 3, -2));
}

TEST_F(StrandFiles, BrokenTressFxIsRefused)
{
    EXPECT_EQ(refused("a.tfx", ""), "not TressFX: 0 bytes, shorter than its header of 160");
    EXPECT_EQ(refused("a.tfx", tfx(2, 3, 3)), "not TressFX 4: its version is 3");
    EXPECT_EQ(refused("a.tfx", tfx(0, 3)), "0 strands of 3 points: needs at least 1 of 2");
    EXPECT_EQ(refused("a.tfx", tfx(2, 1)), "2 strands of 1 points: needs at least 1 of 2");
    EXPECT_EQ(refused("a.tfx", tfx(2, 3, 4, 16)), "the points start at byte 16, within the header of 160");
    const std::string whole = tfx(2, 3);
    EXPECT_EQ(refused("a.tfx", whole.substr(0, whole.size() - 1)),
              "ends early: 2 strands of 3 points from byte 160 on need 256 bytes, the file has 255");
    std::string huge = whole;
    huge.replace(4, 8, raw<uint32_t>({ 0xffffffff, 0xffffffff }));
    EXPECT_EQ(refused("a.tfx", huge).compare(0, 10, "ends early"), 0);
    EXPECT_EQ(refused("a.tfx", whole, ""),
              "the file has no radius of its strands: give it by --radius ROOT:TIP, in mesh units");
}

TEST_F(StrandFiles, BrokenHairIsRefused)
{
    const std::string whole = hair(true);
    EXPECT_EQ(refused("a.hair", whole.substr(0, 100)), "ends early: 100 bytes, shorter than its header of 128");
    EXPECT_EQ(refused("a.hair", whole.substr(0, 129)), "ends early: 2 strands have no room for their segments");
    EXPECT_EQ(refused("a.hair", whole.substr(0, whole.size() - 1)), "ends early: no room for 5 points behind byte 132");
    EXPECT_EQ(refused("a.hair", hair(true, 6)), "its strands have 5 points, its header says 6");
    EXPECT_EQ(refused("a.hair", "nonsense"), "not HAIR: does not start with \"HAIR\"");
    EXPECT_EQ(refused("a.hair", hair(false), ""),
              "the file has no radius of its strands: give it by --radius ROOT:TIP, in mesh units");
    std::string many = whole;
    many.replace(4, 16, raw<uint32_t>({ 0xffffffff, 5, 2, 0xffffffff }));
    EXPECT_EQ(refused("a.hair", many), "its strands have 18446744069414584320 points, its header says 5");
    std::string none = whole;
    none[12] = 1;
    EXPECT_EQ(refused("a.hair", none), "has no array of points");
}

TEST_F(StrandFiles, BrokenLinesAreRefused)
{
    EXPECT_EQ(refused("a.obj", "v 0 0 0\nv 1 0 0\nf 1 2 1\n"), "no strands: it has no `l` statement");
    EXPECT_EQ(refused("a.obj", "v 0 0 0\nv 1 0 0\nl 1 3\n"), "line 3 uses vertex 3, but there are only 2 before it");
    EXPECT_EQ(refused("a.obj", "v 0 0 0\nv 1 0 0\nl 1.5 2\n"),
              "line 3 uses vertex 1.5, but there are only 2 before it");
    EXPECT_EQ(refused("a.obj", "v 0 0 0\nv 1 0 0\nl 0 2\n"), "line 3 uses vertex 0, but there are only 2 before it");
    EXPECT_NE(refused("a.obj", "v 0 0 0\nv 1 0 0\nl 1\n").find("line 3 has fewer than two points"), std::string::npos);
    EXPECT_NE(refused("a.obj", "v 0 0\nl 1 1\n").find("line 1 is no vertex"), std::string::npos);
    EXPECT_EQ(refused("a.gltf", gltf_line("", "1")), "no strands: it shows no primitive of mode LINE_STRIP");
    EXPECT_EQ(refused("a.gltf", gltf_line(R"(,"skin":0)")), "strands of mesh \"hair\" are skinned, which is not read");
    EXPECT_NE(refused("a.ply", "ply\n").find("unknown format of strands"), std::string::npos);
    Strands none;
    std::string error;
    EXPECT_FALSE(read_strands(none, folder / "none.tfx", {}, "1", error));
    EXPECT_NE(error.find("no such file"), std::string::npos);
}

TEST_F(StrandFiles, StrandsThatCannotBeAreRefused)
{
    EXPECT_EQ(refused("a.obj", "v 1 1 1\nv 1 1 1\nl 1 2\n"), "strand 0 has no length");
    EXPECT_EQ(refused("a.obj", "v 0 0 0\nv 1 nan 0\nl 1 2\n"), "point 1 of strand 0 is not finite: (1, nan, 0)");
    const std::string line = "v 0 0 0\nv 1 0 0\nl 1 2\n";
    for (const char* radius : { "0", "0:0" })
        EXPECT_NE(refused("a.obj", line, radius).find("has no thickness"), std::string::npos) << radius;
    for (const char* radius : { "thin", "1:", ":1", "1:2:3", "-1", "inf" })
        EXPECT_NE(refused("a.obj", line, radius).find("is not ROOT:TIP"), std::string::npos) << radius;
}

TEST(Strands, ManyThatAreTooThickForAGroomAreWarnedOf)
{
    const auto warning = [](size_t count, double radius) {
        Strands strands;
        for (size_t s = 0; s < count; ++s) {
            const double x = double(s) / double(count - 1);
            strands.points.insert(strands.points.end(), { { x, 0, 0 }, { x, 0.5, 0 } });
            strands.radii.insert(strands.radii.end(), { radius, radius / 2 });
            strands.ends.push_back(uint32_t(strands.points.size()));
        }
        return thick_strands_warning(strands);
    };
    EXPECT_EQ(warning(200, 0.019), "");
    EXPECT_EQ(
        warning(200, 0.04),
        "strands with a radius of 0.04 in a groom 1 across hide each other and bake slowly; are radii in mesh units?");
    EXPECT_EQ(warning(50, 0.04), "") << "a fence";
}

TEST(StrandCurve, AStraightStrandIsItself)
{
    const Strands strands = straight({ { V3d(1, 2, 3), V3d(1, 6, 3) } }, .5, 3);
    const StrandCurve curve(strands, 0);
    for (const double share : { 0.0, .1, .5, 1.0 }) {
        const CurvePoint point = curve.at(share);
        EXPECT_LT((point.position - V3d(1, 2 + 4 * share, 3)).length(), 1e-14);
        EXPECT_LT((point.tangent - V3d(0, 1, 0)).length(), 1e-14);
        EXPECT_NEAR(point.radius, .5, 1e-15);
    }
}

TEST(StrandCurve, CutsKeepTheCurveAndMeetTheLimit)
{
    Strands strands = straight({ { V3d(0), V3d(3, 0, 0) } }, .001, 4);
    strands.points[1] += V3d(0, 1, 0);
    const StrandCurve whole(strands, 0);
    StrandCurve fine = whole;
    ASSERT_TRUE(fine.cut(100, 1000));
    EXPECT_GE(fine.controls().size(), 3u / .1);
    // Lengths are of chords, so that shares move a little.
    for (const double share : { 0.0, .3, .7, 1.0 })
        EXPECT_LT((fine.at(share).position - whole.at(share).position).length(), .05) << share;
    EXPECT_LT((fine.at(1).position - V3d(3, 0, 0)).length(), 1e-12);
    StrandCurve thin = whole;
    EXPECT_FALSE(thin.cut(100, 8));
}

TEST(StrandCurve, PointsThatCoincideHaveATangent)
{
    Strands strands = straight({ { V3d(0), V3d(0, 0, 2) } }, .1, 5);
    for (size_t p = 0; p < 4; ++p)
        strands.points[p] = V3d(0);
    const StrandCurve curve(strands, 0);
    for (const double share : { 0.0, .25, .5, 1.0 })
        EXPECT_NEAR(curve.at(share).tangent.z, 1, 1e-12) << share;
}
