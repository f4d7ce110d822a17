// SPDX-License-Identifier: Apache-2.0
// Which texels a triangle is baked to: the way up, mirrored charts, overlap, the tile's border, the margin.
#include "baked_map.h"
#include "scenes.h"

using namespace vmlight;
using namespace vmlight::scenes;

TEST(Vismap, RowZeroIsTheTopOfTheTexture)
{
    // u grows with x, v with y; the wall stands at y = 1, beyond v = 1.
    const Mesh wall = rectangle(V3d(-10, 1.001, 0), V3d(20, 0, 0), V3d(0, 0, 0.5));
    const BakedMap map(floor_facing_z(1), { wall }, map_params(4, 16, 1024));
    for (int x = 0; x < 4; ++x)
        for (int y = 0; y + 1 < 16; ++y) {
            EXPECT_LT(map.at(x, y).visibility, map.at(x, y + 1).visibility + 0.004) << y;
            EXPECT_LT(map.at(x, y).direction.y, 0);
        }
    EXPECT_LT(map.at(0, 0).visibility, 0.6);
    EXPECT_GT(map.at(0, 15).visibility, 0.95);
}

TEST(Vismap, AMirroredChartKeepsTheNormalsSide)
{
    const Mesh mesh = floor_facing_z(1);
    Mesh mirrored = mesh;
    for (V2f& uv : mirrored.uvs)
        uv.x = 1 - uv.x;
    const BakedMap map(mesh, { wall_at_x1() }, map_params(16, 16, 256));
    const BakedMap other(mirrored, { wall_at_x1() }, map_params(16, 16, 256));
    EXPECT_EQ(map.report.uv.mirrored, 0);
    EXPECT_EQ(other.report.uv.mirrored, 2);
    EXPECT_EQ(other.report.covered, 256);
    other.each([&](const Texel& t, int x, int y) {
        EXPECT_NEAR(t.visibility, map.at(15 - x, y).visibility, 0.05);
        EXPECT_LT((t.direction - map.at(15 - x, y).direction).length(), 0.05);
        EXPECT_GT(t.direction.z, 0.3);
    });
}

TEST(Vismap, WhatLiesOutsideTheTextureIsNotBaked)
{
    Mesh mesh = floor_facing_z(1);
    for (V2f& uv : mesh.uvs)
        uv = V2f(uv.x + 0.5f, uv.y - 0.25f);
    const BakedMap map(mesh, {}, map_params(16, 16, 4));
    EXPECT_EQ(map.report.uv.outside, 2);
    EXPECT_EQ(map.report.covered, 8 * 12);
    map.each([](const Texel& t, int x, int y) { EXPECT_EQ(t.visibility, x >= 8 && y >= 4 ? 1 : 0) << x << "," << y; });
    for (V2f& uv : mesh.uvs)
        uv.x += 1;
    EXPECT_EQ(BakedMap(mesh, {}, map_params(16, 16, 4)).report.covered, 0);
}

TEST(Vismap, WhereTrianglesOverlapTheFirstWins)
{
    // Three floors at different heights over the same texture; the later ones hide the first.
    Mesh mesh = floor_facing_z(1, V3d(0, 0, 0));
    append(mesh, floor_facing_z(1, V3d(0, 0, 1e-2)));
    for (size_t v = 4; v < 8; ++v)
        mesh.uvs[v].x *= 0.5f;
    append(mesh, floor_facing_z(1, V3d(0, 0, 2e-2)));
    for (size_t v = 8; v < 12; ++v)
        mesh.uvs[v].x *= 0.25f;
    const BakedMap map(mesh, {}, map_params(16, 16, 64));
    EXPECT_EQ(map.report.covered, 256);
    EXPECT_EQ(map.report.overlapping, 128); // once each, though half of them is hit three times
    map.each([](const Texel& t, int, int) { EXPECT_LT(t.visibility, 0.2); });

    std::swap(mesh.triangles[0], mesh.triangles[4]);
    std::swap(mesh.triangles[1], mesh.triangles[5]);
    BakedMap(mesh, {}, map_params(16, 16, 64)).each([](const Texel& t, int x, int) {
        if (x < 4)
            EXPECT_EQ(t.visibility, 1);
        else
            EXPECT_LT(t.visibility, 0.2);
    });
}

TEST(Vismap, TrianglesWithoutTextureCoordinatesCastAndAreNotBaked)
{
    Mesh mesh = floor_facing_z(1);
    append(mesh, wall_at_x1()); // its uvs are NaN
    const BakedMap map(mesh, {}, map_params(8, 8, 256));
    EXPECT_EQ(map.report.uv.triangles, 4);
    EXPECT_EQ(map.report.uv.without_uv, 2);
    EXPECT_EQ(map.report.covered, 64);
    map.each([](const Texel& t, int, int) { EXPECT_NEAR(t.visibility, 0.5, 0.05); });
}

TEST(Vismap, TheMarginIsFilledAndCoverageTellsItApart)
{
    Mesh mesh = floor_facing_z(1);
    for (V2f& uv : mesh.uvs)
        uv = V2f(0.25f, 0.25f) + uv * 0.5f;
    VismapParams params = map_params(32, 32, 16);
    params.margin = 2;
    const BakedMap map(mesh, {}, params);
    EXPECT_EQ(map.report.covered, 256);
    int covered = 0;
    map.each_covered([&](const Texel&, int, int) { ++covered; });
    EXPECT_EQ(covered, 256);
    map.each([](const Texel& t, int x, int y) {
        const bool filled = x >= 6 && x < 26 && y >= 6 && y < 26;
        EXPECT_EQ(t.visibility, filled ? 1 : 0) << x << "," << y;
        EXPECT_NEAR(t.direction.z, filled ? 2.0 / 3 : 0, 1e-6);
    });
    params.margin = -1;
    BakedMap(mesh, {}, params).each([](const Texel& t, int, int) { EXPECT_EQ(t.visibility, 1); });
}
