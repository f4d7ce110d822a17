// SPDX-License-Identifier: Apache-2.0
// Reading meshes from files. Nodes: mesh_nodes_test.cpp; normals, merging and hashes: mesh_normals_test.cpp.
#include "mesh_fixture.h"

#include <OpenImageIO/strutil.h>
#include <vmlight/mesh/import/read_mesh.h>

#include <cmath>

using namespace mesh_files;

TEST_F(MeshFiles, ObjKeepsPositionsNormalsAndTextureCoordinates)
{
    const Mesh mesh = read("quad.obj", kQuadObj);
    EXPECT_EQ(mesh.name, "quad.obj");
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(mesh.triangle_materials.size(), 2u);
    ASSERT_EQ(mesh.positions.size(), 4u);
    ASSERT_EQ(mesh.normals.size(), 4u);
    ASSERT_EQ(mesh.uvs.size(), 4u);
    for (size_t v = 0; v < 4; ++v) {
        EXPECT_EQ(mesh.normals[v], V3f(0, 0, 1));
        EXPECT_EQ(mesh.uvs[v], V2f(mesh.positions[v].x > 0 ? 0.9f : 0.1f, mesh.positions[v].y > 0 ? 0.8f : 0.2f));
    }
    EXPECT_EQ(area_vector(mesh), V3d(0, 0, 6)); // counter-clockwise, as in the file
}

TEST_F(MeshFiles, PlyIsRead)
{
    const Mesh mesh
        = read("a.ply",
               "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
               "property float s\nproperty float t\nelement face 1\n"
               "property list uchar int vertex_indices\nend_header\n"
               "0 0 0 0 0\n2 0 0 1 0\n2 3 0 1 1\n0 3 0 0 1\n4 0 1 2 3\n");
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(area_vector(mesh), V3d(0, 0, 6));
    ASSERT_EQ(mesh.uvs.size(), 4u);
    for (size_t v = 0; v < 4; ++v) {
        EXPECT_EQ(mesh.uvs[v], V2f(float(mesh.positions[v].x / 2), float(mesh.positions[v].y / 3)));
        EXPECT_LT((mesh.normals[v] - V3f(0, 0, 1)).length(), 1e-6f); // made: the file has none
    }
}

TEST_F(MeshFiles, PolygonsAreCutIntoTrianglesWhateverTheirSize)
{
    // A convex hexagon, an L, and a concave quad; at sizes where absolute tolerances would lose them.
    for (double size : { 1.0, 1e-6, 1e6 }) {
        const auto file = [&](const std::vector<std::array<double, 2>>& corners) {
            std::string text, face = "f";
            for (size_t i = 0; i < corners.size(); ++i) {
                char line[100];
                std::snprintf(line, sizeof(line), "v %.9g %.9g 0\n", corners[i][0] * size, corners[i][1] * size);
                text += line;
                face += " " + std::to_string(i + 1);
            }
            return text + face + "\n";
        };
        const double h = std::sqrt(0.75);
        const Mesh hexagon
            = read("a.obj", file({ { 1, 0 }, { 0.5, h }, { -0.5, h }, { -1, 0 }, { -0.5, -h }, { 0.5, -h } }));
        EXPECT_EQ(hexagon.triangles.size(), 4u) << size;
        EXPECT_NEAR(area(hexagon), 3 * h * size * size, 1e-5 * size * size) << size;
        const Mesh l = read("a.obj", file({ { 0, 0 }, { 3, 0 }, { 3, 1 }, { 1, 1 }, { 1, 3 }, { 0, 3 } }));
        EXPECT_EQ(l.triangles.size(), 4u) << size;
        EXPECT_NEAR(area(l), 5 * size * size, 1e-5 * size * size) << size;
        EXPECT_NEAR(area_vector(l).z, 5 * size * size, 1e-5 * size * size) << size;
        const Mesh dart = read("a.obj", file({ { 0, 0 }, { 2, 1 }, { 0, 2 }, { 0.5, 1 } }));
        EXPECT_EQ(dart.triangles.size(), 2u) << size;
        EXPECT_NEAR(area(dart), 1.5 * size * size, 1e-5 * size * size) << size;
    }
}

TEST_F(MeshFiles, ASmallPolygonOfALargeMeshIsCutToo)
{
    const Mesh mesh = read("a.obj",
                           "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"
                           "v 0 0 1\nv 2e-5 0 1\nv 3e-5 1e-5 1\nv 1e-5 3e-5 1\nv 0 2e-5 1\nf 5 6 7 8 9\n");
    EXPECT_EQ(mesh.triangles.size(), 5u);
}

TEST_F(MeshFiles, SmallMeshesKeepTheirVertices)
{
    const Mesh mesh = read("a.obj",
                           "v 0 0 0\nv 1e-6 0 0\nv 1e-6 1e-6 0\nv 0 1e-6 0\nv 5e-7 5e-7 1e-8\n"
                           "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n");
    EXPECT_EQ(mesh.positions.size(), 5u);
    EXPECT_EQ(mesh.triangles.size(), 4u);
    EXPECT_NEAR(area_vector(mesh).z, 1e-12, 1e-18);
    for (const V3f& n : mesh.normals)
        EXPECT_NEAR(n.length(), 1, 1e-6);
}

