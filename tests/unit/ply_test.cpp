// SPDX-License-Identifier: Apache-2.0
// PLY files as their writers mean them: texture coordinates of vertices and of face corners, strips, textures.
#include "mesh_fixture.h"

#include <vmlight/base/format.h>

#include <OpenImageIO/strutil.h>

#include <array>
#include <cmath>

using namespace mesh_files;
using OIIO::Strutil::replace;

namespace {

// A number, in the encoding of the file.
struct Number
{
    char type; // 'b'yte, 'i'nt, 'f'loat
    double value;
};

// The body of a PLY: rows of numbers.
std::string body(const std::string& format_name, const std::vector<std::vector<Number>>& rows)
{
    std::string bytes;
    const auto put = [&](auto number) {
        char raw[sizeof(number)];
        std::memcpy(raw, &number, sizeof(number));
        if (format_name == "binary_big_endian")
            std::reverse(raw, raw + sizeof(number));
        bytes.append(raw, sizeof(number));
    };
    for (const auto& row : rows) {
        for (const Number& number : row) {
            if (format_name == "ascii")
                bytes += format("{} ", number.value);
            else if (number.type == 'b')
                put(uint8_t(number.value));
            else if (number.type == 'i')
                put(int32_t(number.value));
            else
                put(float(number.value));
        }
        bytes += format_name == "ascii" ? "\n" : "";
    }
    return bytes;
}

// Two squares that share an edge, in z = 0: (0,0) to (2,1). Their texture coordinates are those of MeshLab: of corners.
std::string wedges(const std::string& format_name, const std::string& face_properties, bool has_number = false,
                   size_t uv_count = 8)
{
    std::vector<std::vector<Number>> rows;
    for (const auto& [x, y] : { std::pair(0, 0), { 1, 0 }, { 2, 0 }, { 0, 1 }, { 1, 1 }, { 2, 1 } })
        rows.push_back({ { 'f', double(x) }, { 'f', double(y) }, { 'f', 0 } });
    for (const double first : { 0.0, 1.0 }) {
        std::vector<Number> row {
            { 'b', 4 }, { 'i', first }, { 'i', first + 1 }, { 'i', first + 4 }, { 'i', first + 3 }
        };
        row.push_back({ 'b', double(first > 0 ? uv_count : 8) });
        const std::array<double, 8> uvs { 0, 0, 0.5, 0, 0.5, 0.5, 0, 0.5 };
        for (size_t i = 0; i < (first > 0 ? uv_count : 8); ++i) // the second square's are 1/4 and 1/8 further
            row.push_back({ 'f', uvs[i % 8] + first * (i % 2 == 0 ? 0.25 : 0.125) });
        if (has_number)
            row.push_back({ 'i', first });
        rows.push_back(row);
    }
    return "ply\nformat " + format_name
        + " 1.0\ncomment VCGLIB generated\ncomment TextureFile a b.png\ncomment TextureFile c.png\nelement vertex 6\n"
          "property float x\nproperty float y\nproperty float z\nelement face 2\n"
          "property list uchar int vertex_indices\n"
        + face_properties + "end_header\n" + body(format_name, rows);
}

const std::string kTexcoord = "property list uchar float texcoord\n";

std::string quad_text(const std::string& names, const std::string& faces)
{
    return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n" + names
        + faces;
}
const std::string kRows = "0 0 0 0 0\n2 0 0 1 0\n2 3 0 1 1\n0 3 0 0 1\n";
const std::string kFace = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

} // namespace

class PlyFiles : public MeshFiles
{ };

TEST_F(PlyFiles, CornersHaveTextureCoordinates)
{
    std::string hash;
    for (const char* name : { "ascii", "binary_little_endian", "binary_big_endian" }) {
        const Mesh mesh = read("a.ply", wedges(name, kTexcoord));
        ASSERT_EQ(mesh.triangles.size(), 4u) << name;
        EXPECT_EQ(mesh.positions.size(), 8u) << "the two vertices between the squares are split";
        for (size_t t = 0; t < 4; ++t)
            for (const uint32_t vertex : mesh.triangles[t]) {
                const V3d p = mesh.positions[vertex] - V3d(t / 2, 0, 0);
                EXPECT_EQ(mesh.uvs[vertex],
                          V2f(float(p.x / 2 + (t < 2 ? 0 : 0.25)), float(p.y / 2 + (t < 2 ? 0 : 0.125))));
                EXPECT_EQ(mesh.normals[vertex], V3f(0, 0, 1));
            }
        EXPECT_TRUE(hash.empty() || hash == mesh_hash(mesh)) << "the same in each encoding";
        hash = mesh_hash(mesh);
    }
    MeshParams params;
    params.uv_set = 1;
    EXPECT_TRUE(read(folder / "a.ply", params).uvs.empty());
}

