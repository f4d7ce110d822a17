// SPDX-License-Identifier: Apache-2.0
// Alembic meshes: faces, texture coordinates, normals, materials, places.
#include "alembic_file.h"
#include "baked_map.h"

#include <vmlight/mesh/selection.h>

#include <OpenImageIO/strutil.h>

#include <gmock/gmock.h>

using namespace mesh_files;
using namespace alembic_files;
using testing::ElementsAre;

namespace {

using Values = std::vector<V2f>;

Abc::OV2fGeomParam::Sample uvs(const Values& values, Abc::GeometryScope scope,
                               const std::vector<uint32_t>& indices = {})
{
    Abc::OV2fGeomParam::Sample sample;
    sample.setVals(Abc::V2fArraySample(kept(values)));
    sample.setScope(scope);
    if (!indices.empty())
        sample.setIndices(Abc::UInt32ArraySample(kept(indices)));
    return sample;
}

Abc::ON3fGeomParam::Sample normals(const std::vector<V3f>& values, Abc::GeometryScope scope)
{
    return { Abc::N3fArraySample(kept(values)), scope };
}

// The quad's texture coordinate at a position: the same in all tests, whatever stores it.
V2f uv_at(const V3d& p)
{
    return V2f(float(p.x) / 4 + 0.25f, float(p.y) / 8 + 0.125f);
}

// A box of six quads with outward faces, as an OBJ and as polygons, with normals and each face in a cell of its own.
struct Box
{
    std::string obj;
    Polygons polygons;
    Values uvs;
    std::vector<uint32_t> uv_indices;
    std::vector<V3f> normals;

