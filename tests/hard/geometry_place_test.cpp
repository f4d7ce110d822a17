// SPDX-License-Identifier: Apache-2.0
// Meshes that are very small, very large, or far from the origin, in memory and in files.
#include "hard_case.h"
#include "judgement.h"
#include "mesh_files.h"
#include "scenes.h"
#include "temporary_folder.h"

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

// The mesh as it comes through float, which is what an importer of floats makes of it.
Mesh through_float(Mesh mesh)
{
    for (V3d& p : mesh.positions)
        p = V3d(V3f(p));
    return mesh;
}

Mesh read(const std::string& path)
{
    Mesh mesh;
    std::string error;
    EXPECT_TRUE(read_mesh(mesh, path, {}, error)) << error;
    return mesh;
}

// The greatest distance of a corner from where it should be; triangles must come in the same order.
double farthest_corner(const Mesh& mesh, const Mesh& truth)
{
    double farthest = mesh.triangles.size() == truth.triangles.size() ? 0 : 1e30;
    for (size_t t = 0; t < mesh.triangles.size() && farthest < 1e30; ++t)
        for (int k = 0; k < 3; ++k) {
            const V3d off = mesh.positions[mesh.triangles[t][k]] - truth.positions[truth.triangles[t][k]];
            farthest = std::max(farthest, off.length());
        }
    return farthest;
}

} // namespace

TEST(Geometry, AFileAtTenMillion)
{
    HardCase row("A ball of unit size lies at 1e7 in its file (OBJ; PLY of doubles in three formats)",
                 "assimp keeps floats");
    const TemporaryFolder folder;
    const V3d place(1e7, -2e7, 0.5e7);
    const Mesh out = placed(sphere(V3d(0), 1, 16), 1, place), in = placed(sphere(V3d(0), 1, 16, true), 1, place);
    EXPECT_LT(BakedMap(through_float(out), {}, map_params(64, 64, 1)).report.covered, 4096 / 20);
    row.naive("as floats, hardly a triangle has area left: less than 5 % of the ball is baked");
    const auto expect_kept = [&](const char* name, const auto& bytes_of) {
        const Mesh outside = read(folder.write(name, bytes_of(out))), inside = read(folder.write(name, bytes_of(in)));
        EXPECT_EQ(farthest_corner(outside, out), 0) << name;
        EXPECT_EQ(texels_that_see_less_than_all(outside, 64, 64), 0) << name;
        EXPECT_EQ(texels_that_see(inside, 64, 64), 0) << name;
    };
    expect_kept("a.obj", [](const Mesh& mesh) { return obj_of(mesh); });
    expect_kept("b.OBJ", [](const Mesh& mesh) { return obj_of(mesh, " \r\n"); });
    for (const char* format : { "ascii", "binary_little_endian", "binary_big_endian" })
        expect_kept("a.ply", [&](const Mesh& mesh) { return ply_of(mesh, format); });
    row.ours("the file's doubles are kept, bit for bit: V is 1 outside, 0 inside");
}
