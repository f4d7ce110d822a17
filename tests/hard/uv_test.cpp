// SPDX-License-Identifier: Apache-2.0
// Texture coordinates that overlap, leave the texture, have no area, are no numbers; textures of all sizes.
#include "cases.h"
#include "hard_case.h"
#include "judgement.h"
#include "scenes.h"
#include "temporary_folder.h"

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/uv/raster.h>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

using Point = std::array<double, 2>; // in texels, y down

// A mesh of triangles in texture space, each with an area in space.
Mesh flat(const std::vector<std::array<Point, 3>>& triangles, double width, double height)
{
    Mesh mesh;
    mesh.name = "flat";
    for (const auto& triangle : triangles) {
        const uint32_t first = uint32_t(mesh.positions.size());
        for (int k = 0; k < 3; ++k) {
            mesh.uvs.emplace_back(float(triangle[k][0] / width), float(1 - triangle[k][1] / height));
            mesh.positions.emplace_back(k == 1, k == 2, 0.01 * first);
            mesh.normals.emplace_back(0, 0, 1);
        }
        mesh.triangles.push_back({ first, first + 1, first + 2 });
        mesh.triangle_materials.push_back(0);
    }
    return mesh;
}

struct Covered
{
    int64_t texels = 0, overlapping = 0;
};

Covered covered_of(const Mesh& mesh, int width, int height)
{
    const UvRaster raster(mesh, width, height);
    Covered sum;
    TileCover tile;
    for (int t = 0; t < raster.tiles_across() * raster.tiles_down(); ++t) {
        raster.cover(t, tile);
        sum.texels += tile.covered;
        sum.overlapping += tile.overlapping;
    }
    return sum;
}

double side_of(const Point& a, const Point& b, const Point& p)
{
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
}

// Is a point in the triangle or on its rim, whichever way that is wound?
bool holds(const std::array<Point, 3>& t, const Point& p)
{
    const double a = side_of(t[0], t[1], p), b = side_of(t[1], t[2], p), c = side_of(t[2], t[0], p);
    return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

// What making a map of an OBJ warns of.
std::vector<std::string> warnings_of(const std::string& obj, int size)
{
    const TemporaryFolder folder;
    VismapRecipe recipe;
    recipe.mesh = folder.write("a.obj", obj);
    recipe.vismap_params = map_params(size, size, 4);
    std::vector<std::string> lines;
    MakeOptions options;
    options.warn = [&](const std::string& line) { lines.push_back(line); };
    OIIO::ImageBuf image;
    EXPECT_TRUE(make_image(image, recipe, options)) << image.geterror();
    return lines;
}

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";

} // namespace

