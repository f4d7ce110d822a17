// SPDX-License-Identifier: Apache-2.0
// Scene lists and glTF files whose instances stay instances: what is read.
#include "gltf_file.h"
#include "mesh_fixture.h"

#include <vmlight/mesh/import/scene_list.h>
#include <vmlight/mesh/instances.h>
#include <vmlight/mesh/selection.h>
#include <vmlight/stage/scene_cache.h>

#include <gmock/gmock.h>

#include <filesystem>

using namespace mesh_files;
using Imath::M44d;

namespace {

class SceneList : public MeshFiles
{
protected:
    Mesh read_caster(const std::string& path)
    {
        Mesh mesh;
        std::string error;
        EXPECT_TRUE(read_instanced_mesh(mesh, path, {}, error)) << error;
        return mesh;
    }
};

V3d point_at(const MeshInstances::Place& place, const V3d& p)
{
    V3d result;
    place.to_object.multVecMatrix(p, result);
    return result;
}

void expect_point(const V3d& found, const V3d& truth)
{
    EXPECT_LT((found - truth).length(), 1e-12) << found << " " << truth;
}

} // namespace

TEST_F(SceneList, EachFileIsReadOnceAndStandsWhereTheListSays)
{
    folder.write("quad.obj", kQuadObj);
    const std::string path = folder.write("forest.toml",
                                          "# two and one\n[[instance]]\nmesh = \"quad.obj\"\n"
                                          "[[instance]]\nmesh = \"quad.obj\"\ntranslate = [1, 2, 3]\n"
                                          "rotate = [90, 0, 90]\nscale = [1, 2, 1]\n"
                                          "[[instance]]\nmesh = \"quad.obj\"\n"
                                          "matrix = [0, 0, -1, 5, 0, 1, 0, 6, 1, 0, 0, 7]\n");
    std::vector<std::string> opened;
    Mesh mesh;
    std::string error;
    ASSERT_TRUE(read_instanced_mesh(mesh, path, {}, error, [&](const std::string& p) { opened.push_back(p); }))
        << error;
    EXPECT_TRUE(mesh.triangles.empty());
    ASSERT_TRUE(mesh.instances);
    EXPECT_EQ(mesh.instances->meshes.size(), 1u);
    EXPECT_EQ(std::count(opened.begin(), opened.end(), folder / "quad.obj"), 1);
    EXPECT_EQ(opened.front(), path);
    ASSERT_EQ(mesh.instances->places.size(), 3u);
    EXPECT_EQ(mesh.instances->triangles(), 6);
    EXPECT_EQ(mesh.instances->distinct_triangles(), 2);
    expect_point(point_at(mesh.instances->places[0], V3d(1, 2, 3)), V3d(1, 2, 3));
    // Scaled to (1, 4, 3); about x to (1, -3, 4); about z to (3, 1, 4).
    expect_point(point_at(mesh.instances->places[1], V3d(1, 2, 3)), V3d(4, 3, 7));
    expect_point(point_at(mesh.instances->places[2], V3d(1, 2, 3)), V3d(2, 8, 8));
}

TEST_F(SceneList, ListsMayContainListsWhosePathsStartAtTheirFolders)
{
    std::filesystem::create_directories(folder / "trees/meshes");
    folder.write("trees/meshes/quad.obj", kQuadObj);
    folder.write("trees/grove.toml",
                 "[[instance]]\nmesh = \"meshes/quad.obj\"\ntranslate = [1, 0, 0]\n"
                 "[[instance]]\nmesh = \"meshes/quad.obj\"\ntranslate = [2, 0, 0]\n");
    const Mesh mesh = read_caster(folder.write("land.toml",
                                               "[[instance]]\nmesh = \"trees/grove.toml\"\nscale = 10\n"
                                               "[[instance]]\nmesh = \"trees/grove.toml\"\n"
                                               "translate = [0, 5, 0]\n"));
    ASSERT_TRUE(mesh.instances);
    EXPECT_EQ(mesh.instances->meshes.size(), 1u);
    ASSERT_EQ(mesh.instances->places.size(), 4u);
    expect_point(point_at(mesh.instances->places[1], V3d(0)), V3d(20, 0, 0));
    expect_point(point_at(mesh.instances->places[2], V3d(0)), V3d(1, 5, 0));
}

