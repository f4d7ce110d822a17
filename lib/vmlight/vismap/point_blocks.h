// SPDX-License-Identifier: Apache-2.0
/// The points of a tile in blocks of 8x8 texels, so that those which face away from a sun are passed over together.
#pragma once

#include <vmlight/base/tile_size.h>
#include <vmlight/vismap/map_points.h>

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vmlight {

/// Points of one block, one after the other in their tile.
struct PointBlock
{
    static constexpr int kSide = 8;

    uint32_t first, end;
    uint16_t column, row; ///< of its first texel, in the tile
    Imath::V3f low, high; ///< the box around SurfacePoint::normal

    /// No normal of the block leans towards `direction` by more than this.
    double most_facing(const Imath::V3d& direction) const
    {
        double sum = 0;
        for (int axis = 0; axis < 3; ++axis)
            sum += direction[axis] * double(direction[axis] > 0 ? high[axis] : low[axis]);
        return sum;
    }
    /// Whether one of its texels is among these.
    bool has_any(const std::array<uint64_t, kTileSize>& texels) const
    {
        uint64_t rows = 0;
        for (int y = row; y < row + kSide; ++y)
            rows |= texels[size_t(y)];
        return (rows >> column & 0xff) != 0;
    }
};

/// @param points   as MapPoints::of_tile() orders them: block by block
std::vector<PointBlock> point_blocks(const std::vector<MapPoint>& points);

} // namespace vmlight
