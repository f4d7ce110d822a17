// SPDX-License-Identifier: Apache-2.0
// Reading meshes from files. Normals, merging and hashes: mesh_normals_test.cpp.
#include "temporary_folder.h"

#include <vmlight/mesh.h>

#include <OpenImageIO/strutil.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>

using namespace vmlight;
using Imath::V2f;
using Imath::V3d;
using Imath::V3f;

namespace {

class MeshFiles : public testing::Test
{
protected:
    Mesh read(const std::string& path, const MeshParams& params = {})
    {
        Mesh mesh;
        std::string error;
        EXPECT_TRUE(read_mesh(mesh, path, params, error)) << error;
        return mesh;
    }
    Mesh read(const char* name, const std::string& bytes, const MeshParams& params = {})
    {
        return read(folder.write(name, bytes), params);
    }
    /// What is said, less the path at its head.
    std::string refusal(const std::string& path)
    {
        Mesh mesh;
        std::string error;
        EXPECT_FALSE(read_mesh(mesh, path, {}, error));
        const std::string head = "\"" + path + "\": ";
        EXPECT_EQ(error.substr(0, head.size()), head);
        EXPECT_EQ(error.find('\n'), std::string::npos) << error;
        return error.substr(std::min(error.size(), head.size()));
    }

    const TemporaryFolder folder;
};

const char* const kQuadObj = "v 0 0 0\nv 2 0 0\nv 2 3 0\nv 0 3 0\n"
                             "vt 0.1 0.2\nvt 0.9 0.2\nvt 0.9 0.8\nvt 0.1 0.8\n"
                             "vn 0 0 1\nf 1/1/1 2/2/1 3/3/1 4/4/1\n";

double area(const Mesh& mesh)
{
    double sum = 0;
    for (const auto& t : mesh.triangles)
        sum += triangle_area_normal(mesh, t).length() / 2;
    return sum;
}

V3d area_vector(const Mesh& mesh)
{
    V3d sum(0);
    for (const auto& t : mesh.triangles)
        sum += triangle_area_normal(mesh, t) * 0.5;
    return sum;
}

std::string base64(const std::string& bytes)
{
    const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t triple = 0;
        for (size_t k = 0; k < 3; ++k)
            triple = triple << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0);
        for (size_t k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : digits[triple >> (18 - 6 * k) & 63];
    }
    return text;
}

// One triangle (0,0,0) (1,0,0) (0,1,0) with normals +z and uvs (0,0) (1,0) (0,0.25), v down as glTF has it, under
// `nodes`.
std::string gltf(const std::string& nodes, const std::string& roots = "0")
{
    const float numbers[]
        = { 0, 0, 0, 1, 0, 0, 0, 1, 0, /* normals */ 0, 0, 1, 0, 0, 1, 0, 0, 1, /* uvs */ 0, 0, 1, 0, 0, 0.25f };
    std::string bytes(sizeof(numbers), 0);
    std::memcpy(bytes.data(), numbers, sizeof(numbers));
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)" + roots + R"(]}],"nodes":[)" + nodes
        + R"(],"meshes":[{"name":"leaf","primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":1,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":2,"componentType":5126,"count":3,"type":"VEC2"}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":36},{"buffer":0,"byteOffset":72,"byteLength":24}],
"buffers":[{"byteLength":96,"uri":"data:application/octet-stream;base64,)"
        + base64(bytes) + "\"}]}";
}

// The place, normal and uv of the triangle's vertex that the file has at (1, 0, 0): its uv is (1, 0) there.
uint32_t vertex_with_u1(const Mesh& mesh, const std::array<uint32_t, 3>& triangle)
{
    for (uint32_t v : triangle)
        if (mesh.uvs[v].x == 1)
            return v;
    ADD_FAILURE() << "no vertex with u = 1";
    return 0;
}

} // namespace

