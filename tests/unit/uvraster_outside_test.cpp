// SPDX-License-Identifier: Apache-2.0
// Texture coordinates outside [0, 1], in other UDIM tiles, or of no area.
#include "flat_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

using namespace vmlight;
using namespace vmlight::flat_mesh;

TEST(UvRasterOutside, TheReportTellsTheHealthOfTextureCoordinates)
{
    Flat flat(16, 16);
    const uint32_t a = flat.vertex(0, 0), b = flat.vertex(0, 16), c = flat.vertex(16, 16), d = flat.vertex(16, 0);
    const uint32_t beyond = flat.vertex(20, 8), nan = flat.vertex(NAN, 3), infinite = flat.vertex(INFINITY, 3),
                   huge = flat.vertex(1e8 * 16, 8), huger = flat.vertex(1e30, 1e30), negative = flat.vertex(-160, 8);
    for (uint32_t v : { nan, infinite, huge, huger })
        flat.mesh.positions[v] = V3d(3, 4, 5);
    const uint32_t same_place = flat.vertex(8, 8);
    flat.mesh.positions[same_place] = flat.mesh.positions[a];
    flat.triangle(a, b, c);
    flat.triangle(a, d, c); // mirrored
    flat.triangle(b, c, beyond); // outside
    flat.triangle(a, b, nan); // without uv
    flat.triangle(a, b, infinite); // without uv
    flat.triangle(a, b, huge); // outside
    flat.triangle(a, b, huger); // outside
    flat.triangle(a, negative, b); // outside
    flat.triangle(a, a, b); // degenerate in both
    flat.triangle(a, b, same_place); // degenerate in space
    const UvReport report = UvRaster(flat.mesh, 16, 16).report();
    EXPECT_EQ(report.triangles, 10);
    EXPECT_EQ(report.mirrored, 1);
    EXPECT_EQ(report.without_uv, 2);
    EXPECT_EQ(report.outside, 4);
    EXPECT_EQ(report.degenerate_uv, 1);
    EXPECT_EQ(report.degenerate_3d, 2);
}

TEST(UvRasterOutside, ATileOfMovedCoordinatesIsCoveredAsTheFirstWasBeforeToTheLastBit)
{
    // Multiples of 2^-16 stay exact when moved by whole tiles.
    std::mt19937 random(5);
    std::uniform_int_distribution<int> fraction(-20000, 90000);
    Mesh mesh;
    for (uint32_t i = 0; i < 300; ++i) {
        mesh.uvs.emplace_back(float(fraction(random)) / 65536, float(fraction(random)) / 65536);
        mesh.positions.emplace_back(mesh.uvs[i].x, mesh.uvs[i].y, 0);
        if (i % 3 == 2)
            mesh.triangles.push_back({ i - 2, i - 1, i });
    }
    const UvRaster still(mesh, 100, 70);
    for (int udim : { 1002, 1011, 1067 }) {
        Mesh moved = mesh;
        for (V2f& uv : moved.uvs)
            uv += udim_corner(udim);
        const UvRaster raster(moved, 100, 70, udim);
        EXPECT_EQ(raster.report().outside, still.report().outside);
        for (int tile = 0; tile < still.tiles_across() * still.tiles_down(); ++tile) {
            TileCover a, b;
            still.cover(tile, a);
            raster.cover(tile, b);
            ASSERT_EQ(a.triangle, b.triangle);
            ASSERT_EQ(a.covered, b.covered);
            for (size_t i = 0; i < a.triangle.size(); ++i)
                if (a.triangle[i] != TileCover::kNone) {
                    ASSERT_EQ(a.weight1[i], b.weight1[i]) << udim << " " << i;
                    ASSERT_EQ(a.weight2[i], b.weight2[i]) << udim << " " << i;
                }
        }
    }
}

TEST(UvRasterOutside, TrianglesOfOtherTilesAreToldFromThoseThatReachOver)
{
    Flat flat(16, 16); // in texels: a tile is 16 wide, y down
    const auto triangle = [&](double x, double y, double size) {
        flat.triangle(flat.vertex(x, y), flat.vertex(x, y + size), flat.vertex(x + size, y + size));
    };
    triangle(0, 0, 16); // 1001
    triangle(16, 0, 16); // 1002, from its border
    triangle(20, -10, 4); // 1012
    triangle(12, 4, 8); // 1001 and 1002
    triangle(-8, 4, 4); // no tile
    triangle(1e8, 4, 4); // no tile, far away
    const auto counts = [&](int udim) {
        const UvReport report = UvRaster(flat.mesh, 16, 16, udim).report();
        return std::vector<int64_t> { report.outside, report.fully_outside, report.beyond_udims };
    };
    EXPECT_EQ(counts(1001), (std::vector<int64_t> { 5, 4, 2 }));
    EXPECT_EQ(counts(1002), (std::vector<int64_t> { 5, 4, 2 }));
    EXPECT_EQ(counts(1012), (std::vector<int64_t> { 5, 5, 2 }));
    EXPECT_EQ(counts(1055), (std::vector<int64_t> { 6, 6, 2 }));
}

TEST(UvRasterOutside, TrianglesFarOutsideStillCoverWhatTheyReach)
{
    // From ten thousand textures away, on both sides: exact all the same.
    Flat flat(50, 50);
    const uint32_t a = flat.vertex(-5e5, 25.5), b = flat.vertex(5e5, 25.5), c = flat.vertex(25, 7e5),
                   d = flat.vertex(25, -7e5);
    flat.triangle(a, c, b);
    flat.triangle(a, b, d);
    expect_each_texel_once(flat, 2500);
}

TEST(UvRasterOutside, TrianglesOfNoTextureAreaCoverNothing)
{
    Flat flat(16, 16);
    const uint32_t a = flat.vertex(0.5, 0.5), b = flat.vertex(15.5, 15.5), c = flat.vertex(8.5, 8.5);
    flat.triangle(a, b, c);
    flat.mesh.positions[c] = V3d(0, 5, 0);
    const Cover cover(flat);
    EXPECT_EQ(cover.covered, 0);
    EXPECT_EQ(cover.raster.report().degenerate_uv, 1);
}
