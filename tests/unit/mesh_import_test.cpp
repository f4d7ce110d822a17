// SPDX-License-Identifier: Apache-2.0
// The seam of mesh formats: detection, the table, and a format of the test's own that no library reads.
#include "gltf_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>
#include <vmlight/mesh/import/importer.h>

#include <map>

using namespace mesh_files;

namespace {

const char* const kPly = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                         "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                         "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const char* const kTextStl = "solid leaf\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
                             "endloop\nendfacet\nendsolid leaf\n";
const char* const kCollada
    = R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 1 0</float_array>
<technique_common><accessor source="#pa" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry>
</library_geometries><library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
const char* const kFbx = R"(; FBX 7.4.0 project file
FBXHeaderExtension: {
FBXVersion: 7400
}
Objects: {
Model: 1, "Model::A", "Mesh" {
Version: 232
}
Geometry: 2, "Geometry::", "Mesh" {
Vertices: *9 { a: 0,0,0,1,0,0,0,1,0 }
PolygonVertexIndex: *3 { a: 0,1,-3 }
}
}
Connections: {
C: "OO", 1, 0
C: "OO", 2, 1
}
)";

std::string binary_stl()
{
    return std::string("v is no keyword in a binary file").append(48, '\0') + bytes_of<uint32_t>({ 1 })
        + bytes_of<float>({ 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0 }) + std::string(2, '\0');
}

// gltf() with its numbers in a chunk of their own.
std::string glb(std::string json)
{
    const size_t uri = json.find(",\"uri\"");
    json.erase(uri, json.find("}]}", uri) - uri);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::string numbers
        = bytes_of<float>({ 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 0.25f });
    const uint32_t length = uint32_t(json.size()), size = uint32_t(numbers.size());
    return "glTF" + bytes_of<uint32_t>({ 2, 28 + length + size, length }) + "JSON" + json + bytes_of<uint32_t>({ size })
        + std::string("BIN\0", 4) + numbers;
}

std::string utf16(const std::string& text)
{
    std::string wide = "\xff\xfe";
    for (const char c : text)
        wide += { c, '\0' };
    return wide;
}

// One triangle (0,0,0) (1,0,0) (0,1,0) in each format, in each form whose content tells the format.
std::multimap<std::string, std::string> samples()
{
    return { { "OBJ", "# was hero.fbx\r\n\r\nv 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n" },
             { "OBJ", "\xef\xbb\xbf o leaf\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n" },
             { "PLY", kPly },
             { "STL", kTextStl },
             { "STL", binary_stl() },
             { "glTF 2.0", gltf(R"({"mesh":0})") },
             { "glTF 2.0", glb(gltf(R"({"mesh":0})")) },
             { "Collada", kCollada },
             { "FBX", kFbx } };
}

const MeshFormat* format_of(const std::string& path, const std::string& bytes)
{
    return find_mesh_format(mesh_formats(), path, { bytes.substr(0, FileHead::kBytes), bytes.size() });
}

// A format of this test: "tri!" and nine floats, by a reader that has nothing to do with assimp.
bool has_tri_content(const FileHead& head)
{
    return OIIO::Strutil::starts_with(head.bytes, "tri!");
}

Inspection inspect_tri(const std::string& bytes)
{
    Inspection result;
    result.error = bytes.size() == 40 ? "" : "not 40 bytes";
    return result;
}

bool read_tri(MeshBuilder& dst, const ImportRequest& request, std::string& error)
{
    EXPECT_TRUE(request.inspection.error.empty());
    EXPECT_EQ(request.format.name, std::string("Tri"));
    if (request.before_open)
        request.before_open(request.path);
    float numbers[10];
    if (OIIO::Filesystem::read_bytes(request.path, numbers, sizeof(numbers)) != sizeof(numbers) || numbers[9] < 0) {
        error = "the tri library says no";
        return false;
    }
    const Imath::M44d up = dst.root_transform(true);
    for (const double scale : { 1.0, -2.0 }) {
        dst.begin_part("leaf", Imath::M44d().setScale(scale) * up, dst.add_node("leaf", -1));
        for (int corner = 0; corner < 3; ++corner) {
            const float* at = numbers + 1 + 3 * corner;
            dst.add_vertex(V3d(at[0], at[1], at[2]), V3d(0), nullptr);
        }
        dst.add_triangle({ 0, 1, uint32_t(numbers[9] > 1 ? 7 : 2) }, scale < 0);
    }
    return true;
}

std::vector<MeshFormat> formats_and_tri()
{
    std::vector<MeshFormat> formats = mesh_formats();
    formats.push_back({ "Tri", "tri3 tri", has_tri_content, inspect_tri, read_tri });
    return formats;
}

std::string tri(float last = 0)
{
    return "tri!" + bytes_of<float>({ 0, 0, 0, 1, 0, 0, 0, 1, last });
}

} // namespace

