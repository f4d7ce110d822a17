// SPDX-License-Identifier: Apache-2.0
// Alembic objects: where they are, what is hidden, their materials.
#include "alembic_file.h"

#include <vmlight/mesh/instances.h>
#include <vmlight/mesh/selection.h>

#include <gmock/gmock.h>

using namespace mesh_files;
using namespace alembic_files;
using testing::ElementsAre;
using testing::IsEmpty;

namespace {

std::vector<std::string> node_names(const Mesh& mesh)
{
    std::vector<std::string> names;
    for (const MeshNode& node : mesh.nodes)
        names.push_back(node.parent < 0 ? node.name : mesh.nodes[size_t(node.parent)].name + "/" + node.name);
    return names;
}

void expect_corners(const Mesh& mesh, const std::vector<V3d>& expected)
{
    ASSERT_EQ(mesh.positions.size(), expected.size());
    for (const V3d& point : expected)
        EXPECT_TRUE(std::any_of(mesh.positions.begin(), mesh.positions.end(), [&](const V3d& p) {
            return (p - point).length() < 1e-6;
        })) << point;
}

Mesh read_caster(const std::string& path, const MeshParams& params = {})
{
    Mesh mesh;
    std::string error;
    EXPECT_TRUE(read_instanced_mesh(mesh, path, params, error)) << error;
    return mesh;
}

} // namespace

TEST_F(MeshFiles, AlembicObjectsAreWhereTheirParentsPutThem)
{
    const std::string path = folder / "nested.abc";
    {
        Archive archive(path);
        Abc::XformSample outer, inner, mirror, alone;
        outer.setTranslation(V3d(10, 0, 0));
        outer.setRotation(V3d(0, 0, 1), 90); // x to y
        inner.setScale(V3d(2, 1, 1));
        mirror.setMatrix(M44d(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1));
        alone.setXRotation(90); // y to z
        alone.setInheritsXforms(false);
        Abc::OXform a = Archive::add_xform(archive.top(), "a", { outer });
        Archive::add_mesh(Archive::add_xform(a, "b", { inner }), "scaled", { quad() });
        Archive::add_mesh(Archive::add_xform(a, "c", { mirror }), "mirrored", { quad() });
        Archive::add_mesh(Archive::add_xform(a, "d", { alone }), "alone", { quad() });
        Abc::OCamera camera(a, "eye"); // which is no mesh
        camera.getSchema().set(Abc::CameraSample());
    }
    const Mesh mesh = read(path);
    EXPECT_THAT(node_names(mesh), ElementsAre("a", "a/b", "b/scaled", "a/c", "c/mirrored", "a/d", "d/alone", "a/eye"));
    expect_corners(mesh,
                   { V3d(10, 0, 0), V3d(10, 4, 0), V3d(7, 4, 0), V3d(7, 0, 0), // scaled, turned, moved
                     V3d(10, 0, 5), V3d(10, -2, 5), V3d(7, -2, 5), V3d(7, 0, 5), // mirrored in x
                     V3d(0, 0, 0), V3d(2, 0, 0), V3d(2, 0, 3), V3d(0, 0, 3) });
    // Front sides stay in front: +z twice, and -y.
    EXPECT_LT((area_vector(mesh) - V3d(0, -6, 12 + 6)).length(), 1e-6);
    MeshParams z_up;
    z_up.up = "z";
    EXPECT_LT((area_vector(read(path, z_up)) - V3d(0, 18, 6)).length(), 1e-6);
}

TEST_F(MeshFiles, AlembicInstancesAreMeshesOfTheirOwn)
{
    const std::string path = folder / "instances.abc";
    {
        Archive archive(path);
        Abc::OXform source = Archive::add_xform(archive.top(), "source", { Archive::translation(V3d(0, 0, 1)) });
        Archive::add_mesh(source, "leaf", { quad() });
        Abc::OXform far = Archive::add_xform(archive.top(), "far", { Archive::translation(V3d(100, 0, 0)) });
        far.addChildInstance(source, "copy");
        Abc::OXform farther = Archive::add_xform(archive.top(), "farther", { Archive::translation(V3d(0, 100, 0)) });
        farther.addChildInstance(far, "copies"); // an instance of what has an instance
    }
    const Mesh mesh = read(path);
    EXPECT_THAT(node_names(mesh),
                ElementsAre("source", "source/leaf", "far", "far/copy", "copy/leaf", "farther", "farther/copies",
                            "copies/copy", "copy/leaf"));
    std::vector<V3d> expected;
    for (const V3d& at : { V3d(0, 0, 1), V3d(100, 0, 1), V3d(100, 100, 1) })
        for (const V3f& point : quad().points)
            expected.push_back(V3d(point) + at);
    expect_corners(mesh, expected);
}

