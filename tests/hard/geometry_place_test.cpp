// SPDX-License-Identifier: Apache-2.0
// Meshes that are very small, very large, or far from the origin, in memory and in files.
#include "hard_case.h"
#include "judgement.h"
#include "mesh_files.h"
#include "scenes.h"
#include "temporary_folder.h"

#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/stage/make_stage.h>

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

Mesh read_file(const std::string& path)
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
    HardCase row("A unit sphere at 1e7 from the origin (OBJ; PLY with doubles, in three encodings)",
                 "assimp stores floats");
    const TemporaryFolder folder;
    const V3d place(1e7, -2e7, 0.5e7);
    const Mesh out = placed(sphere(V3d(0), 1, 16), 1, place), in = placed(sphere(V3d(0), 1, 16, true), 1, place);
    EXPECT_LT(BakedMap(through_float(out), {}, map_params(64, 64, 1)).report.covered, 4096 / 20);
    row.naive("as floats, most triangles lose their area: less than 5 % of the sphere is baked");
    const auto expect_kept = [&](const char* name, const auto& bytes_of) {
        const Mesh outside = read_file(folder.write(name, bytes_of(out))),
                   inside = read_file(folder.write(name, bytes_of(in)));
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

TEST(Geometry, BallsOfAllSizes)
{
    HardCase row("Spheres scaled by 1e-30 to 1e30, or moved by up to 1e7 (in memory, with positions in double)",
                 "aobaker, Godot, Arnold: bias in the scene's units");
    row.naive("with tnear = 1e-4: half of the rays blocked at 1e6, all leak at 1e-6; with an offset in ulps: all leak "
              "at 1e-6 and at 1e7 (measured)");
    // Positions are double: what survives of a unit ball at 1e7 in double (2e-9) is more than float keeps of it at 0.
    const std::pair<double, double> table[] = { { 1, 0 },   { 1e-6, 0 },   { 1e6, 0 },   { 1, 1e3 }, { 1, 1e5 },
                                                { 1, 1e7 }, { 1e-3, 1e3 }, { 1e-30, 0 }, { 1e30, 0 } };
    for (const auto& [scale, offset] : table) {
        SCOPED_TRACE(testing::Message() << "scale " << scale << ", offset " << offset);
        EXPECT_EQ(texels_that_see_less_than_all(placed(sphere(V3d(0), 1, 16), scale, V3d(offset)), 64, 64), 0);
        EXPECT_EQ(texels_that_see(placed(sphere(V3d(0), 1, 16, true), scale, V3d(offset)), 64, 64), 0);
    }
    row.ours("V = 1 outside, 0 inside, exactly");
}

TEST(Geometry, UnitsDoNotMatter)
{
    HardCase row("A bowl under a lid, scaled by 2^-20, 2^20, 2^-100, then by factors that round",
                 "Arnold: depends on scene scale");
    row.naive("the ray offset is in the mesh's units");
    // A bowl under a lid: every texel is partly blocked. Powers of two round nothing, so that maps are bit-equal.
    Mesh scene = sphere(V3d(0), 1, 16, true);
    scene.triangles.resize(scene.triangles.size() / 2);
    append(scene, floor_facing_z(0.4, V3d(0.1, 0.2, -0.3)));
    const VismapParams params = map_params(48, 48, 64);
    const BakedMap reference(scene, {}, params);
    for (double scale : { 0x1p-20, 0x1p20, 0x1p-100 })
        EXPECT_TRUE(BakedMap(placed(scene, scale), {}, params) == reference) << scale;
    // Other scales and places round the vertices otherwise, by 6e-8 of the mesh: the same but for rays within that of
    // an edge, one in thousands.
    for (const auto& [scale, offset] :
         { std::pair(1e-6, 0.0), { 1e6, 0.0 }, { 1.0, 2e4 }, { 1e-3, 20.0 }, { 0.3, 0.0 } }) {
        const BakedMap map(placed(scene, scale, V3d(offset, -offset, offset)), {}, params);
        double worst = 0, changed = 0;
        map.each_covered([&](const Texel& t, int x, int y) {
            const Texel& r = reference.at(x, y);
            const double change = std::abs(t.visibility - r.visibility);
            worst = std::max(worst, change);
            changed += change > 0;
            EXPECT_LT((t.direction - r.direction).length(), 2.5 / 64);
        });
        EXPECT_LE(worst, 2.0 / 64) << scale << ", " << offset; // two rays of 64
        EXPECT_LT(changed, 0.002 * map.report.covered) << scale << ", " << offset;
    }
    row.ours("maps are bit-equal; where scaling rounds, they agree within two rays of 64");
}

TEST(Geometry, AMillionthAndAMillionInOneMesh)
{
    HardCase row("Squares of 1e-6, 1 and 1e6 in one mesh");
    row.naive("floats resolve 1e-7 of its size: small triangles become points");
    // A unit square a millionth of which, and a piece a million times as large, are squares of their own.
    Mesh mesh;
    for (double size : { 1e-6, 1.0, 1e6 }) {
        const float v = size < 1 ? 0.0f : size > 1 ? 0.6f : 0.3f;
        const V3d low(size < 1 ? 5 : 0, size < 1 ? 5 : 0, 2 * size);
        add_quad(mesh, low, low + V3d(size, 0, 0), low + V3d(size, size, 0), low + V3d(0, size, 0), V2f(0, v),
                 V2f(1, v + 0.3f));
    }
    const BakedMap map(mesh, {}, map_params(32, 32, 64));
    map.each([](const Texel& t, int, int) { EXPECT_TRUE(is_finite(t) && t.visibility >= 0 && t.visibility <= 1); });
    map.each_covered([](const Texel& t, int, int y) { EXPECT_TRUE(y >= 13 || sees_all(t)) << y; }); // what is on top
    EXPECT_EQ(map.report.tiny, 4);
    row.ours("finite; the top is fully open; triangles smaller than 4e-6 of the mesh are counted, with a warning");
}

TEST(Geometry, AnOccluderAtTheEndOfFloat)
{
    HardCase row("Walls 1e17 and 1e20 times as large as the mesh beside them");
    row.naive("Embree silently drops geometry beyond 1.8e18: V = 1");
    const Mesh floor = floor_facing_z(1);
    std::string error;
    OIIO::ImageBuf image;
    const Mesh wall = rectangle(V3d(0, -1e17, 0), V3d(0, 2e17, 0), V3d(0, 0, 1e17));
    const BakedMap half(floor, { wall }, map_params(8, 8, 1024));
    half.each([](const Texel& t, int, int) { EXPECT_NEAR(t.visibility, 0.5, 0.02); });
    EXPECT_FALSE(make_vismap(image, floor, { placed(wall, 1e3) }, map_params(8, 8, 64)));
    EXPECT_EQ(image.geterror(),
              "\"quad\": vertex 0 is 1e+20 times the size of the baked mesh away; rays reach at most 1e+18 times");
    row.ours("V = 1/2 beside the first; the second is refused, naming the vertex");
}

TEST(Geometry, FloatsFarFromTheOrigin)
{
    HardCase row("A sphere at 1e5 in a file of floats, the only numbers that some formats have");
    row.naive("steps of 1/128 of its size, without a warning");
    const Mesh ball = through_float(placed(sphere(V3d(0), 1, 16), 1, V3d(1e5, 0, 0)));
    EXPECT_NEAR(BakedMap(ball, {}, map_params(32, 32, 1)).report.rounding, 3e-3, 1e-4);
    EXPECT_LT(BakedMap(through_float(sphere(V3d(0), 1, 16)), {}, map_params(32, 32, 1)).report.rounding, 6e-8);
    EXPECT_EQ(BakedMap(placed(ball, 1, V3d(1e-9)), {}, map_params(32, 32, 1)).report.rounding, 0);

    const TemporaryFolder folder;
    std::string ply = ply_of(ball, "ascii"); // with float coordinates
    for (size_t at = ply.find("double"); at != std::string::npos; at = ply.find("double"))
        ply.replace(at, 6, "float");
    VismapRecipe recipe;
    recipe.mesh = folder.write("a.ply", ply);
    recipe.vismap_params = map_params(32, 32, 1);
    std::vector<std::string> lines;
    MakeOptions options;
    options.warn = [&](const std::string& line) { lines.push_back(line); };
    OIIO::ImageBuf image;
    EXPECT_TRUE(make_image(image, recipe, options)) << image.geterror();
    ASSERT_FALSE(lines.empty());
    EXPECT_EQ(lines.back(),
              "the mesh is so far from the origin that its float coordinates are rounded to 0.003 of its size: move "
              "it closer to the origin");
    row.ours("baked, with a warning that gives the size of the steps");
}