TEST_F(MeshFiles, EachFormatIsReadWhateverTheFileIsCalled)
{
    const auto all = samples();
    for (const MeshFormat& format : mesh_formats()) {
        if (std::string(format.name) == "Alembic") // its files are written by its library: alembic_test.cpp
            continue;
        if (format.has_heights) // more than a triangle: height_field_test.cpp, scene_list_test.cpp
            continue;
        ASSERT_GT(all.count(format.name), 0u) << "add a sample of " << format.name;
        const std::string usual = OIIO::Strutil::splits(format.extensions).front();
        for (auto [sample, end] = all.equal_range(format.name); sample != end; ++sample)
            for (const std::string& name : { "a." + usual, "a." + OIIO::Strutil::upper(usual), std::string("noname"),
                                             std::string("a.b"), std::string("a.obj"), std::string("a.gltf") }) {
                SCOPED_TRACE(std::string(format.name) + " in " + name);
                EXPECT_EQ(format_of(name, sample->second), &format);
                const Mesh mesh = read(name.c_str(), sample->second);
                EXPECT_EQ(mesh.triangles.size(), 1u);
                EXPECT_LT((area_vector(mesh) - V3d(0, 0, 0.5)).length(), 1e-6);
            }
    }
}

TEST_F(MeshFiles, TheExtensionCountsWhereContentCannotTell)
{
    for (const MeshFormat& format : mesh_formats())
        for (const std::string& extension : OIIO::Strutil::splits(format.extensions)) {
            EXPECT_EQ(format_of("a.b." + extension, "noise"), &format);
            EXPECT_EQ(format_of("a." + OIIO::Strutil::upper(extension), ""), &format);
            EXPECT_EQ(format_of("a" + extension, "noise"), nullptr);
        }
    EXPECT_EQ(format_of("a", "obj"), nullptr);
    EXPECT_EQ(format_of("a.txt", "various things"), nullptr);
    EXPECT_EQ(format_of("a.png", "\x89PNG\r\n\x1a\n\nv 1 2 3\n")->name, std::string("height image"));
    EXPECT_EQ(format_of("a", "{\"scene\":0}"), nullptr);
    EXPECT_EQ(format_of("a", utf16(kCollada))->name, std::string("Collada"));
    EXPECT_EQ(format_of("a.obj", std::string(5000, '#') + "\nv 0 0 0\n")->name, std::string("OBJ"));
}

TEST_F(MeshFiles, AnInspectedFormatIsReadAsWhatItWasInspectedAs)
{
    const std::string bad = OIIO::Strutil::replace(kPly, "3 0 1 2", "3 0 1 3");
    for (const char* name : { "a.ply", "a.obj", "noname" })
        EXPECT_EQ(refusal(folder.write(name, bad)), "PLY face 0 uses vertex 3, but there are only 3");
    EXPECT_EQ(refusal(folder.write("noname", "v 0 0 0\nvt nan 0\n")),
              "line 2 has non-finite texture coordinates: \"vt nan 0\"");
}

TEST_F(MeshFiles, AFormatOfItsOwnIsATableEntry)
{
    Mesh mesh;
    std::string error, opened;
    const std::string path = folder.write("a.obj", tri()); // content beats the extension
    const auto before_open = [&](const std::string& file) { opened += file; };
    ASSERT_TRUE(import_mesh(mesh, path, {}, error, before_open, formats_and_tri())) << error;
    EXPECT_EQ(opened, path);
    EXPECT_EQ(mesh.name, "a.obj");
    EXPECT_EQ(mesh.triangle_materials, (std::vector<uint32_t> { 0, 1 }));
    EXPECT_EQ(mesh.positions[1], V3d(1, 0, 0));
    EXPECT_EQ(mesh.positions[2], V3d(0, 0, -1)); // its y, since it is z-up
    EXPECT_LT((area_vector(mesh) - V3d(0, 0.5 - 2, 0)).length(), 1e-9) << "a mirrored part keeps the outside out";
    for (const V3f& n : mesh.normals)
        EXPECT_NEAR(std::abs(n.y), 1, 1e-6);
    EXPECT_FALSE(mesh.has_exact_positions);
    EXPECT_TRUE(mesh.uvs.empty());
}

TEST_F(MeshFiles, AFormatOfItsOwnIsRefusedLikeAny)
{
    const auto reason = [&](const char* name, const std::string& bytes) {
        const std::string path = folder.write(name, bytes);
        Mesh mesh;
        std::string error;
        EXPECT_FALSE(import_mesh(mesh, path, {}, error, {}, formats_and_tri()));
        EXPECT_TRUE(mesh.positions.empty());
        EXPECT_EQ(error.find("\"" + path + "\": "), 0u) << error;
        return error.substr(std::min(error.size(), path.size() + 4));
    };
    EXPECT_EQ(reason("a.tri", tri() + "more"), "not 40 bytes");
    EXPECT_EQ(reason("a.tri", "noise"), "not 40 bytes");
    EXPECT_EQ(reason("a.tri", tri(-1)), "the tri library says no");
    EXPECT_EQ(reason("a.tri", tri(2)), "a triangle of \"leaf\" uses vertex 7, but there are only 3");
    EXPECT_EQ(reason("a.tri", tri(std::nanf(""))).find("vertex 2 of \"leaf\" is not finite"), 0u);
    EXPECT_EQ(reason("a", "noise"),
              "unknown mesh format; supported: OBJ, PLY, STL, glTF 2.0, Collada, FBX, Alembic, height image, scene "
              "list, Tri");
    EXPECT_EQ(
        refusal(folder.write("a", tri())),
        "unknown mesh format; supported: OBJ, PLY, STL, glTF 2.0, Collada, FBX, Alembic, height image, scene list");
}