TEST(Uv, SharedEdgesOfAllPairs)
{
    HardCase row("Every pair of triangles sharing an edge, with corners on a half-texel lattice",
                 "Cycles, MoonRay, Godot: texels nudged or missed");
    const auto corner = [](int i) { return Point { (i & 3) / 2.0, (i >> 2 & 3) / 2.0 }; };
    int64_t pairs = 0, naive_twice = 0;
    for (int code = 0; code < 65536; ++code) {
        const Point p[4] = { corner(code), corner(code >> 4), corner(code >> 8), corner(code >> 12) };
        if (side_of(p[0], p[2], p[1]) * side_of(p[0], p[2], p[3]) >= 0)
            continue;
        const std::array<Point, 3> one { p[0], p[1], p[2] }, other { p[0], p[2], p[3] };
        const Covered both = covered_of(flat({ one, other }, 2, 2), 2, 2);
        ASSERT_EQ(both.overlapping, 0) << code;
        int64_t least = 0; // centres inside one triangle, or on the side they share
        for (const Point& centre : { Point { 0.5, 0.5 }, { 1.5, 0.5 }, { 0.5, 1.5 }, { 1.5, 1.5 } }) {
            const auto inside = [&](const std::array<Point, 3>& t) {
                const double a = side_of(t[0], t[1], centre), b = side_of(t[1], t[2], centre),
                             c = side_of(t[2], t[0], centre);
                return (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
            };
            const bool on_side = holds(one, centre) && holds(other, centre) && centre != p[0] && centre != p[2];
            least += inside(one) || inside(other) || on_side;
            naive_twice += holds(one, centre) && holds(other, centre);
        }
        ASSERT_GE(both.texels, least) << code;
        ++pairs;
    }
    EXPECT_GT(naive_twice, 1000);
    row.naive("with >= 0 the texels on the shared edge are covered twice; with > 0 never");
    row.ours(format("each once, for all {} pairs", pairs));
}

TEST(Uv, TexturesOfAllShapes)
{
    HardCase row("Textures of 1x1, 1xN, Nx1, 3x1000 and 16384x16384 texels, filled by two triangles");
    const int large = cases(16384, 2048);
    row.naive("in float, 54601 texels twice and 23 never at 8192x8192 (measured)");
    for (const auto& [width, height] :
         { std::pair(1, 1), { 1, 777 }, { 777, 1 }, { 3, 1000 }, { 65, 64 }, { large, large } }) {
        const double w = width, h = height;
        const Covered covered = covered_of(
            flat({ { { { 0, 0 }, { 0, h }, { w, h } } }, { { { 0, 0 }, { w, h }, { w, 0 } } } }, w, h), width, height);
        EXPECT_EQ(covered.texels, int64_t(width) * height) << width << "x" << height;
        EXPECT_EQ(covered.overlapping, 0) << width << "x" << height;
    }
    for (const auto& [width, height] : { std::pair(1, 1), { 1, 200 }, { 200, 1 }, { 3, 1000 } }) {
        const BakedMap map(floor_facing_z(1), {}, map_params(width, height, 8));
        EXPECT_EQ(map.report.covered, width * height);
        EXPECT_EQ(count_covered_unless(map, sees_all), 0);
    }
    row.ours("each texel once");
}

TEST(Uv, Overlap)
{
    HardCase row("Two overlapping islands", "Cycles, MoonRay, Arnold: the last writer wins");
    row.naive("the last one wins, or the last thread");
    Mesh mesh = floor_facing_z(1, V3d(0, 0, 5));
    append(mesh, floor_facing_z(1));
    const BakedMap map(mesh, {}, map_params(32, 32, 16));
    EXPECT_EQ(map.report.overlapping, 1024);
    EXPECT_EQ(count_covered_unless(map, sees_all), 0); // the floor's, which comes first
    EXPECT_TRUE(map == BakedMap(mesh, {}, map_params(32, 32, 16), 3));
    row.ours("the first triangle of the file wins, for any number of threads; counted, with a warning");
}

TEST(Uv, MirroredIslands)
{
    HardCase row("A mirrored island", "Cycles, MoonRay, Arnold: say nothing");
    Mesh mesh = floor_facing_z(1);
    for (V2f& uv : mesh.uvs)
        uv.x = 1 - uv.x;
    const V2f e1 = mesh.uvs[1] - mesh.uvs[0], e2 = mesh.uvs[2] - mesh.uvs[0];
    EXPECT_LT(e1.x * e2.y - e1.y * e2.x, 0);
    row.naive("a normal from the UV winding points inwards: V = 0");
    const BakedMap map(mesh, {}, map_params(16, 16, 64));
    EXPECT_EQ(map.report.uv.mirrored, 2);
    map.each([](const Texel& t, int, int) {
        EXPECT_EQ(t.visibility, 1);
        EXPECT_NEAR(t.direction.z, 2.0 / 3, 1e-6);
    });
    row.ours("the same as not mirrored, every texel once; counted");
}

TEST(Uv, OutOfTheTexture)
{
    HardCase row("UVs partly or fully outside [0,1], at 1e8 or 1e30, or NaN", "xatlas#54: freezes, NaN");
    const double far = 1e8, farther = 1e30;
    const std::vector<std::array<Point, 3>> triangles {
        { { { 0, 0 }, { 0, 8 }, { 8, 8 } } }, // inside
        { { { 4, 4 }, { 4, 20 }, { 20, 20 } } }, // across the border
        { { { 20, 4 }, { 20, 8 }, { 24, 8 } } }, // elsewhere
        { { { far, 4 }, { far, 8 }, { 2 * far, 8 } } }, // elsewhere
        { { { -far, -far }, { -far, far }, { far, far } } }, // across
        { { { farther, 4 }, { -farther, 8 }, { farther, 9 } } }, // across
        { { { NAN, 4 }, { 4, 8 }, { 8, 8 } } },
        { { { 4, 4 }, { 4, INFINITY }, { 8, 8 } } },
    };
    // 1e30 to a whole number of 64 bits is anything.
    row.naive("1e30 converts to an arbitrary integer: writes outside the map, or an endless loop");
    const BakedMap map(flat(triangles, 16, 16), {}, map_params(16, 16, 16));
    const UvReport& uv = map.report.uv;
    EXPECT_EQ(uv.outside, 5);
    EXPECT_EQ(uv.fully_outside, 2);
    EXPECT_EQ(uv.without_uv, 2);
    EXPECT_EQ(uv.uncovered_islands, 2); // those that reach across, but too far to be drawn
    map.each([](const Texel& t, int, int) { EXPECT_TRUE(is_finite(t)); });
    row.ours("the part inside the texture is baked; each kind is counted, with a warning");
}

TEST(Uv, NotANumberInAFile)
{
    HardCase row("UVs in an OBJ that are not numbers");
    const TemporaryFolder folder;
    const std::string path
        = folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt nan 1\nvt 0 -inf\nf 1/1 2/2 3/3\n");
    row.naive("assimp reads them as 0: wrong UVs");
    Mesh mesh;
    std::string error;
    EXPECT_FALSE(read_mesh(mesh, path, {}, error));
    EXPECT_EQ(error, "\"" + path + "\": line 5 has non-finite texture coordinates: \"vt nan 1\"");
    row.ours("refused, with the line number");
}

TEST(Uv, NoArea)
{
    HardCase row("Triangles whose UVs are all in one point, or on a line", "Gaffer PR#2998: a crash");
    row.naive("weights are 0 / 0: NaN");
    const std::vector<std::string> one
        = warnings_of(kSquare + "v 5 5 5\nv 6 5 5\nv 5 6 5\nvt 0.5 0.5\nf 5/5 6/5 7/5\n", 16);
    EXPECT_EQ(one,
              std::vector<std::string>(1,
                                       "1 of 2 islands in UV (1 triangle) covers no texel and is not baked: "
                                       "thinner than a texel, without area, or too far away"));
    const BakedMap map(flat({ { { { 2, 2 }, { 5, 5 }, { 8, 8 } } } }, 16, 16), {}, map_params(16, 16, 4));
    EXPECT_EQ(map.report.uv.degenerate_uv, 1);
    EXPECT_EQ(map.report.covered, 0);
    row.ours("they cast and are not baked; counted, with a warning");
}

TEST(Uv, IslandsThinnerThanATexel)
{
    HardCase row("Islands that pass between texel centres", "xatlas#50: tiny triangles are treated as zero area");
    row.naive("they vanish from the map without a warning");
    // Ten ribbons, of which those at whole texels miss all centres; one of them is of two triangles.
    std::vector<std::array<Point, 3>> triangles;
    for (int i = 0; i < 10; ++i) {
        const double y = 2 + i + (i % 2 ? 0.4 : 0);
        triangles.push_back({ { { 1, y }, { 1, y + 0.2 }, { 15, y + 0.2 } } });
    }
    triangles.push_back({ { { 1, 2 }, { 15, 2.2 }, { 15, 2 } } });
    const BakedMap map(flat(triangles, 16, 16), {}, map_params(16, 16, 4));
    EXPECT_EQ(map.report.uv.islands, 10);
    EXPECT_EQ(map.report.uv.uncovered_islands, 5);
    EXPECT_EQ(map.report.uv.uncovered_triangles, 6);
    // Finer, they are all there.
    EXPECT_EQ(BakedMap(flat(triangles, 16, 16), {}, map_params(160, 160, 1)).report.uv.uncovered_islands, 0);
    EXPECT_EQ(warnings_of(kSquare, 8), std::vector<std::string>());
    row.ours("a warning says how many islands cover no texel");
}