TEST_F(PlyFiles, NormalsGoAcrossTheSeamsOfTexture)
{
    // Two squares that meet at an angle, and in a seam: smooth, but for a sharp edge.
    for (const bool is_sharp : { false, true }) {
        std::string text = wedges("ascii", kTexcoord);
        const char* z = is_sharp ? "-1" : "-0.3"; // a right angle, or 17 degrees
        text = replace(replace(text, "\n2 0 0 \n", format("\n1 0 {} \n", z)), "\n2 1 0 \n", format("\n1 1 {} \n", z));
        if (!is_sharp)
            text = replace(replace(text, "\n1 0 -0.3 \n", "\n2 0 -0.3 \n"), "\n1 1 -0.3 \n", "\n2 1 -0.3 \n");
        const Mesh mesh = read("a.ply", text);
        int shared = 0;
        for (size_t v = 0; v < mesh.positions.size(); ++v)
            for (size_t w = 0; w < v; ++w)
                if (mesh.positions[w] == mesh.positions[v]) {
                    ++shared;
                    EXPECT_EQ(mesh.normals[w] == mesh.normals[v], !is_sharp);
                }
        EXPECT_GE(shared, 2) << "split where the UVs part";
        EXPECT_EQ(mesh.normals_from, "smooth but for sharp UV seams");
    }
}

TEST_F(PlyFiles, ATextureIsAMaterial)
{
    folder.write("a b.png", "");
    const Mesh mesh = read("a.ply", wedges("binary_little_endian", kTexcoord + "property int texnumber\n", true));
    EXPECT_EQ(mesh.triangle_materials, (std::vector<uint32_t> { 0, 0, 1, 1 }));
    ASSERT_EQ(mesh.materials.size(), 2u);
    EXPECT_EQ(mesh.materials[0].name, "a b.png");
    EXPECT_EQ(mesh.materials[0].base_color_texture.path, folder / "a b.png");
    EXPECT_EQ(mesh.materials[1].base_color_texture.path, folder / "c.png");
    EXPECT_EQ(read("b.ply", wedges("ascii", kTexcoord)).triangle_materials, (std::vector<uint32_t>(4, 0)));
}

TEST_F(PlyFiles, TextureCoordinatesAreForAllCornersOfAFace)
{
    for (const char* name : { "ascii", "binary_little_endian", "binary_big_endian" }) {
        for (const size_t count : { 2, 6, 7, 10 })
            EXPECT_EQ(refusal(folder.write("a.ply", wedges(name, kTexcoord, false, count))),
                      format("PLY face 1 has {} numbers as texture coordinates, but its 4 corners need 8", count));
        const Mesh mesh = read("a.ply", wedges(name, kTexcoord, false, 0));
        EXPECT_FALSE(std::isnan(mesh.uvs[mesh.triangles[0][0]].x));
        EXPECT_TRUE(std::isnan(mesh.uvs[mesh.triangles[2][0]].x)) << "a face may have none";
    }
}

TEST_F(PlyFiles, TextureCoordinatesOfVerticesHaveManyNames)
{
    const std::string hash
        = mesh_hash(read("a.ply", quad_text("property float s\nproperty float t\n", kFace + kRows + "4 0 1 2 3\n")));
    for (const auto& [u, v] :
         { std::pair("u", "v"), { "texture_u", "texture_v" }, { "tx", "ty" }, { "texture_s", "texture_t" } }) {
        const std::string names = format("property float {}\nproperty float {}\n", u, v);
        EXPECT_EQ(mesh_hash(read("b.ply", quad_text(names, kFace + kRows + "4 0 1 2 3\n"))), hash) << u;
    }
    const Mesh swapped
        = read("b.ply", quad_text("property float t\nproperty float s\n", kFace + kRows + "4 0 1 2 3\n"));
    EXPECT_EQ(swapped.uvs[1], V2f(0, 1)) << "by name, not by place";
    EXPECT_TRUE(
        read("b.ply", quad_text("property float a\nproperty float b\n", kFace + kRows + "4 0 1 2 3\n")).uvs.empty());
    // Those of corners go before those of vertices; a face without any has the vertices'.
    const std::string both = replace(kFace, "end_header", kTexcoord + "end_header");
    const Mesh mesh
        = read("b.ply",
               quad_text("property float s\nproperty float t\n",
                         replace(both, "face 1", "face 2") + kRows + "3 0 1 2 6 .5 .5 .25 .5 .5 .75\n3 0 2 3 0\n"));
    EXPECT_EQ(mesh.uvs[mesh.triangles[0][1]], V2f(0.25f, 0.5f));
    EXPECT_EQ(mesh.uvs[mesh.triangles[1][1]], V2f(1, 1));
}

