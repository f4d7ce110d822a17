// SPDX-License-Identifier: Apache-2.0
#include "scenes.h"

#include <vmlight/uv/raster.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

// A mesh from texture coordinates alone, given in texels with y down; z is a function of them, so that it has area.
struct Flat
{
    Flat(int w, int h)
        : width(w)
        , height(h)
    {
    }
    uint32_t vertex(double x, double y)
    {
        mesh.uvs.push_back(V2f(float(x / width), float(1 - y / height)));
        mesh.positions.push_back(V3d(x, -y, 0));
        mesh.normals.push_back(V3f(0, 0, 1));
        return uint32_t(mesh.positions.size() - 1);
    }
    void triangle(uint32_t a, uint32_t b, uint32_t c)
    {
        mesh.triangles.push_back({ a, b, c });
        mesh.triangle_materials.push_back(0);
    }

    int width, height;
    Mesh mesh;
};

// All tiles together.
struct Cover
{
    explicit Cover(const Flat& flat)
        : raster(flat.mesh, flat.width, flat.height)
        , width(flat.width)
        , owner(size_t(flat.width) * flat.height, TileCover::kNone)
        , weight1(owner.size())
        , weight2(owner.size())
    {
        for (int t = 0; t < raster.tiles_across() * raster.tiles_down(); ++t) {
            TileCover tile;
            raster.cover(t, tile);
            covered += tile.covered;
            overlapping += tile.overlapping;
            for (int i = 0; i < kTileSize * kTileSize; ++i) {
                const int x = t % raster.tiles_across() * kTileSize + i % kTileSize;
                const int y = t / raster.tiles_across() * kTileSize + i / kTileSize;
                if (tile.triangle[i] == TileCover::kNone)
                    continue;
                EXPECT_TRUE(x < width && y < flat.height);
                owner[size_t(y) * width + x] = tile.triangle[i];
                weight1[size_t(y) * width + x] = tile.weight1[i];
                weight2[size_t(y) * width + x] = tile.weight2[i];
            }
        }
    }
    uint32_t at(int x, int y) const { return owner[size_t(y) * width + x]; }

    UvRaster raster;
    int width;
    std::vector<uint32_t> owner;
    std::vector<float> weight1, weight2;
    int64_t covered = 0, overlapping = 0;
};

void expect_each_texel_once(const Flat& flat, int64_t texels)
{
    const Cover cover(flat);
    EXPECT_EQ(cover.covered, texels);
    EXPECT_EQ(cover.overlapping, 0);
}

} // namespace

TEST(UvRaster, RowZeroIsTheTopOfTheTexture)
{
    Flat flat(8, 4);
    const uint32_t a = flat.vertex(0, 0), b = flat.vertex(0, 4), c = flat.vertex(8, 0);
    flat.triangle(a, b, c);
    EXPECT_EQ(flat.mesh.uvs[0], V2f(0, 1));
    const Cover cover(flat);
    EXPECT_EQ(cover.at(0, 0), 0u);
    EXPECT_EQ(cover.at(0, 3), 0u);
    EXPECT_EQ(cover.at(6, 0), 0u);
    EXPECT_EQ(cover.at(7, 3), TileCover::kNone);
}

TEST(UvRaster, ATexelOnALeftOrTopEdgeIsInAndOnARightOrBottomOneIsNot)
{
    Flat flat(6, 6); // a square whose sides run through texel centres
    const uint32_t a = flat.vertex(1.5, 1.5), b = flat.vertex(4.5, 1.5), c = flat.vertex(4.5, 4.5),
                   d = flat.vertex(1.5, 4.5);
    flat.triangle(a, d, c);
    flat.triangle(a, c, b);
    const Cover cover(flat);
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 6; ++x)
            EXPECT_EQ(cover.at(x, y) != TileCover::kNone, x >= 1 && x < 4 && y >= 1 && y < 4) << x << "," << y;
}

TEST(UvRaster, AFanAroundATexelCentreCoversItOnce)
{
    for (int spokes : { 3, 4, 5, 7, 8, 16, 61 })
        for (double cx : { 10.0, 10.5 })
            for (double turn : { 0.0, 0.1, M_PI / 4 }) {
                Flat flat(21, 21);
                const uint32_t centre = flat.vertex(cx, cx);
                for (int i = 0; i < spokes; ++i) {
                    const double angle = turn + 2 * M_PI * i / spokes;
                    flat.vertex(cx + 8 * std::cos(angle), cx + 8 * std::sin(angle));
                }
                for (int i = 0; i < spokes; ++i)
                    flat.triangle(centre, uint32_t(1 + i), uint32_t(1 + (i + 1) % spokes));
                const Cover cover(flat);
                EXPECT_EQ(cover.overlapping, 0) << spokes;
                EXPECT_NE(cover.at(10, 10), TileCover::kNone) << spokes;
                const double inside = 8 * std::cos(M_PI / spokes) - 0.1;
                for (int y = 0; y < 21; ++y)
                    for (int x = 0; x < 21; ++x) {
                        const bool in = std::hypot(x + 0.5 - cx, y + 0.5 - cx) < inside;
                        EXPECT_TRUE(!in || cover.at(x, y) != TileCover::kNone) << x << "," << y;
                    }
            }
}

