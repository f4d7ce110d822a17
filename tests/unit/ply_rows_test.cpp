// SPDX-License-Identifier: Apache-2.0
// Binary PLY files whose rows all lie alike are read in parallel: the same meshes and refusals as row by row.
#include "mesh_fixture.h"

#include <vmlight/base/format.h>
#include <vmlight/base/parallel_blocks.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

using namespace mesh_files;

namespace {

constexpr int kGridSide = 300; // vertices; more than one block of them
static_assert(size_t(kGridSide) * kGridSide > kElementsOfBlock);

/// A file of a square grid, written row by row.
class GridFile
{
public:
    /// @param has_quad   the last two triangles are one face
    explicit GridFile(std::string format_name, bool has_quad = false)
        : m_format(std::move(format_name))
        , m_has_quad(has_quad)
    {
        m_bytes = "ply\nformat " + m_format
            + format(" 1.0\nelement vertex {}\nproperty double x\nproperty list uchar short tags\nproperty float z\n"
                     "property short y\nproperty float s\nproperty float t\nelement marks 2\nproperty int mark\n"
                     "element face {}\nproperty uchar red\nproperty list uchar int vertex_indices\nend_header\n",
                     kGridSide * kGridSide, 2 * (kGridSide - 1) * (kGridSide - 1) - (has_quad ? 1 : 0));
    }

    /// @param tags         the length of a list in row 7; 2 elsewhere
    /// @param bad_vertex   instead of one in the last row but one
    std::string bytes(size_t tags = 2, int bad_vertex = 0)
    {
        for (int i = 0; i < kGridSide * kGridSide; ++i) {
            const int x = i % kGridSide, y = i / kGridSide;
            put(x + 0.1);
            put(uint8_t(i == 7 ? tags : 2));
            for (size_t k = 0; k < (i == 7 ? tags : 2); ++k)
                put(int16_t(i));
            put(float(i % 3));
            put(int16_t(y));
            put(float(x) / kGridSide);
            put(float(y) / kGridSide);
            end_row();
        }
        for (const int mark : { 1, 2 }) {
            put(mark);
            end_row();
        }
        for (int y = 0; y + 1 < kGridSide; ++y)
            for (int x = 0; x + 1 < kGridSide; ++x) {
                const int a = y * kGridSide + x, b = a + kGridSide;
                const bool is_last = y + 2 == kGridSide && x + 2 == kGridSide;
                if (is_last && m_has_quad) {
                    face({ a, a + 1, b + 1, b });
                } else {
                    face({ a, a + 1, is_last && bad_vertex ? bad_vertex : b + 1 });
                    face({ a, b + 1, b });
                }
            }
        return m_bytes;
    }

private:
    template <class T> void put(T number)
    {
        char raw[sizeof(T)];
        std::memcpy(raw, &number, sizeof(T));
        if (m_format == "binary_big_endian")
            std::reverse(raw, raw + sizeof(T));
        if (m_format == "ascii")
            m_bytes += format("{} ", number);
        else
            m_bytes.append(raw, sizeof(T));
    }
    void face(const std::vector<int>& corners)
    {
        put(uint8_t(9));
        put(uint8_t(corners.size()));
        for (const int corner : corners)
            put(corner);
        end_row();
    }
    void end_row() { m_bytes += m_format == "ascii" ? "\n" : ""; }

    const std::string m_format;
    const bool m_has_quad;
    std::string m_bytes;
};

} // namespace

class PlyRows : public MeshFiles
{ };

TEST_F(PlyRows, AreTheSameMeshInEachEncoding)
{
    const Mesh expected = read("a.ply", GridFile("ascii").bytes()); // row by row
    ASSERT_EQ(expected.positions.size(), size_t(kGridSide) * kGridSide);
    EXPECT_EQ(expected.triangles.size(), size_t(2) * (kGridSide - 1) * (kGridSide - 1));
    const std::string hash = mesh_hash(expected);
    for (const char* name : { "binary_little_endian", "binary_big_endian" }) {
        EXPECT_EQ(mesh_hash(read("b.ply", GridFile(name).bytes())), hash) << name;
        // Not even: a list of another length, of what is skipped and of corners.
        EXPECT_EQ(mesh_hash(read("b.ply", GridFile(name).bytes(3))), hash) << name;
        EXPECT_EQ(mesh_hash(read("b.ply", GridFile(name, true).bytes())), hash) << name;
    }
}

TEST_F(PlyRows, AreRefusedAsRowByRow)
{
    const std::string name = "binary_little_endian";
    const int vertices = kGridSide * kGridSide, faces = 2 * (kGridSide - 1) * (kGridSide - 1);
    for (const int vertex : { vertices, -1 })
        EXPECT_EQ(refusal(folder.write("a.ply", GridFile(name).bytes(2, vertex))),
                  format("PLY face {} uses vertex {}, but there are only {}", faces - 2, vertex, vertices));
    const std::string whole = GridFile(name).bytes();
    EXPECT_EQ(refusal(folder.write("a.ply", whole.substr(0, whole.size() - 1))),
              format("PLY ends inside face {} of {}", faces - 1, faces));
    EXPECT_EQ(refusal(folder.write("a.ply", whole.substr(0, whole.size() / 4))).substr(0, 22),
              "PLY ends inside vertex");
}
