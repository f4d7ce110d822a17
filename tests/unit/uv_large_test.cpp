// SPDX-License-Identifier: Apache-2.0
// Meshes of so many triangles that several threads sort them into tiles and islands: the same as one thread does.
#include "flat_mesh.h"
#include "thread_count.h"

#include <vmlight/base/parallel_blocks.h>
#include <vmlight/uv/islands.h>

using namespace vmlight;
using namespace vmlight::flat_mesh;

namespace {

constexpr int kQuads = 200; // of a square, in a row; a texel each

void add_square(Flat& flat, int left)
{
    const auto first = uint32_t(flat.mesh.positions.size());
    for (int y = 0; y <= kQuads; ++y)
        for (int x = 0; x <= kQuads; ++x)
            flat.vertex(left + x, y);
    for (int y = 0; y < kQuads; ++y)
        for (int x = 0; x < kQuads; ++x) {
            const uint32_t a = first + uint32_t(y * (kQuads + 1) + x), b = a + kQuads + 1;
            flat.triangle(a, b, b + 1);
            flat.triangle(a, b + 1, a + 1);
        }
}

// Two squares, a triangle over the first, one partly outside, and one too thin for a texel.
Flat large_mesh()
{
    Flat flat(512, 256);
    add_square(flat, 0);
    add_square(flat, 256);
    flat.triangle(flat.vertex(0.25, 0.25), flat.vertex(0.25, 20.25), flat.vertex(20.25, 0.25));
    flat.triangle(flat.vertex(500, 250), flat.vertex(500, 270), flat.vertex(520, 250));
    flat.triangle(flat.vertex(230.1, 0.1), flat.vertex(230.1, 0.2), flat.vertex(230.2, 0.1));
    return flat;
}

} // namespace

TEST(UvLarge, IsTheSameForAnyNumberOfThreads)
{
    const Flat flat = large_mesh();
    const size_t triangles = flat.mesh.triangles.size();
    ASSERT_GT(triangles, 2 * kElementsOfBlock);
    std::vector<uint32_t> owner;
    for (const int threads : { 1, 3 }) {
        SCOPED_TRACE(threads);
        const ThreadCount scope(threads);
        const Cover cover(flat);
        for (int y = 0; y < kQuads; ++y)
            for (int x = 0; x < kQuads; ++x)
                for (const int square : { 0, 1 }) {
                    const auto quad = uint32_t((square * kQuads + y) * kQuads + x);
                    ASSERT_EQ(cover.at(square * 256 + x, y) / 2, quad) << "the first triangle wins";
                }
        EXPECT_EQ(cover.overlapping, 210) << "centres (x + .5, y + .5) with x + y below 19.5";
        EXPECT_TRUE(owner.empty() || owner == cover.owner);
        owner = cover.owner;

        UvReport report = cover.raster.report();
        EXPECT_EQ(report.triangles, int64_t(triangles));
        EXPECT_EQ(report.outside, 1);
        EXPECT_EQ(report.fully_outside, 0);
        count_islands(report, flat.mesh, cover.raster);
        EXPECT_EQ(report.islands, 5);
        EXPECT_EQ(report.uncovered_islands, 1);
        EXPECT_EQ(report.uncovered_triangles, 1);

        const std::vector<uint32_t> islands = islands_of_triangles(flat.mesh);
        for (size_t t = 0; t < triangles; ++t)
            ASSERT_EQ(islands[t] == islands[0], t < 2 * kQuads * kQuads) << t;
    }
}