TEST_F(MeshFiles, ObjKeepsPositionsNormalsAndTextureCoordinates)
{
    const Mesh mesh = read("quad.obj", kQuadObj);
    EXPECT_EQ(mesh.name, "quad.obj");
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(mesh.materials.size(), 2u);
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

TEST_F(MeshFiles, GltfTextureCoordinatesAreTurnedUp)
{
    const Mesh mesh = read("a.gltf", gltf(R"({"mesh":0})"));
    ASSERT_EQ(mesh.triangles.size(), 1u);
    for (size_t v = 0; v < 3; ++v) {
        EXPECT_EQ(mesh.normals[v], V3f(0, 0, 1));
        EXPECT_EQ(mesh.uvs[v], V2f(float(mesh.positions[v].x), mesh.positions[v].y == 1 ? 0.75f : 1.0f));
    }
    EXPECT_EQ(area_vector(mesh), V3d(0, 0, 0.5));
}

TEST_F(MeshFiles, NodesMoveTurnAndScaleTheirMeshes)
{
    // A parent that scales by 2 and moves by (0, 0, 5); a child that turns 90 degrees about z, moved by (1, 0, 0).
    const Mesh mesh = read("a.gltf",
                           gltf(R"({"children":[1],"scale":[2,2,2],"translation":[0,0,5]},)"
                                R"({"mesh":0,"rotation":[0,0,0.70710678,0.70710678],"translation":[1,0,0]})"));
    ASSERT_EQ(mesh.triangles.size(), 1u);
    const uint32_t v = vertex_with_u1(mesh, mesh.triangles[0]);
    EXPECT_LT((mesh.positions[v] - V3d(2, 2, 5)).length(), 1e-5);
    EXPECT_LT((mesh.normals[v] - V3f(0, 0, 1)).length(), 1e-6f);
    EXPECT_LT((area_vector(mesh) - V3d(0, 0, 2)).length(), 1e-5);
}

TEST_F(MeshFiles, NormalsOfAnUnevenlyScaledNodeStayNormalToIt)
{
    // Turned 45 degrees about y, then squeezed along x by 4: the surface's normal leans, the file's is (0, 0, 1).
    const Mesh mesh = read("a.gltf",
                           gltf(R"({"children":[1],"scale":[0.25,1,1]},)"
                                R"({"mesh":0,"rotation":[0,0.38268343,0,0.92387953]})"));
    const V3d normal = area_vector(mesh).normalized();
    EXPECT_GT(std::abs(normal.x), 0.9);
    for (const V3f& n : mesh.normals)
        EXPECT_LT((V3d(n) - normal).length(), 1e-5);
}

TEST_F(MeshFiles, AMirroredNodeKeepsTheOutsideOut)
{
    for (const char* scale : { "[-1,1,1]", "[1,-2,1]", "[1,1,-1]", "[-1,-1,-1]" }) {
        const Mesh mesh = read("a.gltf", gltf(std::string(R"({"mesh":0,"scale":)") + scale + "}"));
        ASSERT_EQ(mesh.triangles.size(), 1u);
        const V3d normal = area_vector(mesh).normalized();
        for (const V3f& n : mesh.normals)
            EXPECT_LT((V3d(n) - normal).length(), 1e-6) << scale; // winding and normals agree
        EXPECT_EQ(normal.z,
                  std::string(scale).find("1]") == std::strlen(scale) - 2
                          && std::string(scale).find("-1]") == std::string::npos
                      ? 1
                      : -1)
            << scale;
    }
    // Twice mirrored is not mirrored.
    const Mesh twice = read("a.gltf", gltf(R"({"children":[1],"scale":[-1,1,1]},{"mesh":0,"scale":[1,-1,1]})"));
    EXPECT_LT((area_vector(twice) - V3d(0, 0, 0.5)).length(), 1e-6);
}

TEST_F(MeshFiles, EveryNodeShowsItsMesh)
{
    const Mesh mesh
        = read("a.gltf",
               gltf(R"({"mesh":0},{"mesh":0,"translation":[0,0,1]},{"children":[3]},{"mesh":0,"translation":[9,0,0]})",
                    "0,1,2"));
    EXPECT_EQ(mesh.triangles.size(), 3u);
    EXPECT_EQ(mesh.positions.size(), 9u);
    EXPECT_EQ(mesh.uvs.size(), 9u);
}

TEST_F(MeshFiles, SeveralMeshesOfAFileAreOne)
{
    const Mesh mesh = read("two.obj",
                           "o a\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n"
                           "o b\nusemtl blue\nv 0 0 1\nv 1 0 1\nv 0 1 1\nf 4 5 6\n");
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_NE(mesh.materials[0], mesh.materials[1]);
    // One has texture coordinates, the other none.
    int missing = 0;
    ASSERT_EQ(mesh.uvs.size(), 6u);
    for (size_t v = 0; v < 6; ++v) {
        EXPECT_EQ(std::isnan(mesh.uvs[v].x), mesh.positions[v].z == 1);
        missing += std::isnan(mesh.uvs[v].x);
    }
    EXPECT_EQ(missing, 3);
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
    EXPECT_EQ(refusal(folder.write("a.xyz", "hello")).find("not a mesh that can be read: "), 0u);
}

TEST_F(MeshFiles, AFileWithoutTrianglesIsRefused)
{
    EXPECT_EQ(refusal(folder.write("a.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n")), "no triangle in it");
    std::string points = gltf(R"({"mesh":0})");
    points.replace(points.find("\"attributes\""), 0, "\"mode\":0,");
    EXPECT_EQ(refusal(folder.write("a.gltf", points)), "no triangle in it");
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
