// SPDX-License-Identifier: Apache-2.0
#include "gltf_file.h"

#include <gmock/gmock.h>

#include <cmath>

using namespace mesh_files;

namespace {

std::vector<V3d> translated(const std::vector<V3d>& points, const V3d& by)
{
    std::vector<V3d> result;
    for (const V3d& point : points)
        result.push_back(point + by);
    return result;
}

void expect_points(const std::vector<V3d>& points, const std::vector<V3d>& expected)
{
    ASSERT_EQ(points.size(), expected.size());
    for (size_t i = 0; i < points.size(); ++i)
        EXPECT_LT((points[i] - expected[i]).length(), 1e-6) << i;
}

} // namespace

TEST_F(MeshFiles, JointsMoveASkinAndItsNodeDoesNot)
{
    GltfFile file = triangle_file();
    // Corners 0 and 1 follow node 1, corner 2 follows node 2, by half and with twice the weight: weights are relative.
    file.primitive()["attributes"]["JOINTS_0"]
        = file.add_accessor<uint8_t>({ 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0 }, "VEC4");
    file.primitive()["attributes"]["WEIGHTS_0"]
        = file.add_accessor<uint8_t>({ 255, 0, 0, 0, 255, 0, 0, 0, 128, 128, 0, 0 }, "VEC4", true);
    const size_t inverses = file.add_accessor<float>(
        { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -5, 1, /**/ 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 },
        "MAT4");
    file.root["skins"] = { { { "joints", { 1, 2 } }, { "inverseBindMatrices", inverses } } };
    file.root["nodes"] = { { { "mesh", 0 }, { "skin", 0 }, { "translation", { 100, 100, 100 } } },
                           { { "translation", { 1, 0, 0 } } },
                           { { "translation", { 0, 0, 4 } } } };
    const Mesh mesh = read("a.gltf", file.text());
    expect_points(mesh.positions, { V3d(1, 0, -5), V3d(3, 0, -5), V3d(0.5, 3, -0.5) });
}

TEST_F(MeshFiles, NormalsTurnWithTheirJoints)
{
    GltfFile file = triangle_file();
    file.primitive()["attributes"]["JOINTS_0"] = file.add_accessor<uint16_t>(std::vector<uint16_t>(12, 0), "VEC4");
    file.primitive()["attributes"]["WEIGHTS_0"]
        = file.add_accessor<float>({ 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0 }, "VEC4");
    file.root["skins"] = { { { "joints", { 1 } } } }; // no inverse matrices: the identity
    const double half = std::sqrt(0.5);
    file.root["nodes"] = { { { "mesh", 0 }, { "skin", 0 } }, { { "rotation", { 0, half, 0, half } } } }; // z to x
    Mesh mesh = read("a.gltf", file.text());
    expect_points(mesh.positions, { V3d(0, 0, 0), V3d(0, 0, -2), V3d(0, 3, 0) });
    EXPECT_LT((mesh.normals[0] - V3f(1, 0, 0)).length(), 1e-6f);
    // A mirroring joint turns triangles round, as a mirroring node does.
    file.root["nodes"][1] = { { "scale", { -1, 1, 1 } } };
    file.primitive()["attributes"].erase("NORMAL");
    mesh = read("a.gltf", file.text());
    EXPECT_EQ(area_vector(mesh), V3d(0, 0, 3));
}

TEST_F(MeshFiles, SkinsThatAreBrokenAreRefused)
{
    GltfFile file = triangle_file();
    file.primitive()["attributes"]["JOINTS_0"] = file.add_accessor<uint16_t>(std::vector<uint16_t>(12, 3), "VEC4");
    file.primitive()["attributes"]["WEIGHTS_0"] = file.add_accessor<float>(std::vector<float>(12, 0.25f), "VEC4");
    file.root["nodes"][0]["skin"] = 0;
    EXPECT_EQ(refusal(folder.write("a.gltf", file.text())), "there is no skin 0");
    file.root["skins"] = { { { "joints", { 0 } } } };
    EXPECT_EQ(refusal(folder.write("a.gltf", file.text())), "vertex 0 follows joint 3, but skin 0 has only 1");
    file.root["skins"] = { { { "joints", { 5 } } } };
    EXPECT_EQ(refusal(folder.write("a.gltf", file.text())), "skin 0 has node 5 for a joint, but there are only 1");
    file.root["skins"] = { { { "joints", { 0, 0 } },
                             { "inverseBindMatrices", file.add_accessor<float>(std::vector<float>(16, 1), "MAT4") } } };
    EXPECT_EQ(refusal(folder.write("a.gltf", file.text())), "skin 0 has 2 joints, but only 1 matrices");
}

