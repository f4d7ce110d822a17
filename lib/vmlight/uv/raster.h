// SPDX-License-Identifier: Apache-2.0
/// Rasterization of a mesh in UV space: texel centres, the top-left rule, exact integers.
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

/// The texels of one tile: the triangle that owns each, and the point in it.
struct TileCover
{
    static constexpr uint32_t kNone = ~0u;
    /// The triangle of the texel at (x, y) in the tile, at index y * kTileSize + x; kNone if uncovered.
    std::array<uint32_t, kTileSize * kTileSize> triangle;
    /// Barycentric weights of the triangle's second and third corners; the first has the rest.
    std::array<float, kTileSize * kTileSize> weight1, weight2;
    int64_t covered = 0;
    int64_t overlapping = 0; ///< texels covered by more than one triangle
};

/// A mesh over the width x height texels of one UDIM tile: row 0 is the top (v = 1 for 1001), texel centres are at
/// (i + 0.5) / n. The offset of the tile is subtracted exactly: a mesh moved by whole tiles without rounding covers the
/// same texels, with the same weights. Coordinates are rounded to 1/256 of a texel and all tests are exact: a texel on
/// a shared edge belongs to exactly one of the two triangles. Where triangles overlap, the lowest index wins.
class UvRaster
{
public:
    /// Not checked: that the mesh has uvs.
    UvRaster(const Mesh& mesh, int width, int height, int udim = kFirstUdim);

    int tiles_across() const { return (m_width + kTileSize - 1) / kTileSize; }
    int tiles_down() const { return (m_height + kTileSize - 1) / kTileSize; }
    const UvReport& report() const { return m_report; }

    /// Does the triangle have area in space, and is it at least partly in this UDIM tile?
    bool is_in_tile(size_t triangle) const;
    /// Would the triangle cover a texel if it were alone? Takes up to `height` steps.
    bool covers_any_texel(size_t triangle) const;

    /// Rasterize tile number `tile`, counted row by row. Independent of other tiles; thread-safe.
    void cover(int tile, TileCover& dst) const;

private:
    struct Bounds;
    Imath::V2d corner_position(size_t triangle, int corner) const;
    Imath::V2d size() const;
    Bounds bounds_of(size_t triangle) const;
    bool corners(size_t triangle, std::array<UvCorner, 3>& dst) const;
    void count_outside(size_t triangle, UvReport& report) const;
    bool lies_inside(const std::array<UvCorner, 3>& corners) const;
    struct Portion;
    void sort(Portion& portion) const;
    template <class Visit> void for_each_tile(const std::array<UvCorner, 3>& corners, Visit&& visit) const;

    const Mesh& m_mesh;
    int m_width, m_height;
    Imath::V2d m_corner;
    UvReport m_report;
    // Tile t has triangles m_binned[m_first[t]] .. m_binned[m_first[t + 1]], ascending.
    std::vector<size_t> m_first;
    std::vector<uint32_t> m_binned;
};

} // namespace vmlight
