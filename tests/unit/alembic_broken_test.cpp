// SPDX-License-Identifier: Apache-2.0
// Alembic files that are damaged, or say what cannot be.
#include "alembic_file.h"

#include <gmock/gmock.h>

#include <limits>

using namespace mesh_files;
using namespace alembic_files;
using testing::HasSubstr;

namespace {

// Everything that the reader looks at, in a few kilobytes.
std::string all_of_it(const std::string& path)
{
    Archive archive(path);
    Polygons polygons = quad();
    const std::vector<V2f> uvs { V2f(0, 0), V2f(1, 0), V2f(1, 1), V2f(0, 1) };
    const std::vector<uint32_t> indices { 3, 2, 1, 0 };
    polygons.uvs = { Abc::V2fArraySample(uvs), Abc::UInt32ArraySample(indices), Abc::kFacevaryingScope };
    const std::vector<V3f> up(4, V3f(0, 0, 1));
    polygons.normals = { Abc::N3fArraySample(up), Abc::kFacevaryingScope };
    Abc::XformSample sample, later;
    for (Abc::XformSample* either : { &sample, &later }) {
        either->setTranslation(V3d(1, 2, 3));
        either->setRotation(V3d(0, 1, 0), either == &later ? 40 : 30);
    }
    Abc::OXform source = Archive::add_xform(archive.top(), "source", { sample, later });
    Abc::OPolyMesh mesh = Archive::add_mesh(source, "leaf", { polygons, moved(polygons, V3f(1)) });
    const std::vector<int32_t> faces { 0 };
    mesh.getSchema().createFaceSet("wood").getSchema().set({ Abc::Int32ArraySample(faces) });
    Abc::CreateVisibilityProperty(mesh, 0).set(int8_t(Abc::kVisibilityVisible));
    archive.top().addChildInstance(source, "copy");
    return path;
}

std::string with(std::string text, const std::string& what, const std::string& by)
{
    const size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, by.size(), by);
}

} // namespace

TEST_F(MeshFiles, AnAlembicFileThatIsCutShortIsRefused)
{
    all_of_it(folder / "whole.abc");
    const std::string whole = folder.bytes("whole.abc");
    ASSERT_EQ(read(folder / "whole.abc").triangles.size(), 4u);
    ASSERT_LT(whole.size(), 20000u);
    for (size_t size = 0; size < whole.size(); size += 1 + whole.size() / 150)
        EXPECT_NE(refusal(folder.write("cut.abc", whole.substr(0, size))), "") << size;
    EXPECT_NE(refusal(folder.write("cut.abc", whole.substr(0, whole.size() - 1))), "");
}

TEST_F(MeshFiles, AnAlembicFileWithAWrongByteIsReadOrRefused)
{
    all_of_it(folder / "whole.abc");
    const std::string whole = folder.bytes("whole.abc");
    size_t refused = 0;
    MeshParams between;
    between.frame = 1.5;
    for (size_t at = 5; at < whole.size(); at += 5) {
        std::string bytes = whole;
        bytes[at] = char(bytes[at] ^ (at % 3 == 0 ? 0x01 : at % 3 == 1 ? 0x80 : 0xff));
        Mesh mesh;
        std::string error;
        refused += !read_mesh(mesh, folder.write("flipped.abc", bytes), between, error);
        EXPECT_TRUE(!error.empty() || check_mesh(mesh, error)) << at << ": " << error;
    }
    EXPECT_GT(refused, 20u);
}

TEST_F(MeshFiles, AnAlembicMeshWithIndicesOutOfRangeIsRefused)
{
    const auto reason = [&](const Polygons& polygons) { return refusal(mesh_file(folder / "a.abc", { polygons })); };
    Polygons polygons = quad();
    polygons.corners[1] = 4;
    EXPECT_EQ(reason(polygons), "\"/leaf\": a face uses vertex 4, but there are only 4");
    polygons.corners[1] = -1;
    EXPECT_EQ(reason(polygons), "\"/leaf\": a face uses vertex -1, but there are only 4");
    polygons = quad();
    polygons.counts = { 5 };
    EXPECT_EQ(reason(polygons), "\"/leaf\": face 0 has 5 corners, but 4 are left");
    polygons.counts = { 3, -2, 3 };
    EXPECT_EQ(reason(polygons), "\"/leaf\": face 1 has -2 corners, but 1 are left");
    polygons.counts = { 3 };
    EXPECT_EQ(reason(polygons), "\"/leaf\": its faces have 3 corners, but there are 4");
    polygons = quad();
    const std::vector<V2f> uvs(3, V2f(0));
    const std::vector<uint32_t> indices { 0, 1, 2, 3 };
    polygons.uvs = { Abc::V2fArraySample(uvs), Abc::UInt32ArraySample(indices), Abc::kFacevaryingScope };
    EXPECT_EQ(reason(polygons), "\"/leaf\": \"uv\" uses value 3, but there are only 3");
    polygons = quad();
    polygons.points[2].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(reason(polygons), HasSubstr("of \"leaf\" is not finite"));
    {
        Archive archive(folder / "a.abc");
        const std::vector<int32_t> faces { 1 };
        Archive::add_mesh(archive.top(), "leaf", { quad() })
            .getSchema()
            .createFaceSet("wood")
            .getSchema()
            .set({ Abc::Int32ArraySample(faces) });
    }
    EXPECT_EQ(refusal(folder / "a.abc"), "\"/leaf\": face set \"wood\" has face 1, but there are only 1");
}

