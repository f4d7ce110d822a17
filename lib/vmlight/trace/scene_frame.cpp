// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/scene_frame.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vmlight {

using Imath::V3d;

SceneFrame SceneFrame::around(const Mesh& mesh)
{
    V3d low(std::numeric_limits<double>::infinity()), high(-std::numeric_limits<double>::infinity());
    for (const auto& triangle : mesh.triangles)
        for (uint32_t vertex : triangle)
            for (int axis = 0; axis < 3; ++axis) {
                low[axis] = std::min(low[axis], mesh.positions[vertex][axis]);
                high[axis] = std::max(high[axis], mesh.positions[vertex][axis]);
            }
    return around(low, high);
}

SceneFrame SceneFrame::around(const V3d& low, const V3d& high)
{
    SceneFrame frame;
    const V3d half = (high - low) * 0.5;
    const double reach = std::max({ half.x, half.y, half.z });
    if (!(reach < std::numeric_limits<double>::infinity())) // nothing in it
        return frame;
    frame.centre = low + half;
    if (reach > 0)
        frame.scale = std::ldexp(1.0, -int(std::ceil(std::log2(reach))));
    return frame;
}

} // namespace vmlight
