// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/neighbour_window.h>

namespace vmlight {

NeighbourWindow::NeighbourWindow()
    : weights(weight(kNeighbours, 0))
    , own_weight(kTexels)
{
    fit.nearness = weights;
    for (auto& slopes : fit.slopes)
        slopes.fill(own_weight);
    fit.xx = fit.xy = fit.yy = fit.middle_x = fit.middle_y = fit.evenness = own_weight;
    clear();
}

void NeighbourWindow::clear()
{
    wanted.fill(~uint64_t(0));
    constexpr size_t kAll = size_t(kSide) * kStride + 8;
    for (Plane& plane : values)
        plane.assign(kAll, 0);
    variance.assign(kAll, 0);
    spacing.assign(kAll, 0);
    gives.assign(kAll, 1);
    for (size_t c = 0; c < 3; ++c) {
        normal[c].assign(kAll, 0);
        position[c].assign(kAll, 0);
    }
}

} // namespace vmlight
