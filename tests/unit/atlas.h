// SPDX-License-Identifier: Apache-2.0
/// What holds for every atlas, and meshes that are hard to lay flat.
#pragma once

#include "scenes.h"

#include <vmlight/uv/raster.h>
#include <vmlight/uv/unwrap.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <string>
#include <vector>

namespace vmlight {

inline UnwrapParams atlas_params(int size, int margin, int nthreads = 0)
{
    return { size, size, margin, nthreads };
}

/// For each triangle, a number of its chart: triangles that share a UV are of one.
inline std::vector<uint32_t> charts_of(const Mesh& mesh)
{
    std::vector<uint32_t> parents(mesh.triangles.size());
    std::iota(parents.begin(), parents.end(), 0u);
    const auto root = [&](uint32_t t) {
        while (parents[t] != t)
            t = parents[t] = parents[parents[t]];
        return t;
    };
    std::map<std::pair<float, float>, uint32_t> triangle_at;
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (uint32_t vertex : mesh.triangles[t]) {
            const Imath::V2f& uv = mesh.uvs[vertex];
            const auto [at, is_new] = triangle_at.emplace(std::pair(uv.x, uv.y), t);
            if (!is_new)
                parents[root(at->second)] = root(t);
        }
    std::vector<uint32_t> charts;
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
        charts.push_back(root(t));
    return charts;
}

/// The triangle of each texel, row by row from v = 1 down, or TileCover::kNone; and how many have several.
struct AtlasTexels
{
    AtlasTexels(const Mesh& mesh, int w, int h)
        : width(w)
        , height(h)
        , triangle(size_t(w) * size_t(h), TileCover::kNone)
    {
        const UvRaster raster(mesh, w, h);
        uv = raster.report();
        TileCover tile;
        for (int t = 0; t < raster.tiles_across() * raster.tiles_down(); ++t) {
            raster.cover(t, tile);
            covered += tile.covered;
            overlapping += tile.overlapping;
            for (int i = 0; i < kTileSize * kTileSize; ++i) {
                const int x = t % raster.tiles_across() * kTileSize + i % kTileSize;
                const int y = t / raster.tiles_across() * kTileSize + i / kTileSize;
                if (x < w && y < h)
                    triangle[size_t(y) * size_t(w) + size_t(x)] = tile.triangle[size_t(i)];
            }
        }
    }

    int width, height;
    UvReport uv;
    int64_t covered = 0, overlapping = 0;
    std::vector<uint32_t> triangle;
};

/// Texels of a chart within `margin` texels, along both axes, of one of another chart.
inline int64_t texels_in_margins(const AtlasTexels& texels, const std::vector<uint32_t>& charts, int margin)
{
    // The least and the greatest chart around each texel, first in rows, then in columns.
    struct Span
    {
        uint32_t least = ~0u, greatest = 0;
        void add(const Span& other)
        {
            least = std::min(least, other.least);
            greatest = std::max(greatest, other.greatest);
        }
    };
    const int w = texels.width, h = texels.height;
    const auto at = [&](int x, int y) { return size_t(y) * size_t(w) + size_t(x); };
    std::vector<Span> own(texels.triangle.size()), rows(own), all(own);
    for (size_t i = 0; i < own.size(); ++i)
        if (texels.triangle[i] != TileCover::kNone)
            own[i] = { charts[texels.triangle[i]], charts[texels.triangle[i]] };
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x)
            for (int n = std::max(0, x - margin); n <= std::min(w - 1, x + margin); ++n)
                rows[at(x, y)].add(own[at(n, y)]);
    int64_t count = 0;
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            for (int n = std::max(0, y - margin); n <= std::min(h - 1, y + margin); ++n)
                all[at(x, y)].add(rows[at(x, n)]);
            count += own[at(x, y)].least != ~0u && all[at(x, y)].least != all[at(x, y)].greatest;
        }
    return count;
}

inline double uv_area(const Mesh& mesh, size_t t)
{
    const Imath::V2d a(mesh.uvs[mesh.triangles[t][0]]), b(mesh.uvs[mesh.triangles[t][1]]),
        c(mesh.uvs[mesh.triangles[t][2]]);
    return (b - a).cross(c - a) / 2;
}

inline double space_area(const Mesh& mesh, size_t t)
{
    return triangle_area_normal(mesh, mesh.triangles[t]).length() / 2;
}

