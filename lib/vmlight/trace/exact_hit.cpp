// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/exact_hit.h>

namespace vmlight::embree {

using Imath::V3d;
using Imath::V3f;

const Placements::Placement* placement_of(const RTCFilterFunctionNArguments& arguments, unsigned lane)
{
    const SceneRays* rays = static_cast<const QueryContext*>(arguments.context)->scene_rays;
    const unsigned instance = RTCHitN_instID(arguments.hit, arguments.N, lane, 0);
    return rays && instance != RTC_INVALID_GEOMETRY_ID ? &rays->placements->of(instance) : nullptr;
}

ExactHit::ExactHit(const Buffers& buffers, const RTCFilterFunctionNArguments& arguments, unsigned lane)
{
    RTCRayN* ray = arguments.ray;
    const unsigned n = arguments.N;
    const Placements::Placement* const placement = placement_of(arguments, lane);
    const auto& triangle = buffers.triangles[RTCHitN_primID(arguments.hit, n, lane)];
    for (size_t k = 0; k < 3; ++k) {
        const V3f& corner = buffers.vertices[triangle[k]];
        corners[k] = placement ? placement->transform.at(corner) : V3d(corner);
    }
    bits = placement ? placement->bits : buffers.bits;
    if (const SceneRays* rays = static_cast<const QueryContext*>(arguments.context)->scene_rays) {
        const unsigned asked = RTCRayN_id(ray, n, lane);
        origin = rays->origins[asked];
        direction = rays->directions[asked];
    } else {
        origin = V3f(RTCRayN_org_x(ray, n, lane), RTCRayN_org_y(ray, n, lane), RTCRayN_org_z(ray, n, lane));
        direction = V3f(RTCRayN_dir_x(ray, n, lane), RTCRayN_dir_y(ray, n, lane), RTCRayN_dir_z(ray, n, lane));
    }
}

} // namespace vmlight::embree
