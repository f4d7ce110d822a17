// SPDX-License-Identifier: Apache-2.0
// Mesh files whose numbers or counts are not what they promise.
#include "hard_case.h"
#include "mesh_files.h"
#include "mesh_refusal.h"
#include "scenes.h"
#include "temporary_folder.h"

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/read_mesh.h>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

const char* const kPly = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                         "property float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n"
                         "0 0 0\n1 0 0\n0 1 0\n{}\n";

std::string ply(int faces, const std::string& lines)
{
    return format(kPly, faces, lines);
}

} // namespace

TEST(Geometry, PlyFacesOfVerticesThatAreNot)
{
    HardCase row("A PLY whose faces use vertices that do not exist: 3, -1, 2000000000 of 3");
    row.naive("a reader that trusts them reads past the end");
    const TemporaryFolder folder;
    EXPECT_EQ(refusal(folder, "a.ply", ply(1, "3 0 1 2")), "");
    EXPECT_EQ(refusal(folder, "a.ply", ply(1, "3 0 1 3")), "PLY face 0 uses vertex 3, but there are only 3");
    EXPECT_EQ(refusal(folder, "a.ply", ply(2, "3 0 1 2\n3 0 -1 2")), "PLY face 1 uses vertex -1, but there are only 3");
    EXPECT_EQ(refusal(folder, "a.ply", ply(1, "3 0 1 1.5")), "PLY face 0 uses vertex 1.5, but there are only 3");
    EXPECT_EQ(refusal(folder, "a.ply", ply(1, "3 0 1 2000000000")),
              "PLY face 0 uses vertex 2000000000, but there are only 3");
    for (const char* format : { "binary_little_endian", "binary_big_endian" }) {
        Mesh mesh = floor_facing_z(1);
        EXPECT_EQ(refusal(folder, "a.ply", ply_of(mesh, format)), "");
        mesh.triangles[1][2] = 77777;
        EXPECT_EQ(refusal(folder, "a.ply", ply_of(mesh, format)), "PLY face 1 uses vertex 77777, but there are only 4");
    }
    row.ours("refused, with the face and the vertex");
}

TEST(Geometry, PlyThatEndsEarly)
{
    HardCase row("A PLY with fewer faces, corners or bytes than its header promises, truncated at every byte");
    row.naive("the last face is repeated, or what follows in memory is read");
    const TemporaryFolder folder;
    EXPECT_EQ(refusal(folder, "a.ply", ply(2, "3 0 1 2")), "PLY ends before face 1 of 2");
    EXPECT_EQ(refusal(folder, "a.ply", ply(1, "255 0 1 2")), "PLY ends inside face 0 of 1");
    const std::string whole = ply_of(floor_facing_z(1), "binary_little_endian");
    const size_t body = whole.find("end_header\n") + 11;
    for (size_t bytes = body; bytes < whole.size(); bytes += 7)
        EXPECT_EQ(refusal(folder, "a.ply", whole.substr(0, bytes)).find("PLY ends inside "), 0u) << bytes;
    EXPECT_EQ(refusal(folder, "a.ply", whole.substr(0, body - 1)).find("PLY"), 0u);
    row.ours("refused, with what is missing");
}

TEST(Geometry, PlyOfMoreThanVerticesAndFaces)
{
    HardCase row("A PLY with a camera before the vertices, edges after them, and blank lines");
    row.naive("assimp 5.2 takes the camera for a vertex, or shifts the faces by the blank lines");
    const TemporaryFolder folder;
    for (const char* format : { "ascii", "binary_little_endian", "binary_big_endian" }) {
        const bool is_ascii = format == std::string("ascii");
        const std::string plain = ply_of(floor_facing_z(1), format);
        const size_t vertices = plain.find("element vertex"), faces = plain.find("element face"),
                     body = plain.find("end_header");
        const std::string header = plain.substr(0, vertices)
            + "element cam 1\nproperty list uchar uchar ids\nproperty uchar far\n"
            + plain.substr(vertices, faces - vertices) + plain.substr(faces, body - faces)
            + "element edge 1\nproperty uchar vertex1\nproperty uchar vertex2\nend_header\n";
        std::string rows = plain.substr(body + 11);
        rows = is_ascii ? "3 7 8 9 5\n" + rows + "0 1\n" : "\3\7\10\11\5" + rows + std::string("\0\1", 2);
        Mesh expected, mesh;
        std::string error;
        ASSERT_TRUE(read_mesh(expected, folder.write("plain.ply", plain), {}, error)) << error;
        ASSERT_TRUE(read_mesh(mesh, folder.write("more.ply", header + rows), {}, error)) << error;
        EXPECT_EQ(mesh_hash(mesh), mesh_hash(expected)) << format;
        if (is_ascii) {
            const std::string blank = OIIO::Strutil::replace(header + rows, "\n", "\n \n\n", true);
            ASSERT_TRUE(read_mesh(mesh, folder.write("blank.ply", blank), {}, error)) << error;
            EXPECT_EQ(mesh_hash(mesh), mesh_hash(expected)) << format;
        }
        mesh.positions[0].x += 1;
        EXPECT_NE(mesh_hash(mesh), mesh_hash(expected)) << "a hash that sees nothing";
    }
    row.ours("the same mesh, bit for bit, as without them");
}