TEST_F(MeshFiles, AlembicValuesForOtherFacesAreNotReadAndSaidToBe)
{
    Polygons polygons = quad();
    const std::vector<V2f> uvs(3, V2f(0));
    const std::vector<V3f> normals(2, V3f(1, 0, 0));
    polygons.uvs = { Abc::V2fArraySample(uvs), Abc::UInt32ArraySample(), Abc::kFacevaryingScope };
    polygons.normals = { Abc::N3fArraySample(normals), Abc::kVertexScope };
    const Mesh mesh = read(mesh_file(folder / "a.abc", { polygons }));
    EXPECT_TRUE(mesh.uvs.empty());
    EXPECT_EQ(mesh.normals_from, "smooth");
    const std::string but = ", but there are 4 corners, 4 vertices and 1 faces: it is not read";
    EXPECT_THAT(mesh.warnings,
                testing::ElementsAre("\"/leaf\": \"uv\" has 3 values" + but, "\"/leaf\": \"N\" has 2 values" + but));
}

TEST_F(MeshFiles, AnAlembicInstanceOfItselfOrOfNothingIsRefused)
{
    all_of_it(folder / "whole.abc");
    const std::string whole = folder.bytes("whole.abc"), source("/source\0", 8);
    const auto reason = [&](const std::string& by) { return refusal(folder.write("a.abc", with(whole, source, by))); };
    EXPECT_EQ(reason("/sourcE"), "\"/copy\" is an instance of \"/sourcE\", which does not exist");
    EXPECT_EQ(reason("///////"), "\"/copy\" is an instance of \"///////\", which does not exist");
    EXPECT_EQ(reason(std::string("/copy\0\0", 7)), "node \"/copy\" is its own ancestor");
    // Several texts where there should be one: the library has room for one.
    EXPECT_EQ(reason(std::string(7, '\0')), "\"/copy\" is an instance of \"\", which does not exist");
    {
        Archive archive(folder / "a.abc");
        Abc::OXform other = Archive::add_xform(archive.top(), "other", { {} });
        Abc::OXform outer = Archive::add_xform(archive.top(), "outer", { {} });
        Archive::add_mesh(outer, "leaf", { quad() });
        outer.addChildInstance(other, "inner");
    }
    EXPECT_EQ(refusal(folder.write("b.abc", with(folder.bytes("a.abc"), std::string("/other\0", 7), "/outer"))),
              "node \"/outer\" is its own ancestor");
}

TEST_F(MeshFiles, AlembicInstancesThatExpandBeyondAllMemoryAreRefused)
{
    const auto write = [&](int levels) {
        Archive archive(folder / "a.abc");
        Abc::OXform last = Archive::add_xform(archive.top(), "x0", { {} });
        Archive::add_mesh(last, "leaf", { quad() });
        for (int i = 1; i <= levels; ++i) { // each twice in the next
            Abc::OXform next = Archive::add_xform(archive.top(), "x" + std::to_string(i), { {} });
            next.addChildInstance(last, "a");
            next.addChildInstance(last, "b");
            last = next;
        }
    };
    write(4);
    EXPECT_EQ(read(folder / "a.abc").triangles.size(), 2u * (1 + 2 + 4 + 8 + 16));
    write(40);
    EXPECT_EQ(refusal(folder / "a.abc"), "node instances expand to more than 1000000 nodes");
}

TEST_F(MeshFiles, AnAlembicFileWithoutMeshesIsRefused)
{
    const std::string path = folder / "a.abc";
    {
        Archive archive(path);
        Abc::OCurves curves(archive.top(), "hair");
        Abc::OPoints points(archive.top(), "dust");
        Archive::add_xform(archive.top(), "empty", { {} });
    }
    EXPECT_EQ(refusal(path), "no triangles");
    EXPECT_EQ(refusal(mesh_file(path, {})), "\"/leaf\": has no \"P\"");
}
