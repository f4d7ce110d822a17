// SPDX-License-Identifier: Apache-2.0
// Smoothing groups, objects, groups and materials of OBJ files.
#include "mesh_fixture.h"

#include <OpenImageIO/strutil.h>

using namespace mesh_files;

namespace {

class ObjGroups : public MeshFiles
{
protected:
    // Of the corner of triangle `t` that is at `p`.
    static V3f normal_at(const Mesh& mesh, size_t t, const V3d& p)
    {
        for (const uint32_t vertex : mesh.triangles.at(t))
            if (mesh.positions[vertex] == p)
                return mesh.normals[vertex];
        ADD_FAILURE() << "no such corner";
        return V3f(0);
    }
    static std::vector<std::string> node_names(const Mesh& mesh)
    {
        std::vector<std::string> names;
        for (const uint32_t node : mesh.triangle_nodes) {
            std::string name = mesh.nodes[node].name;
            for (int parent = mesh.nodes[node].parent; parent >= 0; parent = mesh.nodes[size_t(parent)].parent)
                name = mesh.nodes[size_t(parent)].name + "/" + name;
            names.push_back(name);
        }
        return names;
    }
    static std::vector<std::string> material_names(const Mesh& mesh)
    {
        std::vector<std::string> names;
        for (const uint32_t material : mesh.triangle_materials)
            names.push_back(mesh.materials.at(material).name);
        return names;
    }
};

// A roof of three sides that meet at a right angle in (0,0,1), without normals: they face -x, -y, +z.
const std::string kPeak = "v 0 0 1\nv 0 0 0\nv 0 1 1\nv 1 0 1\n";
const char* const kSides[] = { "f 1 3 2\n", "f 1 2 4\n", "f 1 4 3\n" };
const V3f kFlat[] = { V3f(-1, 0, 0), V3f(0, -1, 0), V3f(0, 0, 1) };
const V3d kTop(0, 0, 1);

std::string peak(const char* first, const char* second, const char* third)
{
    return kPeak + first + kSides[0] + second + kSides[1] + third + kSides[2];
}

} // namespace

TEST_F(ObjGroups, WithoutAnySAllIsSmooth)
{
    const Mesh mesh = read("a.obj", peak("", "", ""));
    for (size_t t = 0; t < 3; ++t)
        EXPECT_LT((normal_at(mesh, t, kTop) - V3f(-1, -1, 1).normalized()).length(), 1e-6f);
    EXPECT_EQ(mesh.normals_from, "smooth");
}

TEST_F(ObjGroups, OffIsFlat)
{
    for (const char* off : { "s off\n", "s 0\n", "s\n", "s off # none\n", "s\t0\n", "s null\n" }) {
        const Mesh mesh = read("a.obj", peak(off, "", ""));
        for (size_t t = 0; t < 3; ++t)
            EXPECT_EQ(normal_at(mesh, t, kTop), kFlat[t]) << off;
        EXPECT_EQ(mesh.normals_from, "flat") << off;
    }
}

TEST_F(ObjGroups, GroupsAreSmoothWithin)
{
    for (const char* one : { "s 1\n", "s 7\n", "s 4294967295\n", "s -1\n", "s on\n" }) {
        const Mesh mesh = read("a.obj", peak(one, "", "s 2\n"));
        for (size_t t = 0; t < 2; ++t)
            EXPECT_LT((normal_at(mesh, t, kTop) - V3f(-1, -1, 0).normalized()).length(), 1e-6f) << one;
        EXPECT_EQ(normal_at(mesh, 2, kTop), kFlat[2]);
        EXPECT_EQ(mesh.normals_from, "smooth within smoothing groups");
    }
    // A group goes on where its number comes back.
    const Mesh mesh = read("a.obj", peak("s 1\n", "s 2\n", "s 1\n"));
    EXPECT_EQ(normal_at(mesh, 1, kTop), kFlat[1]);
    for (const size_t t : { 0, 2 })
        EXPECT_LT((normal_at(mesh, t, kTop) - V3f(-1, 0, 1).normalized()).length(), 1e-6f);
}

TEST_F(ObjGroups, BeforeTheFirstSAllIsFlat)
{
    const Mesh mesh = read("a.obj", peak("", "s 1\n", ""));
    EXPECT_EQ(normal_at(mesh, 0, kTop), kFlat[0]);
    for (const size_t t : { 1, 2 })
        EXPECT_LT((normal_at(mesh, t, kTop) - V3f(0, -1, 1).normalized()).length(), 1e-6f);
    EXPECT_EQ(mesh.normals_from, "flat for 1 of 3 triangles, smooth within smoothing groups for 2 of 3 triangles");
}

TEST_F(ObjGroups, GroupsJoinAcrossGAndMaterialsButNotAcrossObjects)
{
    for (const char* between : { "g second\n", "usemtl other\n", "g a b\ns 1\n" })
        EXPECT_LT((normal_at(read("a.obj", peak("s 1\n", between, "s off\n")), 0, kTop) - V3f(-1, -1, 0).normalized())
                      .length(),
                  1e-6f)
            << between;
    EXPECT_EQ(normal_at(read("a.obj", peak("o one\ns 1\n", "o two\n", "s off\n")), 0, kTop), kFlat[0]);
    // Files of 3ds Max have no `o`: each object is its vertices, then `g` and its faces.
    const std::string again = OIIO::Strutil::replace(kSides[1], "f 1 2 4", "f -4 -3 -1");
    const Mesh mesh = read("a.obj", kPeak + "g one\ns 1\n" + kSides[0] + kPeak + "g two\ns 1\n" + again);
    EXPECT_EQ(normal_at(mesh, 0, kTop), kFlat[0]);
    EXPECT_EQ(normal_at(mesh, 1, kTop), kFlat[1]);
}