TEST_F(SceneList, OnlyMaterialsThatAreAskedForAreThere)
{
    folder.write("two.mtl", "newmtl Leaf\nnewmtl Bark\n");
    folder.write("two.obj",
                 "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl Leaf\nf 1 2 3\nf 1 2 4\n"
                 "usemtl Bark\nf 1 3 4\n");
    const Mesh mesh = read_caster(folder.write("a.toml",
                                               "[[instance]]\nmesh = \"two.obj\"\nmaterial = \"Leaf\"\n"
                                               "[[instance]]\nmesh = \"two.obj\"\nmaterial = [\"B*\"]\n"
                                               "[[instance]]\nmesh = \"two.obj\"\n"));
    ASSERT_EQ(mesh.instances->meshes.size(), 3u);
    for (size_t i = 0; i < 3; ++i)
        EXPECT_EQ(mesh.instances->meshes[i].triangles.size(), (std::vector<size_t> { 2, 1, 3 })[i]);
}

TEST_F(SceneList, WhatIsBakedIsTrianglesAndTheRestCasts)
{
    folder.write("quad.obj", kQuadObj);
    const std::string path = folder.write("a.toml",
                                          "[[instance]]\nmesh = \"quad.obj\"\nname = \"house\"\nbake = true\n"
                                          "translate = [10, 0, 0]\n"
                                          "[[instance]]\nmesh = \"quad.obj\"\n"
                                          "[[instance]]\nmesh = \"quad.obj\"\nscale = [-1, 1, 1]\n");
    const Mesh mesh = read(path);
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(mesh.positions[0], V3d(10, 0, 0));
    EXPECT_EQ(mesh.nodes[0].name, "house");
    ASSERT_TRUE(mesh.instances);
    EXPECT_EQ(mesh.instances->places.size(), 2u);
    EXPECT_EQ(read_caster(path).instances->places.size(), 3u) << "as an occluder all of it casts";
    EXPECT_EQ(
        refusal(folder.write("b.toml", "[[instance]]\nmesh = \"quad.obj\"\n")),
        "a scene list of which nothing is baked: write bake = true to an instance, or pass the list as --occluder");

    VismapRecipe recipe;
    recipe.mesh = path;
    SceneStamps stamps;
    BakeScenePointer scene;
    std::string at, error;
    ASSERT_TRUE(stamp_scene(stamps, recipe, at, error)) << error;
    ASSERT_TRUE(share_scene(scene, recipe, stamps, 1, nullptr, at, error)) << error;
    EXPECT_EQ(scene->mesh().triangles.size(), 2u);
    EXPECT_FALSE(scene->mesh().instances);
    ASSERT_EQ(scene->reach().size(), 1u);
    EXPECT_EQ(scene->reach()[0].triangles, 4);
    EXPECT_EQ(scene->occluder().instances().copies, 0) << "below the horizon of the baked one, and so left out";
    EXPECT_EQ(scene->files.size(), 3u) << "the list, the mesh that is baked, and the one that casts";
}

TEST_F(SceneList, MeshesThatGltfNodesShareAreReadOnce)
{
    GltfFile file = triangle_file();
    file.root["meshes"].push_back(file.root["meshes"][0]);
    file.root["nodes"] = { { { "mesh", 0 }, { "translation", { 1, 0, 0 } } },
                           { { "mesh", 0 }, { "scale", { -2, 1, 1 } } },
                           { { "mesh", 1 }, { "translation", { 0, 0, 9 } } } };
    file.root["scenes"][0]["nodes"] = { 0, 1, 2 };
    const std::string path = folder.write("a.gltf", file.text());
    const Mesh whole = read(path), caster = read_caster(path);
    EXPECT_EQ(whole.triangles.size(), 3u);
    EXPECT_FALSE(whole.instances);
    EXPECT_EQ(caster.triangles.size(), 1u) << "shown once: not an instance";
    ASSERT_TRUE(caster.instances);
    ASSERT_EQ(caster.instances->meshes.size(), 1u);
    ASSERT_EQ(caster.instances->places.size(), 2u);
    for (size_t i = 0; i < 2; ++i) {
        const Mesh copy = placed_mesh(caster.instances->meshes[0], caster.instances->places[i].to_object);
        for (size_t k = 0; k < 3; ++k)
            expect_point(copy.positions[copy.triangles[0][k]], whole.positions[whole.triangles[i][k]]);
    }
}