// Three copies of a quad, one of them hidden, and a mesh that is there once; a material for one of them.
std::string shared_quads(const std::string& path)
{
    Archive archive(path);
    Abc::OXform source = Archive::add_xform(archive.top(), "source", { Archive::translation(V3d(0, 0, 1)) });
    Abc::OPolyMesh leaf = Archive::add_mesh(source, "leaf", { quad() });
    leaf.getSchema().createFaceSet("Leaf").getSchema().set(
        Abc::OFaceSetSchema::Sample(Abc::Int32ArraySample(kept(std::vector<int32_t> { 0 }))));
    Abc::XformSample mirror;
    mirror.setScale(V3d(-2, 1, 1));
    Archive::add_xform(archive.top(), "mirror", { mirror }).addChildInstance(source, "copy");
    Abc::OXform moving = Archive::add_xform(archive.top(), "moving",
                                            { Archive::translation(V3d(0)), Archive::translation(V3d(9, 0, 0)) });
    moving.addChildInstance(leaf, "shape"); // of the mesh itself
    Abc::OXform hidden = Archive::add_xform(archive.top(), "hidden", { {} });
    Abc::CreateVisibilityProperty(hidden, 0).set(int8_t(Abc::kVisibilityHidden));
    hidden.addChildInstance(leaf, "shape");
    Archive::add_mesh(archive.top(), "once", { moved(quad(), V3f(0, 0, -1)) });
    return path;
}

TEST_F(MeshFiles, AlembicInstancesOfAnOccluderAreHeldOnce)
{
    const std::string path = shared_quads(folder / "instances.abc");
    const Mesh whole = read(path), caster = read_caster(path);
    EXPECT_EQ(whole.triangles.size(), 8u);
    EXPECT_FALSE(whole.instances);
    EXPECT_EQ(caster.triangles.size(), 2u) << "shown once: not an instance";
    EXPECT_EQ(caster.warnings, whole.warnings);
    ASSERT_TRUE(caster.instances);
    ASSERT_EQ(caster.instances->meshes.size(), 1u);
    ASSERT_EQ(caster.instances->places.size(), 3u);
    ASSERT_EQ(caster.instances->meshes[0].materials.size(), 1u);
    EXPECT_EQ(caster.instances->meshes[0].materials[0].name, "Leaf");
    for (size_t i = 0; i < 3; ++i) {
        const Mesh copy = placed_mesh(caster.instances->meshes[0], caster.instances->places[i].to_object);
        for (size_t t = 0; t < 2; ++t)
            for (size_t k = 0; k < 3; ++k)
                EXPECT_EQ(copy.positions[copy.triangles[t][k]], whole.positions[whole.triangles[2 * i + t][k]]);
    }
    MeshParams later;
    later.frame = 2;
    EXPECT_EQ(read_caster(path, later).instances->places[2].to_object[3][0], 9) << "at its moment";
}

TEST_F(MeshFiles, AlembicInstancesOfAMeshWithoutTrianglesAreNone)
{
    const std::string path = folder / "empty.abc";
    const auto write_file = [&](bool has_quad) {
        Archive archive(path);
        Abc::OXform source = Archive::add_xform(archive.top(), "source", { {} });
        Archive::add_mesh(source, "nothing", { Polygons { { V3f(0) }, {}, {}, {}, {} } });
        Archive::add_xform(archive.top(), "other", { {} }).addChildInstance(source, "copy");
        if (has_quad)
            Archive::add_mesh(archive.top(), "quad", { quad() });
    };
    write_file(true);
    const Mesh caster = read_caster(path);
    EXPECT_EQ(caster.triangles.size(), 2u);
    EXPECT_FALSE(caster.instances);
    write_file(false);
    Mesh mesh;
    std::string error;
    EXPECT_FALSE(read_instanced_mesh(mesh, path, {}, error));
    EXPECT_THAT(error, testing::EndsWith("no triangles"));
}

TEST_F(MeshFiles, AnAlembicMeshAloneBelowItsTransformIsAnInstanceByThatName)
{
    const std::string path = folder / "a.abc";
    Polygons textured = quad();
    textured.uvs = uvs({ V2f(0, 0), V2f(1, 0), V2f(1, 1), V2f(0, 1) }, Abc::kFacevaryingScope);
    {
        Archive archive(path);
        Abc::OXform house = Archive::add_xform(archive.top(), "house", { {} });
        Archive::add_mesh(house, "shape", { textured });
        Archive::add_xform(archive.top(), "street", { {} }).addChildInstance(house, "copy");
        Abc::OXform pair = Archive::add_xform(archive.top(), "pair", { {} });
        Archive::add_mesh(pair, "left", { textured });
        Archive::add_mesh(pair, "right", { textured });
        Archive::add_mesh(archive.top(), "top", { textured });
    }
    EXPECT_THAT(baked_instances(read(path)), ElementsAre("house", "copy", "left", "right", "top"));
    EXPECT_THAT(baked_instances(read(mesh_file(folder / "bare.abc", { quad() }))), IsEmpty()) << "without UVs";
}