TEST_F(ObjGroups, TheFilesNormalsAndFlagsGoFirst)
{
    std::string text = "vn 1 0 0\n" + peak("s off\n", "", "");
    text = OIIO::Strutil::replace(text, "f 1 3 2", "f 1//1 3//1 2//1");
    const Mesh mesh = read("a.obj", text);
    EXPECT_EQ(normal_at(mesh, 0, kTop), V3f(1, 0, 0));
    EXPECT_EQ(normal_at(mesh, 1, kTop), kFlat[1]);
    EXPECT_EQ(mesh.normals_from, "flat for 2 of 3 triangles, else from the file");
    MeshParams params;
    params.normals = "smooth";
    EXPECT_LT((normal_at(read(folder / "a.obj", params), 0, kTop) - V3f(-1, -1, 1).normalized()).length(), 1e-6f);
}

TEST_F(ObjGroups, ObjectsAndGroupsAreNodes)
{
    using Names = std::vector<std::string>;
    EXPECT_EQ(node_names(read("a.obj", peak("", "", ""))), (Names { "", "", "" }));
    EXPECT_EQ(node_names(read("a.obj", peak("o the box # one\n", "o b\n", "o the box\n"))),
              (Names { "the box", "b", "the box" }));
    EXPECT_EQ(node_names(read("a.obj", peak("g a\n", "g a b\n", "g\n"))), (Names { "a", "a/b", "" }));
    EXPECT_EQ(node_names(read("a.obj", peak("o x\ng a\n", "g b\n", "o y\n"))), (Names { "x/a", "x/b", "y" }));
    EXPECT_EQ(node_names(read("a.obj", peak("g a\no x\n", "g b\no y\n", ""))), (Names { "x/a", "y/b", "y/b" }));
    const Mesh mesh = read("a.obj", peak("o empty\no x\ng a\n", "o x\ng a\n", ""));
    EXPECT_EQ(mesh.nodes.size(), 2u) << "one of each name, and only those that have faces";
}

TEST_F(ObjGroups, MaterialsAreNamedByTheirFaces)
{
    using Names = std::vector<std::string>;
    EXPECT_EQ(material_names(read("a.obj", peak("", "usemtl a b\n", "usemtl Material #25\n"))),
              (Names { "", "a b", "Material #25" }));
    EXPECT_EQ(material_names(read("a.obj", peak("usemtl a \r\n", "usemtl b # c\n", "usemtl a\n"))),
              (Names { "a", "b", "a" }));
    folder.write("my lib.mtl", "newmtl unused\nnewmtl a\nKd .1 .2 .3\nnewmtl c\n");
    folder.write("two.mtl", "newmtl d\nd .5\n");
    const Mesh mesh
        = read("a.obj", "mtllib my lib.mtl\nmtllib two.mtl\n" + peak("usemtl a\n", "usemtl d\n", "usemtl e\n"));
    EXPECT_EQ(material_names(mesh), (Names { "a", "d", "e" }));
    EXPECT_EQ(mesh.materials.size(), 5u);
    EXPECT_EQ(mesh.materials[0].name, "unused") << "in the file's order";
    EXPECT_EQ(mesh.materials[mesh.triangle_materials[0]].base_color, Imath::C4f(0.1f, 0.2f, 0.3f, 1));
    EXPECT_EQ(mesh.materials[mesh.triangle_materials[1]].alpha_mode, AlphaMode::blend);
    EXPECT_TRUE(mesh.warnings.empty());
    EXPECT_EQ(material_names(read("a.obj", "mtllib two.mtl\n" + peak("usemtl d #comment\n", "", "")))[0], "d");
}

TEST_F(ObjGroups, AMissingMaterialFileIsWarnedOf)
{
    folder.write("two.mtl", "newmtl d\nd .5\n");
    const Mesh mesh = read("a.obj", "mtllib none.mtl two.mtl\n" + peak("usemtl d\n", "", ""));
    EXPECT_EQ(mesh.warnings, std::vector<std::string> { "no material file \"none.mtl\", which line 1 names" });
    EXPECT_EQ(mesh.materials.at(0).base_color.a, 0.5f);
    std::vector<std::string> opened;
    Mesh again;
    std::string error;
    ASSERT_TRUE(read_mesh(again, folder.write("b.obj", "mtllib C:\\work\\two.mtl\n" + peak("usemtl d\n", "", "")), {},
                          error, [&](const std::string& path) { opened.push_back(path); }))
        << error;
    EXPECT_EQ(opened, (std::vector<std::string> { folder / "b.obj", folder / "two.mtl" }));
    EXPECT_EQ(again.materials.at(0).base_color.a, 0.5f) << "found beside the mesh";
}

TEST_F(ObjGroups, BumpMapsOfMaterialsInUseAreWarnedOf)
{
    folder.write("two.mtl", "newmtl a\nmap_Bump h.png\nnewmtl b\nbump h.png\nnewmtl c\ndisp h.png\nnewmtl d\nd .5\n");
    const auto warnings = [&](const char* first, const char* second) {
        return read("a.obj", "mtllib two.mtl\n" + peak(first, second, "")).warnings;
    };
    EXPECT_EQ(warnings("usemtl d\n", ""), std::vector<std::string> {});
    EXPECT_EQ(
        warnings("usemtl d\n", "usemtl b\n"),
        std::vector<std::string> { "1 material (\"b\") has a bump or displacement map, which is not read: bake it "
                                   "to a normal map" });
    EXPECT_EQ(warnings("usemtl c\n", "usemtl b\n"),
              std::vector<std::string> { "2 materials (\"b\", ...) have a bump or displacement map, which is not read: "
                                         "bake it to a normal map" });
}
