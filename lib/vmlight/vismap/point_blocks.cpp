// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/point_blocks.h>

#include <algorithm>

namespace vmlight {

std::vector<PointBlock> point_blocks(const std::vector<MapPoint>& points)
{
    std::vector<PointBlock> blocks;
    for (const MapPoint& point : points) {
        const auto column = uint16_t(point.x - point.x % PointBlock::kSide),
                   row = uint16_t(point.y - point.y % PointBlock::kSide);
        const Imath::V3f& normal = point.surface.normal;
        const auto at = uint32_t(&point - points.data());
        if (blocks.empty() || blocks.back().column != column || blocks.back().row != row)
            blocks.push_back({ at, at, column, row, normal, normal });
        PointBlock& block = blocks.back();
        block.end = at + 1;
        for (int axis = 0; axis < 3; ++axis) {
            block.low[axis] = std::min(block.low[axis], normal[axis]);
            block.high[axis] = std::max(block.high[axis], normal[axis]);
        }
    }
    blocks.shrink_to_fit();
    return blocks;
}

} // namespace vmlight
