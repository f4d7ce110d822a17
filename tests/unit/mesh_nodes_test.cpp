// SPDX-License-Identifier: Apache-2.0
// Nodes of a file, and the meshes that they move.
#include "mesh_fixture.h"

#include <array>
#include <cmath>

using namespace mesh_files;

namespace {

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
    EXPECT_NE(mesh.triangle_materials[0], mesh.triangle_materials[1]);
    // One has texture coordinates, the other none.
    int missing = 0;
    ASSERT_EQ(mesh.uvs.size(), 6u);
    for (size_t v = 0; v < 6; ++v) {
        EXPECT_EQ(std::isnan(mesh.uvs[v].x), mesh.positions[v].z == 1);
        missing += std::isnan(mesh.uvs[v].x);
    }
    EXPECT_EQ(missing, 3);
}