TEST_F(MeshFiles, MorphTargetsHaveTheirDefaultWeights)
{
    GltfFile file = triangle_file();
    const size_t up = file.add_accessor<float>({ 0, 0, 1, 0, 0, 1, 0, 0, 1 }, "VEC3"),
                 wide = file.add_accessor<float>({ 0, 0, 0, 2, 0, 0, 0, 0, 0 }, "VEC3"),
                 uv = file.add_accessor<float>({ 0.5f, 0, 0.5f, 0, 0.5f, 0 }, "VEC2");
    file.primitive()["targets"] = { { { "POSITION", up }, { "TEXCOORD_0", uv } }, { { "POSITION", wide } } };
    EXPECT_EQ(read("a.gltf", file.text()).positions, kTriangleCorners) << "no weights: none";
    file.root["meshes"][0]["weights"] = { 0.5, 1 };
    Mesh mesh = read("a.gltf", file.text());
    EXPECT_EQ(mesh.positions, (std::vector<V3d> { V3d(0, 0, 0.5), V3d(4, 0, 0.5), V3d(0, 3, 0.5) }));
    EXPECT_EQ(mesh.uvs[0], V2f(0.25f, 1));
    file.root["nodes"][0]["weights"] = { 2, 0 }; // the node's count
    EXPECT_EQ(read("a.gltf", file.text()).positions, translated(kTriangleCorners, V3d(0, 0, 2)));
}

TEST_F(MeshFiles, InstancesAreAllBaked)
{
    GltfFile file = triangle_file();
    const double half = std::sqrt(0.5);
    const size_t translation = file.add_accessor<float>({ 10, 0, 0, 0, 20, 0 }, "VEC3"),
                 rotation = file.add_accessor<float>({ 0, 0, 0, 1, 0, 0, float(half), float(half) }, "VEC4"),
                 scale = file.add_accessor<float>({ 1, 1, 1, 2, 2, 2 }, "VEC3");
    file.root["extensionsRequired"] = { "EXT_mesh_gpu_instancing" };
    file.root["nodes"][0]["translation"] = { 0, 0, 7 };
    json& attributes = file.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    attributes = { { "TRANSLATION", translation }, { "ROTATION", rotation }, { "SCALE", scale } };
    const Mesh mesh = read("a.gltf", file.text());
    ASSERT_EQ(mesh.triangles.size(), 2u);
    expect_points(mesh.positions,
                  { V3d(10, 0, 7), V3d(12, 0, 7), V3d(10, 3, 7), //
                    V3d(0, 20, 7), V3d(0, 24, 7), V3d(-6, 20, 7) });
    attributes["SCALE"] = file.add_accessor<float>({ 1, 1, 1 }, "VEC3");
    EXPECT_EQ(refusal(folder.write("a.gltf", file.text())), "SCALE of the instances of node \"\" has 1 element, not 2");
}

TEST_F(MeshFiles, MoreInstancesThanFitInMemoryAreRefused)
{
    // 100000 vertices, 50000 times, in a few lines: both accessors are zeros.
    GltfFile file = triangle_file();
    for (const int count : { 100000, 50000 })
        file.root["accessors"].push_back({ { "componentType", 5126 }, { "count", count }, { "type", "VEC3" } });
    file.primitive() = { { "attributes", { { "POSITION", 4 } } } };
    file.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = { { "TRANSLATION", 5 } };
    EXPECT_THAT(refusal(folder.write("a.gltf", file.text())), testing::StartsWith("5e+09 vertices and "));
}

TEST_F(MeshFiles, NodesMayShareAMeshOrShowItByOtherWeights)
{
    GltfFile file = triangle_file();
    file.primitive()["targets"]
        = { { { "POSITION", file.add_accessor<float>({ 0, 0, 1, 0, 0, 1, 0, 0, 1 }, "VEC3") } } };
    file.root["nodes"]
        = { { { "mesh", 0 } }, { { "mesh", 0 } }, { { "mesh", 0 }, { "weights", { 1 } } }, { { "mesh", 0 } } };
    file.root["scenes"][0]["nodes"] = { 0, 1, 2, 3 };
    const Mesh mesh = read("a.gltf", file.text());
    ASSERT_EQ(mesh.triangles.size(), 4u);
    for (size_t t = 0; t < 4; ++t)
        EXPECT_EQ(mesh.positions[mesh.triangles[t][0]].z, t == 2 ? 1 : 0) << t;
}

TEST_F(MeshFiles, HiddenNodesAndAllBelowThemAreLeftOut)
{
    GltfFile file = triangle_file();
    const json hidden = { { "KHR_node_visibility", { { "visible", false } } } };
    file.root["nodes"] = { { { "children", { 1, 2 } } },
                           { { "mesh", 0 } },
                           { { "children", { 3 } }, { "extensions", hidden } },
                           { { "mesh", 0 } } };
    EXPECT_EQ(read("a.gltf", file.text()).triangles.size(), 1u);
    file.root["nodes"][2]["extensions"]["KHR_node_visibility"]["visible"] = true;
    EXPECT_EQ(read("a.gltf", file.text()).triangles.size(), 2u);
}