/// Unwraps `mesh`, and expects what must hold of every atlas.
/// @param flat     triangles that may have no area in UV
inline Mesh expect_atlas(Mesh mesh, const UnwrapParams& params, UnwrapReport* report = nullptr, int64_t flat = 0)
{
    const Mesh before = mesh;
    UnwrapReport counts;
    std::string error;
    EXPECT_TRUE(unwrap_mesh(mesh, params, &counts, error)) << error;
    if (report)
        *report = counts;
    if (!error.empty())
        return before;
    // The same triangles.
    EXPECT_EQ(mesh.triangles.size(), before.triangles.size());
    EXPECT_EQ(mesh.triangle_materials, before.triangle_materials);
    EXPECT_EQ(mesh.triangle_nodes, before.triangle_nodes);
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const uint32_t now = mesh.triangles[t][size_t(k)], then = before.triangles[t][size_t(k)];
            EXPECT_EQ(mesh.positions[now], before.positions[then]);
            EXPECT_EQ(mesh.normals[now], before.normals[then]);
        }
    // In the map; none mirrored, and, with an area in space, none without one.
    for (const Imath::V2f& uv : mesh.uvs)
        EXPECT_TRUE(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1) << uv;
    int64_t lost = 0;
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
        lost += space_area(mesh, t) > 0 && !(uv_area(mesh, t) > 0);
    EXPECT_LE(lost, flat);
    EXPECT_EQ(lost, counts.too_thin);
    // Nothing overlaps, in the map or closer up, and no margin has texels of another chart.
    const std::vector<uint32_t> charts = charts_of(mesh);
    const AtlasTexels texels(mesh, params.width, params.height);
    EXPECT_EQ(texels.overlapping, 0);
    EXPECT_EQ(AtlasTexels(mesh, 4 * params.width, 4 * params.height).overlapping, 0);
    EXPECT_EQ(texels_in_margins(texels, charts, params.margin), 0);
    // One density: texels for an area in space.
    std::map<uint32_t, std::pair<double, double>> areas;
    double covered = 0;
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
        if (space_area(mesh, t) > 0) {
            areas[charts[t]].first += uv_area(mesh, t);
            areas[charts[t]].second += space_area(mesh, t);
            covered += uv_area(mesh, t);
        }
    EXPECT_EQ(int64_t(areas.size()), counts.charts);
    EXPECT_NEAR(counts.coverage, covered, 1e-9);
    const double texels_in_all = double(params.width) * params.height;
    for (const auto& [chart, area] : areas) {
        const double expected = area.second * counts.density * counts.density / texels_in_all;
        EXPECT_NEAR(area.first, expected, 0.01 * expected + 1e-6 * std::sqrt(expected) + 1e-13) << "chart " << chart;
    }
    EXPECT_GE(counts.stretch, 1 - 1e-9);
    return mesh;
}

namespace scenes {

/// A square sheet of n x n squares whose heights are `height(i, j)`; normals point up z.
template <class Height> Mesh sheet(int n, Height&& height)
{
    Mesh mesh;
    mesh.name = "sheet";
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            mesh.positions.push_back(V3d(double(i) / n, double(j) / n, height(i, j)));
            mesh.normals.push_back(V3f(0, 0, 1));
        }
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const uint32_t a = uint32_t(j * (n + 1) + i), b = a + uint32_t(n) + 1;
            mesh.triangles.push_back({ a, a + 1, b + 1 });
            mesh.triangles.push_back({ a, b + 1, b });
        }
    mesh.triangle_materials.assign(mesh.triangles.size(), 0);
    return mesh;
}

/// A strip around the z axis: at column i of `columns`, from `low(i)` to `high(i)`.
template <class Point> Mesh strip(int columns, Point&& point)
{
    Mesh mesh;
    mesh.name = "strip";
    for (int i = 0; i <= columns; ++i)
        for (int side = 0; side < 2; ++side) {
            mesh.positions.push_back(point(i, side));
            mesh.normals.push_back(V3f(0, 0, 1));
        }
    for (uint32_t i = 0; i < uint32_t(columns); ++i) {
        mesh.triangles.push_back({ 2 * i, 2 * i + 1, 2 * i + 3 });
        mesh.triangles.push_back({ 2 * i, 2 * i + 3, 2 * i + 2 });
    }
    mesh.triangle_materials.assign(mesh.triangles.size(), 0);
    return mesh;
}

/// A ramp that winds three times around the z axis, above itself.
inline Mesh ramp()
{
    return strip(96, [](int i, int side) {
        const double angle = i * 2 * M_PI / 32, radius = side == 0 ? 2 : 1;
        return V3d(radius * std::cos(angle), -radius * std::sin(angle), 0.02 * i);
    });
}

inline Mesh moebius()
{
    const int columns = 48;
    return strip(columns, [](int i, int side) {
        const int turns = i == columns ? 0 : i; // the last column is the first, turned over
        const double angle = turns * 2 * M_PI / columns, half = angle / 2;
        const double reach = ((side == 0) != (i == columns) ? 0.3 : -0.3);
        const double radius = 1 + reach * std::cos(half);
        return V3d(radius * std::cos(angle), radius * std::sin(angle), reach * std::sin(half));
    });
}

/// A sheet crumpled at random.
inline Mesh crumpled(int n, double height)
{
    std::mt19937 random(7);
    return sheet(n, [&](int, int) { return height * (double(random()) / 4294967295.0 - 0.5); });
}

} // namespace scenes
} // namespace vmlight
