// SPDX-License-Identifier: Apache-2.0
// Surfaces that are hard to lay flat.
#include "atlas.h"
#include "hard_case.h"

using namespace vmlight;
using namespace vmlight::scenes;

TEST(Uv, ARampThatWindsAroundItself)
{
    HardCase row("Unwrapping a ramp of three turns, all of it within 10 degrees of level");
    row.naive("one chart by its normals, which covers the texels three times");
    UnwrapReport report;
    expect_atlas(ramp(), atlas_params(256, 2), &report);
    EXPECT_GE(report.charts, 3);
    EXPECT_LT(report.stretch, 1.01);
    row.ours("divided until no border crosses another: no texel twice");
}

TEST(Uv, ACrumpledSheet)
{
    HardCase row("Unwrapping a sheet crumpled at random, its slopes up to 85 degrees");
    row.naive("projected, or by least squares without a check, triangles fold over: mirrored, and texels twice");
    for (double height : { 0.02, 0.1, 0.5, 3.0 })
        expect_atlas(crumpled(24, height), atlas_params(512, 2));
    row.ours("charts are divided until none folds");
}

TEST(Uv, MarginsOfCharts)
{
    HardCase row("Unwrapping into maps of 64 to 512 texels, with margins of 1 to 32");
    row.naive("a gap that is a share of the map is too few texels in a small one: the margin of a chart is another's");
    for (const auto& [size, margin] :
         { std::pair(64, 1), std::pair(128, 3), std::pair(256, 8), std::pair(512, 17), std::pair(512, 32) })
        expect_atlas(box(V3d(-1), V3d(1, 2, 3), false), atlas_params(size, margin));
    row.ours("as many texels as the bake fills are free around each chart");
}

TEST(Uv, SurfacesThatAreNone)
{
    HardCase row("Unwrapping a Moebius strip, a fan of triangles at one edge, faces three times, slivers, points",
                 "xatlas#54: freezes, NaN");
    row.naive("half-edges that assume two triangles an edge, and one side: endless loops, reads out of bounds");
    expect_atlas(moebius(), atlas_params(256, 2));
    Mesh fan;
    fan.name = "fan";
    fan.positions = { V3d(0), V3d(0, 0, 1) };
    for (int i = 0; i < 9; ++i) {
        fan.positions.push_back(V3d(std::cos(i), std::sin(i), 0.5));
        const std::array<uint32_t, 3> triangle { 0, 1, uint32_t(2 + i) };
        fan.triangles.insert(fan.triangles.end(), { triangle, triangle, { triangle[1], triangle[0], triangle[2] } });
    }
    fan.normals.assign(fan.positions.size(), V3f(0, 0, 1));
    fan.triangle_materials.assign(fan.triangles.size(), 0);
    expect_atlas(fan, atlas_params(256, 1));

    // A needle, a point and a sliver among others.
    Mesh damaged = sheet(4, [](int i, int) { return 0.1 * i; });
    const uint32_t next = uint32_t(damaged.positions.size());
    damaged.positions.push_back(V3d(2, 0, 0));
    damaged.positions.push_back(V3d(3, 0, 0));
    damaged.positions.push_back(V3d(2.5, 1e-4, 0));
    damaged.normals.resize(damaged.positions.size(), V3f(0, 0, 1));
    damaged.triangles.push_back({ 0, 1, 0 });
    damaged.triangles.push_back({ 0, 0, 0 });
    damaged.triangles.push_back({ next, next + 1, next + 2 });
    damaged.triangle_materials.assign(damaged.triangles.size(), 0);
    UnwrapReport report;
    expect_atlas(damaged, atlas_params(256, 2), &report);
    EXPECT_EQ(report.without_area, 2);
    row.ours("each triangle with an area has one in the atlas, once; the others are counted, with a warning");
}
