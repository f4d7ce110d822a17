// SPDX-License-Identifier: Apache-2.0
/// Patches: small blocks of a map's texels, which light other texels as one.
#pragma once

#include <vmlight/trace/bake_scene.h>
#include <vmlight/vismap/map_points.h>

#include <Imath/ImathVec.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vmlight {

/// A patch is what one UV island covers of a square block of texels.
class MapPatches
{
public:
    static constexpr uint32_t kNone = ~0u;

    explicit MapPatches(const MapPoints& map);

    /// Texels on a side of the blocks.
    int block() const { return m_block; }

    /// Add the texels of a tile, once. Any thread.
    void add(int tile, const std::vector<MapPoint>& points);
    /// After all tiles.
    void number();

    uint32_t count() const { return uint32_t(m_islands.size()); }
    /// The patch of a texel, by its index in the map; kNone where no triangle covers it.
    uint32_t of_texel(size_t texel) const { return m_patch_of_texel[texel]; }
    /// The number in the baked mesh of a triangle of BakeScene::whole(); kNone where that is of another part.
    uint32_t baked_triangle(uint32_t triangle) const
    {
        return m_baked_triangle.empty() ? triangle : m_baked_triangle[triangle];
    }
    /// The patch at a point of a triangle of BakeScene::whole(), where u and v weigh its second and third corners: that
    /// of the texel there, or of the nearest of its eight neighbours, if it is of the same UV island. kNone if none is:
    /// the map does not have the point.
    uint32_t find(uint32_t triangle, float u, float v) const;
    /// Set `dst` to the mean of `rgb`, three floats a texel, over each patch.
    void average(Imath::V3f* dst, const float* rgb, int nthreads) const;

    size_t bytes() const;

private:
    struct Tile
    {
        std::vector<uint32_t> islands; // of its patches
        uint32_t first = 0; // number of the first
    };

    const MapPoints& m_map;
    int m_block;
    std::vector<uint32_t> m_baked_triangle; // of whole's; empty: its own
    std::vector<uint32_t> m_island_of_triangle; // of the baked mesh
    std::vector<uint32_t> m_patch_of_texel, m_islands;
    std::vector<Tile> m_tiles;
};

} // namespace vmlight
