// SPDX-License-Identifier: Apache-2.0
// The open box of tests/data/cases as many programs write it: each file is box.obj.
#include "mesh_fixture.h"

#include <vmlight/base/format.h>

#include <algorithm>
#include <array>

using namespace mesh_files;

namespace {

struct Case
{
    const char* file;
    int uv_set;
    float uv_tolerance; ///< of the quantization, if there is one
    size_t copies; ///< of the box
    bool has_its_diagonals = true; ///< quads are cut from the same corners
};

void PrintTo(const Case& c, std::ostream* stream)
{
    *stream << c.file;
}

constexpr float kHalf8Bits = 0.5f / 255, kHalf12Bits = 0.5f / 4095, kRounding = 1e-6f;

const Case kCases[] = {
    { "bl_box_nonorm.obj", 0, 0, 1 },
    { "box_fuv.ply", 0, 0, 1 },
    { "box_fuv_le.ply", 0, 0, 1 },
    { "draco_16.glb", 0, kHalf12Bits, 1 },
    { "draco_32.glb", 0, kHalf12Bits, 1 },
    { "g_bom.gltf", 0, 0, 1 },
    { "g_fan.glb", 0, 0, 1 },
    { "g_inst.glb", 0, 0, 2 },
    { "g_inter.glb", 0, 0, 1 },
    { "g_mirror.glb", 0, 0, 1 },
    { "g_mirror_nonormal.glb", 0, 0, 1 },
    { "g_morph.glb", 0, 0, 1 },
    { "g_nonormal.glb", 0, 0, 1 },
    { "g_skin.glb", 0, 0, 1 },
    { "g_sparse.glb", 0, 0, 1 },
    { "g_strip.glb", 0, 0, 1, false },
    { "g_uri.gltf", 0, 0, 1 },
    { "g_uv1.glb", 1, 0, 1 },
    { "g_uv16.glb", 0, 0.5f / 65535, 1 },
    { "g_uv8.glb", 0, kHalf8Bits, 1 },
    { "o_novn.obj", 0, 0, 1 },
    { "o_soff.obj", 0, 0, 1 },
    { "q_cst.obj", 0, 0, 1 },
    { "r_comment.obj", 0, 0, 1 },
};

// How far apart corners are, in units of their tolerances.
bool is_corner(const Mesh& a, uint32_t v, const Mesh& b, uint32_t w, const V3d& moved, float uv_tolerance)
{
    constexpr double kPosition = 1e-3; // Draco's 14 bits of a box 6 wide, and of a skin's hundredths
    constexpr float kNormal = 0.02f; // of 10 bits
    const V2f uv = a.uvs[v] - b.uvs[w];
    return (a.positions[v] + moved - b.positions[w]).length() < kPosition
        && (a.normals[v] - b.normals[w]).length() < kNormal
        && std::max(std::abs(uv.x), std::abs(uv.y)) <= uv_tolerance + kRounding;
}

// Whether `mesh` has the triangle, from whichever corner on.
bool has_triangle(const Mesh& mesh, const Mesh& box, const std::array<uint32_t, 3>& triangle, const V3d& moved,
                  float uv_tolerance)
{
    return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const std::array<uint32_t, 3>& other) {
        for (size_t first = 0; first < 3; ++first) {
            bool same = true;
            for (size_t k = 0; k < 3; ++k)
                same &= is_corner(box, triangle[k], mesh, other[(first + k) % 3], moved, uv_tolerance);
            if (same)
                return true;
        }
        return false;
    });
}

} // namespace

class MeshCases : public MeshFiles, public testing::WithParamInterface<Case>
{ };

TEST_P(MeshCases, IsTheBox)
{
    const std::string folder = std::string(VMLIGHT_TEST_DATA) + "/cases/";
    const Mesh box = read(folder + "box.obj");
    MeshParams params;
    params.uv_set = GetParam().uv_set;
    const Mesh mesh = read(folder + GetParam().file, params);
    EXPECT_EQ(mesh.triangles.size(), box.triangles.size() * GetParam().copies);
    ASSERT_FALSE(mesh.uvs.empty());
    EXPECT_NEAR(area(mesh), area(box) * double(GetParam().copies), 1e-3);
    for (size_t v = 0; v < box.positions.size(); ++v) {
        bool is_there = false;
        for (size_t w = 0; w < mesh.positions.size(); ++w)
            is_there |= is_corner(box, uint32_t(v), mesh, uint32_t(w), V3d(0), GetParam().uv_tolerance);
        EXPECT_TRUE(is_there) << "vertex " << v;
    }
    for (size_t t = 0; t < box.triangles.size() && GetParam().has_its_diagonals; ++t)
        EXPECT_TRUE(has_triangle(mesh, box, box.triangles[t], V3d(0), GetParam().uv_tolerance)) << "triangle " << t;
}

INSTANTIATE_TEST_SUITE_P(All, MeshCases, testing::ValuesIn(kCases));

TEST_F(MeshFiles, TheSecondInstanceOfACaseIsBesideTheFirst)
{
    const std::string cases = std::string(VMLIGHT_TEST_DATA) + "/cases/";
    const Mesh box = read(cases + "box.obj"), mesh = read(cases + "g_inst.glb");
    EXPECT_TRUE(has_triangle(mesh, box, box.triangles[0], V3d(2.5, 0, 0), 0));
}

TEST_F(MeshFiles, ACaseThatRequiresAnUnknownExtensionIsRefused)
{
    const std::string cases = std::string(VMLIGHT_TEST_DATA) + "/cases/";
    EXPECT_EQ(refusal(cases + "g_unknownreq.gltf"),
              "requires the extension XX_unknown_geometry, which vmlight does not read: export the mesh without it");
}