TEST_F(SceneList, GpuInstancesStayInstances)
{
    GltfFile file = triangle_file();
    const size_t translation = file.add_accessor<float>({ 10, 0, 0, 0, 20, 0, 0, 0, 30 }, "VEC3");
    file.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = { { "TRANSLATION", translation } };
    const std::string path = folder.write("a.gltf", file.text());
    const Mesh caster = read_caster(path);
    EXPECT_TRUE(caster.triangles.empty());
    ASSERT_EQ(caster.instances->places.size(), 3u);
    expect_point(point_at(caster.instances->places[2], V3d(0)), V3d(0, 0, 30));
    // Within a list, both transforms apply.
    const Mesh listed = read_caster(folder.write("l.toml",
                                                 "[[instance]]\nmesh = \"a.gltf\"\nscale = 2\n"
                                                 "[[instance]]\nmesh = \"a.gltf\"\ntranslate = [0, 1, 0]\n"));
    EXPECT_EQ(listed.instances->meshes.size(), 1u);
    ASSERT_EQ(listed.instances->places.size(), 6u);
    expect_point(point_at(listed.instances->places[2], V3d(0)), V3d(0, 0, 60));
    expect_point(point_at(listed.instances->places[4], V3d(0)), V3d(0, 21, 0));
    EXPECT_NE(mesh_hash(listed), mesh_hash(caster));
}

TEST_F(SceneList, InstancesThatAreBakedAreEntriesAndNodesWithAMesh)
{
    GltfFile file = triangle_file();
    file.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"]
        = file.add_accessor<float>({ 0, 0, 1, 0, 0, 1 }, "VEC2");
    file.root["nodes"] = { { { "mesh", 0 }, { "name", "left" } },
                           { { "children", { 2 } }, { "name", "group" } },
                           { { "mesh", 0 }, { "name", "right" } } };
    file.root["scenes"][0]["nodes"] = { 0, 1 };
    const std::string path = folder.write("a.gltf", file.text());
    EXPECT_THAT(baked_instances(read(path)), testing::ElementsAre("left", "right"));
    const std::string list = "[[instance]]\nmesh = \"a.gltf\"\nbake = true\nname = \"pair\"\n"
                             "[[instance]]\nmesh = \"a.gltf\"\nbake = true\n[[instance]]\nmesh = \"a.gltf\"\n";
    EXPECT_THAT(baked_instances(read(folder.write("l.toml", list))), testing::ElementsAre("pair", "a.gltf"))
        << "an entry is baked as one";
    EXPECT_TRUE(baked_instances(read(folder.write("quad.obj", kQuadObj))).empty());
}

TEST_F(SceneList, MillionsOfInstancesFitWhereTheirTrianglesWouldNot)
{
    GltfFile file = triangle_file();
    for (const int count : { 100000, 50000 })
        file.root["accessors"].push_back({ { "componentType", 5126 }, { "count", count }, { "type", "VEC3" } });
    file.primitive() = { { "attributes", { { "POSITION", 4 } } } };
    file.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = { { "TRANSLATION", 5 } };
    const Mesh caster = read_caster(folder.write("a.gltf", file.text()));
    EXPECT_EQ(caster.instances->places.size(), 50000u);
    EXPECT_EQ(caster.instances->triangles(), int64_t(50000) * (100000 / 3));
}

TEST_F(SceneList, MaterialsOfInstancesAreCutOut)
{
    folder.write("roof.mtl", "newmtl Glass\nd 0\nnewmtl Tile\n");
    const std::string corners = "mtllib roof.mtl\nv 0 0 1\nv 2 0 1\nv 2 3 1\nv 0 3 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
    folder.write("glass.obj", corners + "usemtl Glass\nf 1/1 2/2 3/3 4/4\n");
    folder.write("tile.obj", corners + "usemtl Tile\nf 1/1 2/2 3/3 4/4\n");
    const auto cutouts = [&](const char* roof, const char* mode) {
        VismapRecipe recipe;
        recipe.mesh = folder.write("floor.obj", kQuadObj);
        recipe.occluder
            = { folder.write("roof.toml", std::string("[[instance]]\nmesh = \"") + roof + "\"\nscale = [3, 3, 1]\n") };
        recipe.cutout_params.cutouts = mode;
        SceneStamps stamps;
        BakeScenePointer scene;
        std::string at, error;
        EXPECT_TRUE(stamp_scene(stamps, recipe, at, error)) << error;
        EXPECT_TRUE(share_scene(scene, recipe, stamps, 1, nullptr, at, error)) << error;
        EXPECT_EQ(scene->opacity_hashes() == ",", scene->occluder().cutouts().triangles == 0);
        return scene->occluder().cutouts();
    };
    EXPECT_EQ(cutouts("glass.obj", "auto").transparent, 2);
    EXPECT_EQ(cutouts("glass.obj", "off").triangles, 0);
    EXPECT_EQ(cutouts("tile.obj", "auto").triangles, 0);
}
