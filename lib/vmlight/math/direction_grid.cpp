// SPDX-License-Identifier: Apache-2.0
#include <vmlight/math/direction_grid.h>

#include <vmlight/math/latlong.h>

#include <algorithm>
#include <cmath>

namespace vmlight::direction_grid {

using Imath::V3d;
using latlong::pi;

namespace {

// Int sqrt(1 - y^2) dy from -1 to y.
double disc_area(double y)
{
    return 0.5 * (y * std::sqrt(std::max(0.0, 1 - y * y)) + std::asin(y) + pi / 2);
}

} // namespace

V3d column_middle(int column)
{
    return latlong::direction((column + 0.5) / kColumns, 0.5);
}

const RunningMoments& running_moments()
{
    static const RunningMoments sums = [] {
        RunningMoments moments;
        // w = (sin phi rho, y, -cos phi rho), rho = sqrt(1 - y^2), dw = dphi dy.
        const double step = 2 * pi / kColumns;
        for (int column = 0; column < kColumns; ++column) {
            const double from = column * step, to = from + step;
            for (int slice = 0; slice <= kSlices; ++slice) {
                const double y = edge(slice), disc = disc_area(y);
                moments[size_t(column)][size_t(slice)]
                    = { (std::cos(from) - std::cos(to)) * disc, 0.5 * (y * y - 1) * step,
                        (std::sin(from) - std::sin(to)) * disc };
            }
        }
        return moments;
    }();
    return sums;
}

} // namespace vmlight::direction_grid