TEST_F(MeshFiles, AMeshWithZUpIsTurned)
{
    MeshParams params;
    params.up = "z";
    const Mesh mesh
        = read("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 2\nvn 0 0 1\nf 1//1 2//1 3//1\nf 1 2 4\n", params);
    EXPECT_LT((area_vector(mesh) - V3d(0, 0.5, 1)).length(), 1e-9); // from +z and from -y
    double top = 0;
    for (const V3d& p : mesh.positions)
        top = std::max(top, p.y);
    EXPECT_EQ(top, 2);
    EXPECT_EQ(mesh.normals[mesh.triangles[0][1]], V3f(0, 1, 0));
    params.up = "y";
    EXPECT_EQ(read(folder / "a.obj", params).normals[mesh.triangles[0][1]], V3f(0, 0, 1));
}

TEST_F(MeshFiles, AnotherSetOfTextureCoordinatesIsUsedOrMissed)
{
    MeshParams params;
    params.uv_set = 1;
    const Mesh mesh = read("a.obj", kQuadObj, params);
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_TRUE(mesh.uvs.empty());
    std::string two = gltf(R"({"mesh":0})");
    two.replace(two.find("\"TEXCOORD_0\":2"), 14, "\"TEXCOORD_0\":2,\"TEXCOORD_1\":3");
    two.replace(two.find("\"type\":\"VEC2\"}"), 14,
                "\"type\":\"VEC2\"},{\"bufferView\":2,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"}");
    EXPECT_EQ(read("b.gltf", two, params).uvs.size(), 3u);
    params.uv_set = 2;
    EXPECT_TRUE(read(folder / "b.gltf", params).uvs.empty());
}

TEST_F(MeshFiles, PointsAndLinesAreDropped)
{
    const Mesh mesh = read("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nf 1 2 3\nl 1 4\np 4\n");
    EXPECT_EQ(mesh.triangles.size(), 1u);
    EXPECT_EQ(mesh.positions.size(), 3u);
}

TEST_F(MeshFiles, TrianglesWithoutAreaStay)
{
    const Mesh mesh = read("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\nf 1 1 2\n");
    EXPECT_EQ(mesh.triangles.size(), 3u);
    for (const V3f& n : mesh.normals)
        EXPECT_FALSE(std::isnan(n.x));
}

TEST_F(MeshFiles, ZeroAndNonFiniteNormalsOfAFileAreMade)
{
    const Mesh mesh = read("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 0\nvn nan 0 0\nvn 0 0 5\nf 1//1 2//2 3//3\n");
    for (const V3f& n : mesh.normals)
        EXPECT_LT((n - V3f(0, 0, 1)).length(), 1e-6f) << n;
}

TEST_F(MeshFiles, ChosenNormalsReplaceTheFiles)
{
    // Two sides of a roof; the file's normals all point along x.
    const std::string roof = "v 0 0 0\nv 0 2 0\nv 1 0 1\nv 1 2 1\nv 2 0 0\nv 2 2 0\nvn 1 0 0\n"
                             "f 1//1 3//1 4//1 2//1\nf 3//1 5//1 6//1 4//1\n";
    MeshParams params;
    for (const V3f& n : read("a.obj", roof, params).normals)
        EXPECT_EQ(n, V3f(1, 0, 0));
    const auto normal_at = [](const Mesh& mesh, const V3d& p, size_t triangle) {
        for (uint32_t v : mesh.triangles[triangle])
            if (mesh.positions[v] == p)
                return mesh.normals[v];
        ADD_FAILURE() << "no such vertex";
        return V3f(0);
    };
    const V3f left = V3f(-1, 0, 1).normalized();
    params.normals = "flat";
    const Mesh flat = read(folder / "a.obj", params);
    EXPECT_GE(flat.positions.size(), 8u);
    EXPECT_LT((normal_at(flat, V3d(1, 0, 1), 0) - left).length(), 1e-6f);
    params.normals = "smooth";
    const Mesh smooth = read(folder / "a.obj", params);
    EXPECT_EQ(smooth.positions.size(), 6u);
    EXPECT_LT((normal_at(smooth, V3d(1, 0, 1), 0) - V3f(0, 0, 1)).length(), 1e-6f);
    EXPECT_LT((normal_at(smooth, V3d(0, 0, 0), 0) - left).length(), 1e-6f);
    params.crease_angle = 80; // the roof's edge is of 90 degrees
    const Mesh creased = read(folder / "a.obj", params);
    EXPECT_EQ(creased.positions.size(), 8u);
    EXPECT_LT((normal_at(creased, V3d(1, 0, 1), 0) - left).length(), 1e-6f);
}

