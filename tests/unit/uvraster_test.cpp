// SPDX-License-Identifier: Apache-2.0
#include "flat_mesh.h"

#include <vmlight/uv/raster_edges.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

using namespace vmlight;
using namespace vmlight::flat_mesh;

TEST(UvRaster, RoundsAsTheStandardLibrary)
{
    std::vector<double> numbers {
        0.49999999999999994, 4503599627370495.5, 4503599627370497.5, 1e300, 1e16, 536870911.5
    };
    for (int i = 0; i < 2000; ++i)
        numbers.insert(numbers.end(), { i * 0.25, std::nextafter(i * 0.25, 0), std::nextafter(i * 0.25, 1e9) });
    for (const double magnitude : numbers)
        for (const double number : { magnitude, -magnitude }) {
            EXPECT_EQ(rounded(number), std::round(number)) << number;
            if (magnitude < 4e15) {
                EXPECT_EQ(rounded_subtexel(number), std::llround(number)) << number;
            }
        }
    EXPECT_TRUE(std::isnan(rounded(NAN)));
    EXPECT_EQ(rounded(-INFINITY), -INFINITY);
}

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