TEST(Geometry, VerticesBeyondFloat)
{
    HardCase row("A vertex at NaN, infinity or 1e39, in an OBJ and a PLY");
    EXPECT_TRUE(std::isinf(float(1e39 * std::ldexp(1.0, 0))));
    row.naive("bounds of NaN or infinity: an empty or black map");
    const TemporaryFolder folder;
    for (const auto& [text, told] : { std::pair("nan", "nan"), { "inf", "inf" }, { "1e39", "inf" } }) {
        const std::string says = format(" is not finite: (0, {}, 0)", told);
        EXPECT_EQ(refusal(folder, "a.obj", format("o thing\nv 0 0 0\nv 1 0 0\nv 0 {} 0\nf 1 2 3\n", text)),
                  "vertex 2 of \"thing\"" + says);
        std::string bytes = ply(1, "3 0 1 2");
        bytes.replace(bytes.find("0 1 0\n3"), 5, std::string("0 ") + text + " 0");
        EXPECT_EQ(refusal(folder, "a.ply", bytes), "vertex 2 of \"\"" + says);
    }
    row.ours("refused, naming the first");
}

TEST(Geometry, IndicesOfAnObj)
{
    HardCase row("OBJ faces with index 0, past the end, or negative (counted from the end)");
    row.naive("vertex -1, vertex 99 of 3: out-of-bounds reads");
    const TemporaryFolder folder;
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    EXPECT_EQ(refusal(folder, "a.obj", vertices + "f -3 -2 -1\n"), "");
    for (const char* face : { "f 0 1 2\n", "f 1 2 99\n", "f -9 1 2\n", "f 1 2 99999999999999999999\n" })
        EXPECT_EQ(refusal(folder, "a.obj", vertices + face).find("cannot read as OBJ: line 4: a face uses vertex "), 0u)
            << face;
    row.ours("negative indices work; the others are refused, with their line");
}

TEST(Geometry, ConcavePolygonsAnySize)
{
    HardCase row("An L-shaped polygon of six corners, with sides from 1e-30 to 1e30");
    EXPECT_TRUE(std::isinf(float(1e20) * float(1e20)));
    row.naive("areas in float are infinite or 0: triangulated as if it were convex");
    const TemporaryFolder folder;
    for (const double size : { 1e-30, 1e-10, 1.0, 1e10, 1e18, 1e19, 1e20, 1e30, 1e37 })
        for (int first = 0; first < 6; ++first) {
            std::string text, face = "f";
            for (const auto& [x, y] : { std::pair(0, 0), { 4, 0 }, { 4, 1 }, { 1, 1 }, { 1, 4 }, { 0, 4 } })
                text += format("v {:.9g} {:.9g} 0\n", x * size, y * size);
            for (int corner = 0; corner < 6; ++corner)
                face += format(" {}", (first + corner) % 6 + 1);
            Mesh mesh;
            std::string error;
            ASSERT_TRUE(read_mesh(mesh, folder.write("l.obj", text + face + "\n"), {}, error)) << error;
            double area = 0;
            for (const auto& t : mesh.triangles)
                area += triangle_area_normal(mesh, t).length() / 2 / (size * size);
            EXPECT_EQ(mesh.triangles.size(), 4u) << size;
            EXPECT_NEAR(area, 7, 1e-5) << size << ", from corner " << first;
        }
    row.ours("four triangles with the right area");
}