TEST_F(MeshFiles, HiddenAlembicObjectsAreLeftOut)
{
    const std::string path = folder / "hidden.abc";
    const auto show = [](Abc::OObject object, Abc::ObjectVisibility visibility) {
        Abc::CreateVisibilityProperty(object, 0).set(int8_t(visibility));
    };
    {
        Archive archive(path);
        Abc::OXform off = Archive::add_xform(archive.top(), "off", { {} });
        show(off, Abc::kVisibilityHidden);
        Archive::add_mesh(off, "gone", { quad() });
        show(Archive::add_mesh(off, "gone too", { quad() }), Abc::kVisibilityDeferred);
        show(Archive::add_mesh(off, "shown", { moved(quad(), V3f(5, 0, 0)) }), Abc::kVisibilityVisible);
        show(Archive::add_mesh(archive.top(), "off as well", { quad() }), Abc::kVisibilityHidden);
    }
    const Mesh mesh = read(path);
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_GE(mesh.positions[0].x, 5);
    EXPECT_THAT(mesh.warnings,
                ElementsAre("hidden, so neither baked nor occluding: \"/off/gone\", \"/off/gone too\", "
                            "\"/off as well\""));
}

TEST_F(MeshFiles, AlembicFaceSetsAreMaterials)
{
    const std::string path = folder / "sets.abc";
    {
        Archive archive(path);
        Polygons two = quad();
        two.corners = { 2, 1, 0, 3, 2, 0 };
        two.counts = { 3, 3 };
        const auto add = [](Abc::OPolyMesh mesh, const char* name, const std::vector<int32_t>& faces) {
            mesh.getSchema().createFaceSet(name).getSchema().set({ Abc::Int32ArraySample(faces) });
        };
        Abc::OPolyMesh a = Archive::add_mesh(archive.top(), "a", { two });
        add(a, "wood", { 0 });
        add(a, "steel", { 1 });
        Abc::OPolyMesh b = Archive::add_mesh(archive.top(), "b", { two });
        add(b, "steel", { 0 });
        Abc::OPolyMesh c = Archive::add_mesh(archive.top(), "c", { two });
        add(c, "all", { 0, 1 });
        add(c, "steel", { 1 });
    }
    const Mesh mesh = read(path);
    std::vector<std::string> names;
    for (const uint32_t material : mesh.triangle_materials)
        names.push_back(mesh.materials[material].name);
    EXPECT_THAT(names, ElementsAre("wood", "steel", "steel", "", "all", "all"));
    EXPECT_EQ(mesh.materials.size(), 4u) << "one for each name";
    EXPECT_THAT(mesh.warnings, ElementsAre("\"/c\": some faces are in several face sets: the first is their material"));
    MeshSelection selection;
    selection.material = { "steel" };
    selection.node = { "b" };
    std::vector<bool> chosen;
    std::string at, error;
    EXPECT_TRUE(choose_triangles(chosen, mesh, selection, at, error)) << error;
    EXPECT_THAT(chosen, ElementsAre(false, false, true, false, false, false));
}

TEST_F(MeshFiles, AlembicSubdivisionSurfacesAreTheirCages)
{
    const std::string path = folder / "cage.abc";
    {
        Archive archive(path);
        Abc::OSubD cage(archive.top(), "cage");
        const std::vector<int32_t> corners { 2, 1, 0, 3, 2, 0 }, counts { 3, 3 }, holes { 1 };
        const Polygons polygons = quad();
        Abc::OSubDSchema::Sample sample { Abc::P3fArraySample(polygons.points), Abc::Int32ArraySample(corners),
                                          Abc::Int32ArraySample(counts) };
        sample.setHoles(Abc::Int32ArraySample(holes));
        const Values values { V2f(0, 0), V2f(1, 0), V2f(1, 1), V2f(0, 1) };
        sample.setUVs(uvs(values, Abc::kVertexScope));
        cage.getSchema().set(sample);
    }
    const Mesh mesh = read(path);
    ASSERT_EQ(mesh.triangles.size(), 1u) << "the other face is a hole";
    EXPECT_EQ(area_vector(mesh), V3d(0, 0, 3));
    EXPECT_EQ(mesh.normals_from, "smooth");
    for (size_t v = 0; v < 3; ++v)
        EXPECT_EQ(mesh.uvs[v], V2f(mesh.positions[v].x > 0, mesh.positions[v].y > 0));
    EXPECT_THAT(mesh.warnings, ElementsAre("subdivision surfaces, read as their control cages: \"/cage\""));
}
