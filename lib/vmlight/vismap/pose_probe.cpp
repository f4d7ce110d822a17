// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/pose_probe.h>

#include <vmlight/vismap/ground_of.h>

#include <algorithm>
#include <bitset>

namespace vmlight {

using Imath::V3d;
using Imath::V3f;

PoseProbe::Side::Side(const PosedMap& the_map, const VismapParams& params, const SamplePattern& pattern)
    : map(the_map)
    , ground(ground_of(*the_map.scene, params))
    , length(float(params.max_distance * the_map.scene->frame().scale))
    , surface(the_map.scene->mesh(), the_map.scene->frame())
    , fan(pattern.count())
{
}

int64_t PoseProbe::Side::trace(const SurfacePoint& point)
{
    ground.clear_blocked(fan, point);
    const int64_t rays = count_rays(fan);
    if (rays > 0)
        map.scene->occluder().clear_blocked(fan, point.origin, length, point.is_near);
    return rays;
}

PoseProbe::PoseProbe(const PosedMap& base, const PosedMap& pose, const VismapParams& params,
                     const SamplePattern& pattern, const BakeHints* hints)
    : m_params(params)
    , m_pattern(pattern)
    , m_hints(hints)
    , m_base(base, params, pattern)
    , m_pose(pose, params, pattern)
{
}

SurfacePoint PoseProbe::point_of(Side& side, uint32_t triangle, float weight1, float weight2, int x, int y) const
{
    SurfacePoint point = side.surface.at(triangle, weight1, weight2);
    if (side.map.normal_map)
        side.map.normal_map->apply(point, triangle, weight1, weight2, x, y);
    adjust_ray_origins(&point, 1, side.map.scene->occluder());
    return point;
}

double PoseProbe::change_of_known(const SurfacePoint& point, const uint8_t* known, Point32 texel)
{
    RayFan& fan = m_pose.fan;
    const bool is_mapped = point.normal != point.mesh_normal; // as VisibilityIntegrator has it
    m_pattern.directions(fan, TangentFrame(point.normal), is_mapped ? point.normal : point.geometric_normal, texel);
    const int64_t all = std::max<int64_t>(1, count_rays(fan));
    m_pose.ground.clear_blocked(fan, point);
    MovedBoxes::Near near;
    m_hints->moved->find_near(near, point, m_pose.length);
    for (int packet = 0; packet < fan.packets; ++packet)
        fan.lanes[size_t(packet)] &= MovedBoxes::may_meet(near, fan, packet, point.origin, m_pose.length);
    const std::vector<uint8_t> asked = fan.lanes;
    const int64_t rays = count_rays(fan);
    m_rays += rays;
    if (rays > 0)
        m_pose.map.scene->occluder().clear_blocked(fan, point.origin, m_pose.length, point.is_near);
    int64_t changed = 0;
    for (size_t packet = 0; packet < asked.size(); ++packet)
        changed += int64_t(std::bitset<8>((fan.lanes[packet] ^ known[packet]) & asked[packet]).count());
    return double(changed) / double(all);
}

double PoseProbe::change(uint32_t triangle, float weight1, float weight2, int x, int y, const Rotation& turn)
{
    const SurfacePoint after = point_of(m_pose, triangle, weight1, weight2, x, y);
    const Point32 texel = m_pattern.texel(x, y, uint32_t(m_params.seed));
    if (m_hints) {
        const RayMemory memory = memory_of(*m_hints, after, triangle, x, y);
        if (memory.known)
            return change_of_known(after, memory.known, texel);
    }
    const SurfacePoint before = point_of(m_base, triangle, weight1, weight2, x, y);
    TangentFrame frame(before.normal);
    m_pattern.directions(m_base.fan, frame, before.geometric_normal, texel);
    frame.tangent = V3f(rotate(turn, V3d(frame.tangent)));
    frame.bitangent = V3f(rotate(turn, V3d(frame.bitangent)));
    frame.normal = V3f(rotate(turn, V3d(frame.normal)));
    m_pattern.directions(m_pose.fan, frame, after.geometric_normal, texel);
    const int64_t all = std::max({ count_rays(m_base.fan), count_rays(m_pose.fan), int64_t(1) });
    m_rays += m_base.trace(before) + m_pose.trace(after);
    int64_t changed = 0;
    for (int packet = 0; packet < m_base.fan.packets; ++packet)
        changed += int64_t(std::bitset<8>(m_base.fan.lanes[size_t(packet)] ^ m_pose.fan.lanes[size_t(packet)]).count());
    return std::min(1.0, double(changed) / double(all) + double((frame.normal - after.normal).length()));
}

} // namespace vmlight
