// SPDX-License-Identifier: Apache-2.0
// Meshes written, and read again.
#include "mesh_fixture.h"
#include "scenes.h"

#include <vmlight/mesh/export/write_mesh.h>

#include <cmath>

using namespace vmlight;
using namespace mesh_files;

namespace {

// A box and a sphere, of two materials in turns.
Mesh two_materials(const V3d& place = V3d(0), double scale = 1)
{
    Mesh mesh = scenes::sphere(V3d(0), 1, 6);
    mesh.name = "two.obj";
    mesh.materials.resize(2);
    mesh.materials[0].name = "red paint";
    mesh.materials[0].base_color = Imath::Color4f(0.5f, 0.25f, 0.125f, 1);
    mesh.materials[1].name = "glass";
    mesh.materials[1].base_color = Imath::Color4f(1, 1, 1, 0.25f);
    mesh.materials[1].alpha_mode = AlphaMode::blend;
    mesh.materials[1].is_double_sided = true;
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
        mesh.triangle_materials.set(t, t / 7 % 2);
    for (V3d& p : mesh.positions) // as files have them
        p = V3d(V3f(p)) * scale + place;
    for (V3f& n : mesh.normals)
        n = n.normalized();
    return mesh;
}

// Each triangle as text, by its first corner's smallest, so that their order does not matter.
std::vector<std::array<float, 24>> corners_of(const Mesh& mesh)
{
    std::vector<std::array<float, 24>> all;
    for (const auto& triangle : mesh.triangles) {
        std::array<float, 24> numbers;
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t v = triangle[k];
            const V3f p(mesh.positions[v]), n = mesh.normals[v];
            const V2f uv = mesh.uvs[v];
            const float values[] = { p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y };
            std::copy_n(values, 8, numbers.begin() + 8 * k);
        }
        all.push_back(numbers);
    }
    std::sort(all.begin(), all.end());
    return all;
}

void expect_same(const Mesh& a, const Mesh& b, float tolerance)
{
    const auto corners_a = corners_of(a), corners_b = corners_of(b);
    ASSERT_EQ(corners_a.size(), corners_b.size());
    for (size_t t = 0; t < corners_a.size(); ++t)
        for (size_t i = 0; i < 24; ++i)
            EXPECT_NEAR(corners_a[t][i], corners_b[t][i], tolerance) << "triangle " << t << ", number " << i;
}

using MeshExport = MeshFiles;

} // namespace

TEST_F(MeshExport, WhatIsWrittenIsReadAgain)
{
    const Mesh mesh = two_materials();
    for (const char* name : { "a.obj", "a.glb" }) {
        SCOPED_TRACE(name);
        std::string error;
        ASSERT_TRUE(write_mesh(mesh, folder / name, error)) << error;
        const Mesh again = read(folder / name);
        expect_same(mesh, again, 1e-6f);
        // The positions are the same bit for bit; those of an OBJ to the last place, which its reader rounds as assimp.
        std::vector<V3d> before = mesh.positions, after = again.positions;
        const auto less = [](const V3d& a, const V3d& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); };
        for (std::vector<V3d>* all : { &before, &after }) {
            std::sort(all->begin(), all->end(), less);
            all->erase(std::unique(all->begin(), all->end()), all->end());
        }
        ASSERT_EQ(before.size(), after.size());
        for (size_t i = 0; i < before.size(); ++i)
            EXPECT_LE((before[i] - after[i]).length(), name == std::string("a.obj") ? 1e-7 : 0) << i;
    }
}

TEST_F(MeshExport, AGltfHasItsMaterials)
{
    std::string error;
    ASSERT_TRUE(write_mesh(two_materials(), folder / "a.glb", error)) << error;
    const Mesh again = read(folder / "a.glb");
    ASSERT_GE(again.materials.size(), 2u);
    EXPECT_EQ(again.materials[0].name, "red paint");
    EXPECT_EQ(again.materials[0].base_color, Imath::Color4f(0.5f, 0.25f, 0.125f, 1));
    EXPECT_EQ(again.materials[1].name, "glass");
    EXPECT_EQ(again.materials[1].alpha_mode, AlphaMode::blend);
    EXPECT_TRUE(again.materials[1].is_double_sided);
}

TEST_F(MeshExport, AnObjHasItsMaterialsBesideIt)
{
    std::string error;
    ASSERT_TRUE(write_mesh(two_materials(), folder / "a.obj", error)) << error;
    EXPECT_EQ(folder.bytes("a.mtl"), "newmtl red_paint\nKd 0.5 0.25 0.125\nd 1\nnewmtl glass\nKd 1 1 1\nd 0.25\n");
    EXPECT_NE(folder.bytes("a.obj").find("mtllib a.mtl\no two.obj\nv "), std::string::npos);
    EXPECT_NE(folder.bytes("a.obj").find("usemtl glass\n"), std::string::npos);
}

TEST_F(MeshExport, FarFromTheOriginTheShapeIsKept)
{
    const V3d place(84900.3, 12.7, 447600.1);
    const Mesh mesh = two_materials(place, 0.01);
    for (const char* name : { "a.obj", "a.glb" }) {
        SCOPED_TRACE(name);
        std::string error;
        ASSERT_TRUE(write_mesh(mesh, folder / name, error)) << error;
    }
    // The node moves what the floats hold.
    EXPECT_NE(folder.bytes("a.glb").find("\"translation\":[84900."), std::string::npos);
    EXPECT_EQ(mesh_hash(mesh).size(), 16u);
    Mesh again = read(folder / "a.obj");
    ASSERT_TRUE(again.has_exact_positions);
    V3d low(1e300), high(-1e300);
    for (const V3d& p : again.positions)
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], p[axis]);
            high[axis] = std::max(high[axis], p[axis]);
        }
    EXPECT_NEAR((high - low).z, 0.02, 1e-9);
}

TEST_F(MeshExport, TrianglesWithoutUvsStayWithout)
{
    Mesh mesh = two_materials();
    for (uint32_t vertex : mesh.triangles[0])
        mesh.uvs[vertex] = V2f(NAN);
    const auto without = [](const Mesh& m) {
        return std::count_if(m.triangles.begin(), m.triangles.end(), [&](const auto& triangle) {
            return std::any_of(triangle.begin(), triangle.end(),
                               [&](uint32_t vertex) { return !std::isfinite(m.uvs[vertex].x); });
        });
    };
    std::string error;
    ASSERT_TRUE(write_mesh(mesh, folder / "a.glb", error)) << error;
    EXPECT_EQ(without(read(folder / "a.glb")), without(mesh));
}

TEST_F(MeshExport, WhatCannotBeWrittenIsRefused)
{
    std::string error;
    EXPECT_FALSE(write_mesh(two_materials(), folder / "a.ply", error));
    EXPECT_EQ(error, "\"" + (folder / "a.ply") + "\": a mesh is written as .glb or .obj");
    EXPECT_FALSE(write_mesh(two_materials(), folder / "missing/a.glb", error));
    EXPECT_NE(error.find("no such folder"), std::string::npos);
    Mesh broken = two_materials();
    broken.triangles[0][0] = 100000;
    EXPECT_FALSE(write_mesh(broken, folder / "a.glb", error));
    EXPECT_NE(error.find("uses vertex 100000"), std::string::npos);
}
