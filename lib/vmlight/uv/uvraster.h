// SPDX-License-Identifier: Apache-2.0
/// Which texels a mesh covers in texture space: texel centres, the top-left rule, exact integers.
#pragma once

#include <vmlight/base/tile_size.h>
#include <vmlight/mesh/mesh.h>
#include <vmlight/uv/report.h>
#include <vmlight/uv/udim.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vmlight {

struct UvCorner;

/// The texels of one tile: which triangle owns each, and where in it.
struct TileCover
{
    static constexpr uint32_t kNone = ~0u;
    /// Of the texel at (x, y) of the tile, at index y * kTileSize + x: its triangle, or kNone.
    std::array<uint32_t, kTileSize * kTileSize> triangle;
    /// Its weights of the triangle's second and third corners; the first has the rest.
    std::array<float, kTileSize * kTileSize> weight1, weight2;
    int64_t covered = 0;
    int64_t overlapping = 0; ///< texels that more than one triangle covers
};

/// A mesh over a texture of width x height texels, which is one UDIM tile: row 0 is its top (v = 1 for 1001), texel
/// centres at (i + 0.5) / n. A tile's place in uv is subtracted exactly: a mesh whose uvs were moved by whole tiles
/// without rounding covers the same texels of the tile it was moved to, with the same weights.
/// Coordinates are rounded to 1/256 of a texel and all tests are exact, so that a texel on a shared edge goes to
/// exactly one of the two triangles. Where triangles overlap, the lowest triangle index wins.
class UvRaster
{
public:
    /// Not checked: that the mesh has uvs.
    UvRaster(const Mesh& mesh, int width, int height, int udim = kFirstUdim);

    int tiles_across() const { return (m_width + kTileSize - 1) / kTileSize; }
    int tiles_down() const { return (m_height + kTileSize - 1) / kTileSize; }
    const UvReport& report() const { return m_report; }

    /// Has the triangle an area in space and a part in this UDIM tile?
    bool is_here(size_t triangle) const;
    /// Does the triangle cover a texel, if it alone is drawn? At most height divisions.
    bool covers_any(size_t triangle) const;

    /// Cover tile number `tile` (row by row). Independent of other tiles; any thread.
    void cover(int tile, TileCover& dst) const;

private:
    struct Bounds;
    Imath::V2d place_of(size_t triangle, int corner) const;
    Imath::V2d size() const;
    Bounds bounds_of(size_t triangle) const;
    bool corners(size_t triangle, std::array<UvCorner, 3>& dst) const;
    void count_outside(size_t triangle);
    template <class Visit> void each_tile(const std::array<UvCorner, 3>& corners, Visit&& visit) const;

    const Mesh& m_mesh;
    int m_width, m_height;
    Imath::V2d m_corner;
    UvReport m_report;
    // The triangles of tile t, ascending: m_binned[m_first[t]] .. m_binned[m_first[t + 1]].
    std::vector<size_t> m_first;
    std::vector<uint32_t> m_binned;
};

} // namespace vmlight
