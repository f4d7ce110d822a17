// SPDX-License-Identifier: Apache-2.0
// Polygons cut into triangles.
#include <vmlight/mesh/import/polygons.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace vmlight;
using Imath::V3d;

namespace {

struct Triangles
{
    std::vector<size_t> polygons;
    double area = 0;
};

Triangles triangulated(const std::vector<std::vector<V3d>>& polygons, bool is_far = false)
{
    std::vector<V3d> corners;
    std::vector<uint32_t> ends;
    for (const auto& polygon : polygons) {
        corners.insert(corners.end(), polygon.begin(), polygon.end());
        ends.push_back(uint32_t(corners.size()));
    }
    Triangles result;
    std::string error;
    EXPECT_TRUE(visit_triangles(
        ends, [&](uint32_t corner) { return corners[corner]; }, is_far,
        [&](size_t polygon, const std::array<uint32_t, 3>& c) {
            result.polygons.push_back(polygon);
            for (const uint32_t corner : c)
                EXPECT_TRUE(corner < ends[polygon] && (polygon == 0 || corner >= ends[polygon - 1]));
            result.area += (corners[c[1]] - corners[c[0]]).cross(corners[c[2]] - corners[c[0]]).z / 2;
        },
        error))
        << error;
    return result;
}

// An L of area 7, and a square of area 1.
std::vector<V3d> l_shape(double size = 1, const V3d& at = V3d(0))
{
    std::vector<V3d> corners;
    for (const auto& [x, y] : { std::pair(0, 0), { 4, 0 }, { 4, 1 }, { 1, 1 }, { 1, 4 }, { 0, 4 } })
        corners.push_back(at + V3d(x, y, 0) * size);
    return corners;
}

const std::vector<V3d> kSquare { V3d(0), V3d(1, 0, 0), V3d(1, 1, 0), V3d(0, 1, 0) };
const std::vector<V3d> kOneTriangle { V3d(0), V3d(1, 0, 0), V3d(0, 1, 0) };

} // namespace

TEST(Polygons, AreCutInTheirOrder)
{
    const Triangles mixed
        = triangulated({ kOneTriangle, kSquare, { V3d(0), V3d(1) }, kOneTriangle, l_shape(), {}, kOneTriangle });
    EXPECT_EQ(mixed.polygons, (std::vector<size_t> { 0, 1, 1, 3, 4, 4, 4, 4, 6 }));
    EXPECT_NEAR(mixed.area, 3 * 0.5 + 1 + 7, 1e-12);
    EXPECT_TRUE(triangulated({}).polygons.empty());
    EXPECT_TRUE(triangulated({ {}, { V3d(1) } }).polygons.empty());
}

TEST(Polygons, AreManyMoreThanOneBatch)
{
    std::vector<std::vector<V3d>> polygons;
    for (int i = 0; i < 150000; ++i)
        polygons.push_back(i % 3 == 0 ? kOneTriangle : kSquare);
    const Triangles many = triangulated(polygons);
    EXPECT_EQ(many.polygons.size(), 50000u + 2 * 100000u);
    EXPECT_TRUE(std::is_sorted(many.polygons.begin(), many.polygons.end()));
    EXPECT_EQ(many.area, 50000 * 0.5 + 100000);
}

TEST(Polygons, KeepTheirShapeFarAwayAndBesideOthersOfAnySize)
{
    const Triangles far = triangulated({ l_shape(1, V3d(1e9, -1e9, 1e9)), kSquare }, true);
    EXPECT_EQ(far.polygons.size(), 6u);
    EXPECT_EQ(far.area, 8);
    EXPECT_EQ(triangulated({ l_shape(1e-30), l_shape(1e30) }).polygons.size(), 8u);
}

TEST(Polygons, ThatAreNotFiniteAreTheBuildersToRefuse)
{
    std::vector<V3d> bad = l_shape();
    bad[3].x = NAN;
    EXPECT_EQ(triangulated({ bad, kOneTriangle }).polygons, (std::vector<size_t> { 0, 0, 0, 0, 1 }));
}
