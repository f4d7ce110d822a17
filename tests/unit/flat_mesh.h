// SPDX-License-Identifier: Apache-2.0
/// Meshes given by texture coordinates, and which texels they cover.
#pragma once

#include <vmlight/mesh/mesh.h>
#include <vmlight/uv/raster.h>

#include <gtest/gtest.h>

#include <vector>

namespace vmlight::flat_mesh {

using Imath::V2f;
using Imath::V3d;
using Imath::V3f;

/// A mesh from texture coordinates alone, given in texels with y down; z is a function of them, so that it has area.
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

/// All tiles together.
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

inline void expect_each_texel_once(const Flat& flat, int64_t texels)
{
    const Cover cover(flat);
    EXPECT_EQ(cover.covered, texels);
    EXPECT_EQ(cover.overlapping, 0);
}

} // namespace vmlight::flat_mesh
