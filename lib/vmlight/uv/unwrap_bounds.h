// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/uv/unwrap_chart.h>

#include <Imath/ImathVec.h>

#include <algorithm>

namespace vmlight {

struct UvBounds
{
    Imath::V2d low { 1e300, 1e300 }, high { -1e300, -1e300 };
    void add(const Imath::V2d& p)
    {
        low = { std::min(low.x, p.x), std::min(low.y, p.y) };
        high = { std::max(high.x, p.x), std::max(high.y, p.y) };
    }
    Imath::V2d size() const { return high - low; }
};

/// Turn a chart so that its bounds are smallest, the long side along x, and begin at the origin. Returns their size.
Imath::V2d lay_straight(UnwrapChart& chart);

} // namespace vmlight