TEST_F(MeshFiles, TheDefaultSceneIsShown)
{
    GltfFile file = triangle_file();
    file.root["nodes"] = { { { "mesh", 0 } }, { { "mesh", 0 }, { "translation", { 0, 0, 1 } } } };
    file.root["scenes"] = { { { "nodes", { 0 } } }, { { "nodes", { 1 } } } };
    file.root["scene"] = 1;
    EXPECT_EQ(read("a.gltf", file.text()).positions, translated(kTriangleCorners, V3d(0, 0, 1)));
    file.root.erase("scene");
    EXPECT_EQ(read("a.gltf", file.text()).positions, kTriangleCorners) << "the first";
    file.root.erase("scenes");
    EXPECT_EQ(read("a.gltf", file.text()).triangles.size(), 2u) << "all nodes";
    file.root.erase("nodes");
    EXPECT_EQ(read("a.gltf", file.text()).positions, kTriangleCorners) << "a library of meshes";
    file.root["scene"] = 4;
    file.root["scenes"] = { { { "nodes", { 0 } } } };
    EXPECT_EQ(refusal(folder.write("a.gltf", file.text())), "the default scene is 4, but there are only 1");
}

TEST_F(MeshFiles, NodesAndMaterialsComeAlong)
{
    GltfFile file = triangle_file();
    file.root["materials"] = { { { "name", "red" } }, { { "name", "glass" } } };
    json second = file.primitive();
    second["material"] = 1;
    file.root["meshes"][0]["primitives"].push_back(second);
    file.root["nodes"] = { { { "name", "top" }, { "children", { 1 } } }, { { "name", "leaf" }, { "mesh", 0 } } };
    const Mesh mesh = read("a.gltf", file.text());
    ASSERT_EQ(mesh.nodes.size(), 2u);
    EXPECT_EQ(mesh.nodes[1].name, "leaf");
    EXPECT_EQ(mesh.nodes[1].parent, 0);
    EXPECT_EQ(mesh.triangle_nodes, (std::vector<uint32_t> { 1, 1 }));
    EXPECT_EQ(mesh.triangle_materials, (std::vector<uint32_t> { 2, 1 }));
    ASSERT_EQ(mesh.materials.size(), 3u);
    EXPECT_EQ(mesh.materials[1].name, "glass");
    EXPECT_EQ(mesh.materials[2].name, "") << "for what has none";
}

TEST_F(MeshFiles, AGltfWithoutNormalsIsFlat)
{
    // Two triangles that share an edge at a right angle, with shared vertices.
    GltfFile file = triangle_file();
    const size_t positions = file.add_accessor<float>({ 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1 }, "VEC3");
    file.primitive() = { { "attributes", { { "POSITION", positions } } } };
    file.primitive()["indices"] = file.add_accessor<uint8_t>({ 0, 1, 2, 0, 2, 3 }, "SCALAR");
    Mesh mesh = read("a.gltf", file.text());
    EXPECT_EQ(mesh.normals_from, "flat");
    for (size_t t = 0; t < 2; ++t)
        for (const uint32_t vertex : mesh.triangles[t])
            EXPECT_EQ(mesh.normals[vertex], t == 0 ? V3f(0, 0, 1) : V3f(1, 0, 0));
    MeshParams params;
    params.normals = "smooth";
    mesh = read("a.gltf", file.text(), params);
    EXPECT_EQ(mesh.normals_from, "smooth");
    EXPECT_EQ(mesh.positions.size(), 4u) << "shared again";
}

TEST_F(MeshFiles, GltfAnimationsAreNotPlayedAndAWarningSaysSo)
{
    GltfFile file = triangle_file();
    const std::vector<V3d> still = read("a.gltf", file.text()).positions;
    const size_t times = file.add_accessor<float>({ 0, 1 }, "SCALAR");
    const size_t places = file.add_accessor<float>({ 5, 5, 5, 6, 6, 6 }, "VEC3");
    const auto channel
        = nlohmann::json { { "sampler", 0 }, { "target", { { "node", 0 }, { "path", "translation" } } } };
    const auto sampler = nlohmann::json { { "input", times }, { "output", places } };
    // { one } is an array to gcc and `one` itself to clang.
    const auto array = [](const nlohmann::json& one) { return nlohmann::json::array({ one }); };
    file.root["animations"] = array({ { "channels", array(channel) }, { "samplers", array(sampler) } });
    const Mesh mesh = read("b.gltf", file.text());
    expect_points(mesh.positions, still);
    EXPECT_THAT(mesh.warnings,
                testing::ElementsAre("1 animation is not played: nodes stay as they are; bake other poses from a file "
                                     "each, or from Alembic"));
    for (const nlohmann::json& none : { nlohmann::json("none"), nlohmann::json::array() }) {
        file.root["animations"] = none;
        EXPECT_TRUE(read("c.gltf", file.text()).warnings.empty());
    }
}
