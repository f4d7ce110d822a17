// SPDX-License-Identifier: Apache-2.0
// Alembic objects: where they are, what is hidden, their materials.
#include "alembic_file.h"

#include <vmlight/mesh/selection.h>

#include <gmock/gmock.h>

using namespace mesh_files;
using namespace alembic_files;
using testing::ElementsAre;

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