TEST(UvRaster, AnyTessellationOfTheTextureCoversEachTexelOnce)
{
    std::mt19937 random(11);
    for (const auto& [width, height] : { std::pair(64, 64), { 1, 1 }, { 7, 130 }, { 200, 65 }, { 129, 3 }, { 97, 97 } })
        for (int run = 0; run < 6; ++run) {
            // A grid with its inner vertices moved, half of them onto texel centres, diagonals at random.
            Flat flat(width, height);
            const int n = 1 + int(random() % 40);
            std::uniform_real_distribution<double> shift(-0.4, 0.4);
            for (int j = 0; j <= n; ++j)
                for (int i = 0; i <= n; ++i) {
                    double x = width * double(i) / n, y = height * double(j) / n;
                    if (i > 0 && i < n && j > 0 && j < n) {
                        x += shift(random) * width / n / 2, y += shift(random) * height / n / 2;
                        // Only where rounding keeps the cells whole.
                        if (random() % 2 && n < std::min(width, height) / 4)
                            x = std::floor(x) + 0.5, y = std::floor(y) + 0.5;
                    }
                    flat.vertex(x, y);
                }
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i) {
                    const uint32_t a = uint32_t(j * (n + 1) + i), b = a + 1, c = a + uint32_t(n) + 1, d = c + 1;
                    if (random() % 2)
                        flat.triangle(a, c, d), flat.triangle(a, d, b);
                    else
                        flat.triangle(a, c, b), flat.triangle(b, c, d);
                }
            SCOPED_TRACE(testing::Message() << width << "x" << height << ", " << n);
            expect_each_texel_once(flat, int64_t(width) * height);
        }
}

TEST(UvRaster, WeightsFindTheTexelCentre)
{
    for (bool mirrored : { false, true }) {
        Flat flat(100, 70);
        const uint32_t a = flat.vertex(3.3, 60.1), b = flat.vertex(95.7, 33.2), c = flat.vertex(40, 1.6);
        mirrored ? flat.triangle(a, c, b) : flat.triangle(a, b, c);
        const Cover cover(flat);
        EXPECT_EQ(cover.raster.report().mirrored, mirrored);
        EXPECT_GT(cover.covered, 1000);
        for (int y = 0; y < 70; ++y)
            for (int x = 0; x < 100; ++x) {
                if (cover.at(x, y) == TileCover::kNone)
                    continue;
                const double w1 = cover.weight1[size_t(y * 100 + x)], w2 = cover.weight2[size_t(y * 100 + x)];
                EXPECT_GE(w1, 0);
                EXPECT_GE(w2, 0);
                EXPECT_LE(w1 + w2, 1 + 1e-6);
                const auto& t = flat.mesh.triangles[0];
                const V3d p = flat.mesh.positions[t[0]] * (1 - w1 - w2) + flat.mesh.positions[t[1]] * w1
                    + flat.mesh.positions[t[2]] * w2;
                EXPECT_NEAR(p.x, x + 0.5, 1.0 / 256); // texture coordinates are rounded to 1/256 of a texel
                EXPECT_NEAR(-p.y, y + 0.5, 1.0 / 256);
            }
    }
}

TEST(UvRaster, TheFirstTriangleWinsAndOverlapIsCountedOnce)
{
    Flat flat(70, 70);
    const uint32_t a = flat.vertex(0, 0), b = flat.vertex(0, 70), c = flat.vertex(70, 70), d = flat.vertex(70, 0);
    flat.triangle(a, b, c); // lower left
    flat.triangle(b, c, d); // lower right
    flat.triangle(a, b, d); // upper left
    flat.triangle(a, b, d); // again
    const Cover cover(flat);
    EXPECT_EQ(cover.at(1, 60), 0u);
    EXPECT_EQ(cover.at(20, 69), 0u);
    EXPECT_EQ(cover.at(69, 20), 1u);
    EXPECT_EQ(cover.at(20, 1), 2u);
    EXPECT_EQ(cover.at(35, 0), 2u);
    EXPECT_EQ(cover.covered, 70 * 70);
    // Only the right quarter is covered once, by triangle 1; all else at least twice.
    int64_t once = 0;
    for (int y = 0; y < 70; ++y)
        for (int x = 0; x < 70; ++x)
            once += cover.at(x, y) == 1;
    EXPECT_NEAR(double(once), 70 * 70 / 4, 40);
    EXPECT_EQ(cover.overlapping, 70 * 70 - once);
}

TEST(UvRaster, TheReportTellsTheHealthOfTextureCoordinates)
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

TEST(UvRaster, ATileOfMovedCoordinatesIsCoveredAsTheFirstWasBeforeToTheLastBit)
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

TEST(UvRaster, TrianglesOfOtherTilesAreToldFromThoseThatReachOver)
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

TEST(UvRaster, TrianglesFarOutsideStillCoverWhatTheyReach)
{
    // From ten thousand textures away, on both sides: exact all the same.
    Flat flat(50, 50);
    const uint32_t a = flat.vertex(-5e5, 25.5), b = flat.vertex(5e5, 25.5), c = flat.vertex(25, 7e5),
                   d = flat.vertex(25, -7e5);
    flat.triangle(a, c, b);
    flat.triangle(a, b, d);
    expect_each_texel_once(flat, 2500);
}

TEST(UvRaster, TrianglesOfNoTextureAreaCoverNothing)
{
    Flat flat(16, 16);
    const uint32_t a = flat.vertex(0.5, 0.5), b = flat.vertex(15.5, 15.5), c = flat.vertex(8.5, 8.5);
    flat.triangle(a, b, c);
    flat.mesh.positions[c] = V3d(0, 5, 0);
    const Cover cover(flat);
    EXPECT_EQ(cover.covered, 0);
    EXPECT_EQ(cover.raster.report().degenerate_uv, 1);
}
