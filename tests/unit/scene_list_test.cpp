// SPDX-License-Identifier: Apache-2.0
// Scene lists and glTF files whose instances stay instances: what is read, and what is refused.
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
using testing::HasSubstr;

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
    // What is said of a list with one instance of these keys.
    std::string said(const std::string& keys)
    {
        const std::string path = folder.write("bad.toml", "[[instance]]\n" + keys);
        Mesh mesh;
        std::string error;
        EXPECT_FALSE(read_instanced_mesh(mesh, path, {}, error)) << keys;
        const std::string head = "\"" + path + "\": ";
        EXPECT_EQ(error.substr(0, head.size()), head);
        EXPECT_EQ(error.find('\n'), std::string::npos);
        return error.substr(std::min(error.size(), head.size()));
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

TEST_F(SceneList, CyclesAndMissingFilesAreNamed)
{
    folder.write("b.toml", "[[instance]]\nmesh = \"a.toml\"\n");
    const std::string a = folder.write("a.toml", "[[instance]]\nmesh = \"b.toml\"\n");
    Mesh mesh;
    std::string error;
    EXPECT_FALSE(read_instanced_mesh(mesh, a, {}, error));
    EXPECT_EQ(error,
              "\"" + a + "\": line 1: \"" + (folder / "b.toml") + "\": line 1: \"" + a + "\": \"" + a
                  + "\" contains itself");
    EXPECT_EQ(said("mesh = \"gone.obj\"\n"), "line 1: \"" + (folder / "gone.obj") + "\": no such file");
}

TEST_F(SceneList, ErrorsOfAnInstanceNameTheLineOfTheKey)
{
    folder.write("quad.obj", kQuadObj);
    const std::string mesh = "mesh = \"quad.obj\"\n";
    EXPECT_EQ(said("translate = [1, 2, 3]\n"), "line 1: an instance without mesh, the path of a file in quotes");
    EXPECT_EQ(said("mesh = 3\n"), "line 2: an instance without mesh, the path of a file in quotes");
    EXPECT_EQ(said(mesh + "colour = 1\n"), "line 3: unknown key \"colour\" of an instance");
    EXPECT_EQ(said(mesh + "translate = [1, 2]\n"), "line 3: translate is not three numbers in brackets");
    EXPECT_EQ(said(mesh + "rotate = 90\n"), "line 3: rotate is not three numbers in brackets");
    EXPECT_EQ(said(mesh + "scale = [\"1\", 2, 3]\n"), "line 3: scale is not one number, or three numbers in brackets");
    EXPECT_THAT(said(mesh + "scale = 0\n"), HasSubstr("line 3: the transform is singular"));
    EXPECT_THAT(said(mesh + "scale = [1, 0, 1]\n"), HasSubstr("line 3: the transform is singular"));
    EXPECT_THAT(said(mesh + "matrix = [1, 0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0]\n"), HasSubstr("singular"));
    EXPECT_EQ(said(mesh + "scale = inf\n"), "line 1: the transform is not finite");
    EXPECT_EQ(said(mesh + "translate = [nan, 0, 0]\n"), "line 1: the transform is not finite");
    EXPECT_EQ(said(mesh + "matrix = [1, 2, 3]\n"), "line 3: matrix is not 12 or 16 numbers in brackets, row by row");
    EXPECT_EQ(said(mesh + "matrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2]\n"),
              "line 3: the last row of matrix is not 0, 0, 0, 1");
    EXPECT_EQ(said(mesh + "scale = 2\nmatrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]\n"),
              "line 4: matrix stands for translate, rotate and scale: give one or the others");
    EXPECT_EQ(said(mesh + "bake = 1\n"), "line 3: bake is neither true nor false");
    EXPECT_EQ(said(mesh + "name = 1\n"), "line 3: name is not a string");
    EXPECT_EQ(said(mesh + "material = [1]\n"), "line 3: material is neither a name in quotes nor an array of them");
    EXPECT_THAT(said(mesh + "material = \"Bark\"\n"),
                HasSubstr("line 1: \"" + (folder / "quad.obj") + "\": no material"));
    EXPECT_THAT(said(mesh + "[[tree]]\n"), HasSubstr("unknown key \"tree\""));
    EXPECT_THAT(said(mesh + "scale = tiny\n"), HasSubstr("line 3: not TOML"));
    EXPECT_THAT(said(mesh + "scale = [-1, 1, 1]\n[[instance]]\nmesh = \"\"\n"),
                HasSubstr("line 5: an instance without"))
        << "a mirror is allowed";
}

TEST_F(SceneList, TheExtensionIsThatOfASceneListWhateverIsInside)
{
    Mesh mesh;
    std::string error;
    const std::string none = folder.write("none.toml", "title = \"village\"\n");
    EXPECT_FALSE(read_instanced_mesh(mesh, none, {}, error));
    EXPECT_EQ(error, "\"" + none + "\": unknown key \"title\": a scene list has tables [[instance]] alone");
    const std::string empty = folder.write("empty.toml", "");
    EXPECT_FALSE(read_instanced_mesh(mesh, empty, {}, error));
    EXPECT_EQ(error, "\"" + empty + "\": no [[instance]]");
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