TEST_F(MeshFiles, WhatIsNoFileIsRefused)
{
    EXPECT_EQ(refusal(folder / "none.obj"), "no such file");
    EXPECT_EQ(refusal(folder / ""), "not a file");
}

TEST_F(MeshFiles, WhatIsNoMeshIsRefused)
{
    for (const char* name : { "a.obj", "a.ply", "a.gltf", "a.glb", "a.fbx", "a.stl", "a.xyz", "noname" }) {
        EXPECT_FALSE(refusal(folder.write(name, "")).empty()) << name;
        EXPECT_FALSE(refusal(folder.write(name, std::string("\x7f\xff\0\x01 noise \x80\n\r\t\xfe", 17))).empty())
            << name;
    }
    EXPECT_EQ(refusal(folder.write("a.xyz", "hello")).find("unknown mesh format; supported: OBJ, "), 0u);
}

TEST_F(MeshFiles, AFileWithoutTrianglesIsRefused)
{
    EXPECT_EQ(refusal(folder.write("a.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n")), "no triangles");
    std::string points = gltf(R"({"mesh":0})");
    points.replace(points.find("\"attributes\""), 0, "\"mode\":0,");
    EXPECT_EQ(refusal(folder.write("a.gltf", points)), "no triangles");
}

TEST_F(MeshFiles, AVertexThatIsNotFiniteIsNamed)
{
    EXPECT_EQ(refusal(folder.write("a.obj", "o thing\nv 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n")),
              "vertex 2 of \"thing\" is not finite: (0, nan, 0)");
    EXPECT_EQ(refusal(folder.write("a.obj", "o thing\nv 0 0 0\nv inf 0 0\nv 0 1 0\nf 1 2 3\n")),
              "vertex 1 of \"thing\" is not finite: (inf, 0, 0)");
}

// Where squares of areas leave the range of double.
TEST_F(MeshFiles, AVertexBeyondAllReasonIsNamed)
{
    EXPECT_EQ(refusal(folder.write("a.obj", "o thing\nv 9.99e69 0 0\nv 1.001e70 0 0\nv 9.99e69 1e67 0\nf 1 2 3\n")),
              "vertex 1 of \"thing\" is farther than 1e70 from the origin: (1.001e+70, 0, 0)");
}

TEST_F(MeshFiles, ObjOfOtherExporters)
{
    const Mesh quad = read("a.obj", kQuadObj);
    const std::string text = kQuadObj;
    const auto with = [&](const char* what, const char* instead) {
        return mesh_hash(read("b.obj", OIIO::Strutil::replace(text, what, instead, true)));
    };
    EXPECT_EQ(with("v 0 0 0", "\xef\xbb\xbfv 0 0 0"), mesh_hash(quad));
    EXPECT_EQ(with("v 2 0 0", "\t  v 2 0 0"), mesh_hash(quad));
    EXPECT_EQ(with("v 2 0 0", "# C:\\x\\\nv 2 0 0"), mesh_hash(quad));
    EXPECT_EQ(with("v 2 0 0", "v 2 \\\n 0 0"), mesh_hash(quad));
    EXPECT_EQ(with("vt 0.1 0.2", "vt 0.1 0.2 # nan"), mesh_hash(quad));
    EXPECT_EQ(with("vt 0.1 0.2", "vt 0.1 0.2 nan"), mesh_hash(quad));
    EXPECT_EQ(with(" 3 0\n", " 3 0 1 0.5 0 1\n"), mesh_hash(quad));
    EXPECT_EQ(with("\n", "\r"), mesh_hash(quad));
    EXPECT_NE(with("v 2 0 0", "v 2.5 0 0"), mesh_hash(quad));
}

TEST_F(MeshFiles, AStrayVertexLosesNoDoubles)
{
    const std::string far = "v 1e6 0 0\nv 1000000.1 0 0\nv 1000000.1 0.1 0\n";
    const Mesh mesh = read("a.obj", "v 0 0 0\n" + far + "f 2 3 -1\n");
    EXPECT_TRUE(mesh.has_exact_positions);
    EXPECT_EQ(mesh.positions[1].x, 1000000.1);
    EXPECT_TRUE(read("a.obj", "v 1e6 0 0\nv 1000001 0 0\nv 1000001 1 0\nf 1 2 3\n").has_exact_positions);
    EXPECT_FALSE(read("a.obj", "v 0 0 0\n" + far + "f 1 3 4\n").has_exact_positions);
}

TEST_F(MeshFiles, ALongLineIsToldInShort)
{
    const std::string tail(100000, 'x');
    EXPECT_LT(refusal(folder.write("a.obj", "v 0 0 0\nvt nan " + tail + "\n")).size(), 600u);
}

TEST_F(MeshFiles, ARefusedFileLeavesNoMesh)
{
    Mesh mesh = read("a.obj", kQuadObj);
    std::string error;
    EXPECT_FALSE(read_mesh(mesh, folder / "none.obj", {}, error));
    EXPECT_TRUE(mesh.triangles.empty());
}
