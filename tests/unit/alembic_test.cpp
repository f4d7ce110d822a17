// SPDX-License-Identifier: Apache-2.0
// Alembic meshes: faces, texture coordinates, normals.
#include "alembic_file.h"
#include "baked_map.h"

#include <OpenImageIO/strutil.h>

#include <gtest/gtest.h>

using namespace mesh_files;
using namespace alembic_files;

namespace {

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
    Abc::OV2fGeomParam::Sample alembic_uvs() const
    {
        return alembic_files::uvs(uvs, Abc::kFacevaryingScope, uv_indices);
    }
};

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
