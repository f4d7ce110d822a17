// SPDX-License-Identifier: Apache-2.0
/// The texels of a map in squares, and what probes found in each.
#pragma once

#include <vmlight/uv/raster.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vmlight {

class PoseGrid
{
public:
    /// What was found of a part of the mesh: a UV island, as far as it moves as one body.
    struct Probe
    {
        uint32_t part;
        float change;
    };

    /// @param side     of the squares, in texels: divides kTileSize
    PoseGrid(int side, const UvRaster& raster)
        : m_side(side)
        , m_across(raster.tiles_across() * per_tile())
        , m_down(raster.tiles_down() * per_tile())
        , m_probes(size_t(m_across) * size_t(m_down))
    {
    }

    int side() const { return m_side; }
    int per_tile() const { return kTileSize / m_side; }
    /// Those of the square that has texel (x, y).
    std::vector<Probe>& at(int x, int y) { return m_probes[index(x / m_side, y / m_side)]; }
    const std::vector<Probe>& at(int x, int y) const { return m_probes[index(x / m_side, y / m_side)]; }

    /// Whether a probe of the part (kAny: of any), in the square of texel (x, y) or one beside it, found more than
    /// `limit`.
    static constexpr uint32_t kAny = ~0u;
    bool exceeds(int x, int y, uint32_t part, double limit) const
    {
        const int column = x / m_side, row = y / m_side;
        for (int j = std::max(0, row - 1); j <= std::min(m_down - 1, row + 1); ++j)
            for (int i = std::max(0, column - 1); i <= std::min(m_across - 1, column + 1); ++i)
                for (const Probe& probe : m_probes[index(i, j)])
                    if ((part == kAny || probe.part == part) && !(probe.change <= limit))
                        return true;
        return false;
    }

private:
    size_t index(int column, int row) const { return size_t(row) * size_t(m_across) + size_t(column); }
    int m_side, m_across, m_down;
    std::vector<std::vector<Probe>> m_probes;
};

} // namespace vmlight
