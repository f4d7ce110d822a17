// SPDX-License-Identifier: Apache-2.0
// Choosing a part of a mesh by the names of its materials and nodes.
#include <vmlight/mesh/selection.h>

#include <gtest/gtest.h>

#include <limits>

using namespace vmlight;

namespace {

// Triangle t has vertices 3 t to 3 t + 2, material t % 3, and node t. Node 3 is below 1, which is below 0.
Mesh five_triangles()
{
    Mesh mesh;
    mesh.name = mesh.path = "hero.glb";
    for (uint32_t t = 0; t < 5; ++t) {
        for (int corner = 0; corner < 3; ++corner) {
            mesh.positions.emplace_back(t, corner == 1, corner == 2);
            mesh.normals.emplace_back(1, 0, 0);
            mesh.uvs.emplace_back(float(t), float(corner));
        }
        mesh.triangles.push_back({ 3 * t, 3 * t + 1, 3 * t + 2 });
        mesh.triangle_materials.push_back(t % 3);
        mesh.triangle_nodes.push_back(t);
    }
    mesh.materials.resize(4);
    mesh.materials[0].name = "Body";
    mesh.materials[1].name = "Body*";
    mesh.materials[3].name = "Unused";
    mesh.nodes = { { "root", -1 }, { "arm", 0 }, { "leg", 0 }, { "hand", 1 }, { "", -1 } };
    mesh.normals_from = "flat";
    mesh.warnings = { "odd" };
    return mesh;
}

std::string chosen(const MeshSelection& selection, const Mesh& mesh = five_triangles())
{
    std::vector<bool> triangles;
    std::string at, error, text;
    if (!choose_triangles(triangles, mesh, selection, at, error))
        return at + ": " + error;
    for (size_t t = 0; t < triangles.size(); ++t)
        if (triangles[t])
            text += std::to_string(t);
    return text;
}

} // namespace

TEST(Selection, NamesChooseMaterialsAndWholeSubtrees)
{
    EXPECT_EQ(chosen({}), "01234");
    EXPECT_EQ(chosen({ { "Body" }, {} }), "03");
    EXPECT_EQ(chosen({ { "Body", "material_2" }, {} }), "023");
    EXPECT_EQ(chosen({ {}, { "root" } }), "0123");
    EXPECT_EQ(chosen({ {}, { "arm" } }), "13");
    EXPECT_EQ(chosen({ {}, { "arm", "node_4" } }), "134");
    EXPECT_EQ(chosen({ { "Body" }, { "arm" } }), "3") << "both must hold";
}

TEST(Selection, AStarStandsForAnyTextIfNothingHasThatName)
{
    EXPECT_EQ(chosen({ { "Body*" }, {} }), "14") << "a material has this name";
    EXPECT_EQ(chosen({ { "B*y*" }, {} }), "0134");
    EXPECT_EQ(chosen({ { "*" }, {} }), "01234");
    EXPECT_EQ(chosen({ {}, { "*a*d" } }), "3");
    EXPECT_EQ(
        chosen({ {}, { "*e" } }),
        "node: \"hero.glb\": no node \"*e\"; the file has \"root\", \"arm\", \"leg\", \"hand\" and \"node_4\"; did "
        "you mean \"leg\"?");
}

TEST(Selection, AnUnknownNameIsRefusedWithTheNearest)
{
    EXPECT_EQ(chosen({ { "Bdy" }, {} }),
              "material: \"hero.glb\": no material \"Bdy\"; the file has \"Body\", \"Body*\", \"material_2\" and "
              "\"Unused\"; did you mean \"Body\"?");
    EXPECT_EQ(
        chosen({ {}, { "root", "AN" } }),
        "node: \"hero.glb\": no node \"AN\"; the file has \"root\", \"arm\", \"leg\", \"hand\" and \"node_4\"; did "
        "you mean \"hand\"?");
    EXPECT_EQ(chosen({ { "Unused" }, {} }), "material: \"hero.glb\": no triangle has the material \"Unused\"");
    EXPECT_EQ(chosen({ { "Body" }, { "leg" } }),
              "node: \"hero.glb\": no triangle has the material and is below the node \"leg\"");
    Mesh bare = five_triangles();
    bare.materials.clear();
    bare.triangle_materials.clear();
    EXPECT_EQ(chosen({ { "Body" }, {} }, bare), "material: \"hero.glb\": no material \"Body\"; this file has none");
    Mesh large = five_triangles();
    for (int i = 0; i < 100000; ++i)
        large.nodes.push_back({ "part " + std::to_string(i), -1 });
    EXPECT_EQ(chosen({ {}, { "xyz" } }, large),
              "node: \"hero.glb\": no node \"xyz\"; the file has \"root\", \"arm\", \"leg\", \"hand\", \"node_4\", "
              "\"part 0\", \"part 1\", \"part 2\" and 99997 more");
}

TEST(Selection, APartKeepsItsVerticesInOrder)
{
    const Mesh mesh = five_triangles();
    const Mesh part = mesh_part(mesh, { false, true, false, false, true });
    ASSERT_EQ(part.triangles.size(), 2u);
    EXPECT_EQ(part.triangles[1], (std::array<uint32_t, 3> { 3, 4, 5 }));
    ASSERT_EQ(part.positions.size(), 6u);
    for (size_t i = 0; i < 6; ++i) {
        const size_t from = i < 3 ? 3 + i : 9 + i;
        EXPECT_EQ(part.positions[i], mesh.positions[from]);
        EXPECT_EQ(part.uvs[i], mesh.uvs[from]);
    }
    EXPECT_EQ(part.triangle_nodes, (std::vector<uint32_t> { 1, 4 }));
    EXPECT_EQ(part.materials.size(), 4u);
    EXPECT_EQ(part.path, "hero.glb");
    EXPECT_EQ(part.normals_from, "flat");
    std::string error;
    EXPECT_TRUE(check_mesh(part, error)) << error;
    EXPECT_NE(mesh_hash(part), mesh_hash(mesh));
}

TEST(Selection, OnlyMaterialsWithUvsAreBaked)
{
    Mesh mesh = five_triangles();
    EXPECT_EQ(baked_materials(mesh), (std::vector<std::string> { "Body", "Body*", "material_2" }));
    mesh.uvs[2 * 3 + 1].x = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(baked_materials(mesh), (std::vector<std::string> { "Body", "Body*" }));
    EXPECT_TRUE(mesh_part(mesh, { false, false, true, false, false }).uvs.empty());
    mesh.materials[1].name = "Body";
    EXPECT_EQ(baked_materials(mesh), (std::vector<std::string> { "Body" }));
}
