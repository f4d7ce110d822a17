// SPDX-License-Identifier: Apache-2.0
/// Where the surface goes on beyond the border of a UV island: on the other side of a seam, elsewhere in the map.
#pragma once

#include <vmlight/uv/raster.h>

#include <Imath/ImathVec.h>
#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vmlight {

/// A cell of the map's grid of texels beside an island, and the texel whose point of the surface would be there if the
/// map went on over the seam.
struct SeamCell
{
    uint32_t island;
    int x, y; ///< may lie outside the map
    float distance; ///< from the seam, in texels
    int source_x, source_y; ///< in the map; no triangle need cover it
};

class SeamLinks
{
public:
    SeamLinks() = default;
    /// Link the triangles on both sides of each seam: those of exactly two triangles that share the positions of an
    /// edge (equal bit for bit), but not its uvs. n log n in the triangles at seams.
    ///
    /// @param raster   of the mesh; both triangles must be in its UDIM tile
    /// @param width, height, udim as in the raster
    SeamLinks(const Mesh& mesh, const UvRaster& raster, int width, int height, int udim);

    /// The number of the triangle's island.
    uint32_t island(uint32_t triangle) const { return m_islands[triangle]; }
    /// Of the map, in texels.
    int width() const { return m_width; }
    int height() const { return m_height; }
    size_t links() const { return m_links.size(); }
    size_t bytes() const;

    /// Set `dst` to the cells on the outer side of seams, no farther from them than a neighbour can be, that are within
    /// NeighbourWindow::kHalo of `roi`. By island, row and column; of equal ones the nearest to a seam comes first. A
    /// tile of the map with very many links has none. Depends on the mesh and the tile alone.
    void find(OIIO::ROI roi, std::vector<SeamCell>& dst) const;

private:
    // The edge, in texels, with the island on its left (in a grid whose rows go down) or right; and how to go on from
    // its first point: source = origin + across * dx + down * dy.
    struct Link
    {
        Imath::V2f first, second, origin, across, down;
        float side;
        uint32_t island;
    };
    void bin(int width, int height);

    int m_tiles_across = 0;
    int m_width = 0, m_height = 0;
    std::vector<uint32_t> m_islands;
    std::vector<Link> m_links;
    // Those near tile t are m_binned[m_first[t]] to m_binned[m_first[t + 1]], ascending.
    std::vector<size_t> m_first;
    std::vector<uint32_t> m_binned;
};

} // namespace vmlight