    Box()
    {
        const int faces[6][4]
            = { { 0, 4, 6, 2 }, { 1, 3, 7, 5 }, { 0, 1, 5, 4 }, { 2, 6, 7, 3 }, { 0, 2, 3, 1 }, { 4, 5, 7, 6 } };
        for (int i = 0; i < 8; ++i)
            polygons.points.emplace_back(i & 1 ? 1.f : -1.f, i & 2 ? 2.f : -2.f, i & 4 ? 0.5f : -0.5f);
        for (const V3f& p : polygons.points)
            obj += OIIO::Strutil::sprintf("v %g %g %g\n", p.x, p.y, p.z);
        for (int row = 0; row < 5; ++row) // shared by the cells
            for (int column = 0; column < 6; ++column)
                uvs.emplace_back(column / 8.f + 0.0625f, row / 8.f + 0.0625f);
        for (const V2f& uv : uvs)
            obj += OIIO::Strutil::sprintf("vt %g %g\n", uv.x, uv.y);
        for (int face = 0; face < 6; ++face) {
            V3f normal(0);
            normal[face / 2] = face % 2 ? 1.f : -1.f;
            obj += OIIO::Strutil::sprintf("vn %g %g %g\n", normal.x, normal.y, normal.z);
            const int corner = (face / 3) * 2 * 6 + face % 3 * 2;
            const int cell[] = { corner, corner + 1, corner + 7, corner + 6 };
            std::string line = "f";
            for (int k = 0; k < 4; ++k)
                line += OIIO::Strutil::sprintf(" %d/%d/%d", faces[face][k] + 1, cell[k] + 1, face + 1);
            obj += line + "\n";
            for (int k = 3; k >= 0; --k) { // clockwise
                polygons.corners.push_back(faces[face][k]);
                uv_indices.push_back(uint32_t(cell[k]));
                normals.push_back(normal);
            }
            polygons.counts.push_back(4);
        }
        polygons.uvs = alembic_uvs();
        polygons.normals = { Abc::N3fArraySample(normals), Abc::kFacevaryingScope };
    }
    Abc::OV2fGeomParam::Sample alembic_uvs() const { return ::uvs(uvs, Abc::kFacevaryingScope, uv_indices); }
};

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

TEST_F(MeshFiles, AnAlembicBoxIsTheObjBoxBitForBit)
{
    const Box box;
    const Mesh truth = read("box.obj", box.obj), mesh = read(mesh_file(folder / "box.abc", { box.polygons }));
    ASSERT_EQ(mesh.triangles.size(), 12u);
    EXPECT_EQ(mesh_hash(mesh), mesh_hash(truth));
    EXPECT_EQ(mesh.normals_from, "from the file");
    EXPECT_TRUE(mesh.warnings.empty());
    for (const auto& t : mesh.triangles) { // the box is around the origin
        EXPECT_GT(triangle_area_normal(mesh, t).dot(mesh.positions[t[0]]), 0);
        EXPECT_GT(triangle_area_normal(mesh, t).dot(V3d(mesh.normals[t[0]])), 0);
    }
    VismapParams params;
    params.resolution = { 32, 32 };
    params.samples = 16;
    const BakedMap map(mesh, {}, params), other(truth, {}, params);
    int open = 0;
    map.each([&](const Texel& texel, int x, int y) {
        EXPECT_TRUE(texel == other.at(x, y)) << x << ", " << y;
        open += texel.visibility == 1;
    });
    EXPECT_GT(open, 100); // a convex box occludes nothing
}

TEST_F(MeshFiles, AlembicUvsOfEveryScopeFollowTheirCorners)
{
    const Polygons bare = quad();
    Values of_vertices, of_corners;
    for (const V3f& point : bare.points)
        of_vertices.push_back(uv_at(V3d(point)));
    for (const int32_t vertex : bare.corners)
        of_corners.push_back(of_vertices[size_t(vertex)]);
    const Values shuffled { of_vertices[2], of_vertices[0], V2f(9), of_vertices[3], of_vertices[1] };
    const std::vector<uint32_t> by_corner { 3, 0, 4, 1 }, by_vertex { 1, 4, 0, 3 };
    const std::pair<const char*, Abc::OV2fGeomParam::Sample> cases[] = {
        { "corners", uvs(of_corners, Abc::kFacevaryingScope) },
        { "vertices", uvs(of_vertices, Abc::kVertexScope) },
        { "varying", uvs(of_vertices, Abc::kVaryingScope) },
        { "indexed corners", uvs(shuffled, Abc::kFacevaryingScope, by_corner) },
        { "indexed vertices", uvs(shuffled, Abc::kVertexScope, by_vertex) },
        { "indexed varying", uvs(shuffled, Abc::kVaryingScope, by_vertex) },
    };
    for (const auto& [what, sample] : cases) {
        SCOPED_TRACE(what);
        Polygons polygons = bare;
        polygons.uvs = sample;
        const Mesh mesh = read(mesh_file(folder / "uv.abc", { polygons }));
        ASSERT_EQ(mesh.uvs.size(), 4u);
        for (size_t v = 0; v < 4; ++v)
            EXPECT_EQ(mesh.uvs[v], uv_at(mesh.positions[v]));
    }
    // One for each face, and one for all.
    Polygons two = bare;
    two.corners = { 2, 1, 0, 3, 2, 0 };
    two.counts = { 3, 3 };
    two.uvs = uvs({ V2f(0.25f), V2f(0.75f) }, Abc::kUniformScope);
    Mesh mesh = read(mesh_file(folder / "uv.abc", { two }));
    ASSERT_EQ(mesh.triangles.size(), 2u);
    for (size_t t = 0; t < 2; ++t)
        for (const uint32_t vertex : mesh.triangles[t])
            EXPECT_EQ(mesh.uvs[vertex], V2f(t == 0 ? 0.25f : 0.75f));
    two.uvs = uvs({ V2f(0.5f) }, Abc::kConstantScope);
    mesh = read(mesh_file(folder / "uv.abc", { two }));
    EXPECT_EQ(mesh.uvs, Values(4, V2f(0.5f)));
}

TEST_F(MeshFiles, FurtherAlembicUvSetsAreAmongArbitraryParameters)
{
    const std::string path = folder / "sets.abc";
    {
        Archive archive(path);
        Polygons polygons = quad();
        polygons.uvs = uvs(Values(4, V2f(0.25f)), Abc::kVertexScope);
        Abc::OPolyMesh mesh = Archive::add_mesh(archive.top(), "leaf", { polygons });
        const Abc::OCompoundProperty others = mesh.getSchema().getArbGeomParams();
        Abc::MetaData speed;
        Abc::SetIsUV(speed, false);
        Abc::OV2fGeomParam(others, "speed", false, Abc::kVertexScope, 1, speed)
            .set(uvs(Values(4, V2f(0.125f)), Abc::kVertexScope));
        Abc::OV2fGeomParam(others, "plain", false, Abc::kVertexScope, 1)
            .set(uvs(Values(4, V2f(0.5f)), Abc::kVertexScope));
        Abc::OV2fGeomParam(others, "indexed", true, Abc::kFacevaryingScope, 1)
            .set(uvs({ V2f(0.75f) }, Abc::kFacevaryingScope, { 0, 0, 0, 0 }));
    }
    const float expected[] = { 0.25f, 0.5f, 0.75f };
    MeshParams params;
    for (params.uv_set = 0; params.uv_set < 3; ++params.uv_set)
        EXPECT_EQ(read(path, params).uvs, Values(4, V2f(expected[params.uv_set]))) << params.uv_set;
    EXPECT_TRUE(read(path, params).uvs.empty()) << "there is no set 3";
}

TEST_F(MeshFiles, AlembicNormalsOfEveryScopeTurnWithTheirObject)
{
    const V3f slanted = V3f(1, 1, 1).normalized();
    const std::pair<size_t, Abc::GeometryScope> cases[] = { { 4, Abc::kFacevaryingScope },
                                                            { 4, Abc::kVertexScope },
                                                            { 4, Abc::kVaryingScope },
                                                            { 1, Abc::kUniformScope },
                                                            { 1, Abc::kConstantScope } };
    for (const auto& [count, scope] : cases) {
        const std::string path = folder / "n.abc";
        {
            Archive archive(path);
            Polygons polygons = quad();
            const std::vector<V3f> values(count, slanted);
            polygons.normals = normals(values, scope);
            Abc::XformSample flattened;
            flattened.setScale(V3d(1, 1, 0.5));
            Archive::add_mesh(Archive::add_xform(archive.top(), "flat", { flattened }), "leaf", { polygons });
        }
        const Mesh mesh = read(path);
        EXPECT_EQ(mesh.normals_from, "from the file");
        ASSERT_EQ(mesh.normals.size(), 4u);
        for (const V3f& normal : mesh.normals) // a surface that is flattened faces more the way it is flattened
            EXPECT_LT((normal - V3f(1, 1, 2).normalized()).length(), 1e-6f) << int(scope);
    }
}

TEST_F(MeshFiles, MissingAlembicNormalsAreSmooth)
{
    Box box;
    box.polygons.normals = {};
    box.polygons.uvs = {};
    Mesh mesh = read(mesh_file(folder / "box.abc", { box.polygons }));
    EXPECT_EQ(mesh.normals_from, "smooth");
    EXPECT_EQ(mesh.positions.size(), 8u);
    for (size_t v = 0; v < mesh.positions.size(); ++v) // three right angles meet in each corner
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(mesh.normals[v][axis], std::sqrt(1 / 3.0) * (mesh.positions[v][axis] > 0 ? 1 : -1), 1e-6);
    MeshParams flat;
    flat.normals = "flat";
    EXPECT_EQ(read(folder / "box.abc", flat).positions.size(), 24u);
    // Some are missing: zero.
    Polygons polygons = quad();
    const std::vector<V3f> some { V3f(0, 1, 0), V3f(0), V3f(0), V3f(0) };
    polygons.normals = normals(some, Abc::kVertexScope);
    mesh = read(mesh_file(folder / "some.abc", { polygons }));
    for (size_t v = 0; v < 4; ++v)
        EXPECT_EQ(mesh.normals[v], mesh.positions[v] == V3d(0) ? V3f(0, 1, 0) : V3f(0, 0, 1));
}

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