TEST_F(PlyFiles, NormalsOfVerticesAreKept)
{
    const std::string names = "property float nx\nproperty float ny\nproperty float nz\n";
    const Mesh mesh
        = read("a.ply", quad_text(names, kFace + "0 0 0 2 0 0\n1 0 0 0 .5 0\n1 1 0 0 0 0\n0 1 0 nan 0 1\n4 0 1 2 3\n"));
    EXPECT_EQ(mesh.normals[0], V3f(1, 0, 0));
    EXPECT_EQ(mesh.normals[1], V3f(0, 1, 0));
    EXPECT_EQ(mesh.normals[2], V3f(0, 0, 1)) << "made";
    EXPECT_EQ(mesh.normals[3], V3f(0, 0, 1)) << "made";
}

TEST_F(PlyFiles, StripsAreAllTheirTriangles)
{
    const std::string header
        = "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
          "property float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n"
          "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n";
    for (const char* strip : { "6 0 1 2 3 4 5", "9 0 1 2 3 -1 2 3 4 5", "15 0 1 2 -1 2 1 3 -1 2 3 4 -1 4 3 5",
                               "12 -1 0 1 2 3 -1 5 -1 2 3 4 5", "7 0 1 2 3 4 5 -1" }) {
        const Mesh mesh = read("a.ply", header + strip + "\n");
        EXPECT_EQ(mesh.triangles.size(), 4u) << strip;
        EXPECT_EQ(area_vector(mesh), V3d(0, 0, 2)) << strip;
    }
    EXPECT_EQ(refusal(folder.write("a.ply", header + "3 0 1 6\n")),
              "PLY tristrips 0 uses vertex 6, but there are only 6");
    EXPECT_EQ(refusal(folder.write("a.ply", header + "3 0 1 -2\n")),
              "PLY tristrips 0 uses vertex -2, but there are only 6");
}

TEST_F(PlyFiles, PolygonsAreCut)
{
    std::string text
        = "ply\nformat ascii 1.0\nelement vertex 6\nproperty double x\nproperty short y\nproperty uchar z\n"
          "element face 1\nproperty list uint uint vertex_index\nend_header\n"
          "0 0 0\n4 0 0\n4 1 0\n1 1 0\n1 4 0\n0 4 0\n6 0 1 2 3 4 5\n";
    const Mesh mesh = read("a.ply", text);
    EXPECT_EQ(mesh.triangles.size(), 4u);
    EXPECT_EQ(area_vector(mesh), V3d(0, 0, 7));
    EXPECT_EQ(mesh_hash(read("b.ply", replace(text, "\n", "\r\n", true))), mesh_hash(mesh));
}

TEST_F(PlyFiles, InvalidFilesAreRefused)
{
    const std::string text = quad_text("property float s\nproperty float t\n", kFace + kRows + "4 0 1 2 3\n");
    const auto said = [&](const char* what, const char* instead) {
        return refusal(folder.write("a.ply", replace(text, what, instead)));
    };
    EXPECT_EQ(said("2 3 0 1 1", "2 x 0 1 1"), "PLY vertex 2 has something other than a number as y");
    EXPECT_EQ(said("2 3 0 1 1", "2 3 0 1"), "PLY ends inside vertex 2 of 4");
    EXPECT_EQ(said("format ascii", "format binary"), "invalid PLY header: format \"binary\"");
    EXPECT_EQ(said("format ascii 1.0\n", ""), "invalid PLY header: format \"\"");
    EXPECT_EQ(said("property float x", "property float a"), "PLY vertices have no x and y");
    EXPECT_EQ(said("element face", "element vertex 0\nproperty float x\nproperty float y\nelement face"),
              "invalid PLY header: more than one element \"vertex\"");
    EXPECT_EQ(said("vertex_indices", "corners"), "no triangles");
}
