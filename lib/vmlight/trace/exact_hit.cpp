// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/exact_hit.h>

#include <algorithm>

namespace vmlight::embree {

using Imath::V2d;
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
    const unsigned number = RTCHitN_primID(arguments.hit, n, lane);
    bits = placement ? placement->bits : buffers.bits;
    if (const SceneRays* rays = static_cast<const QueryContext*>(arguments.context)->scene_rays) {
        const unsigned asked = RTCRayN_id(ray, n, lane);
        origin = rays->origins[asked];
        direction = rays->directions[asked];
    } else {
        origin = V3f(RTCRayN_org_x(ray, n, lane), RTCRayN_org_y(ray, n, lane), RTCRayN_org_z(ray, n, lane));
        direction = V3f(RTCRayN_dir_x(ray, n, lane), RTCRayN_dir_y(ray, n, lane), RTCRayN_dir_z(ray, n, lane));
    }
    find_triangle(buffers, placement, number);
    if (buffers.pieces.empty() || !buffers.pieces[number].is_trimmed)
        return;
    const TrimmedPiece& piece = buffers.pieces[number];
    const auto depth = [this] {
        const V2d at = weights();
        return std::min({ at.x, at.y, 1 - at.x - at.y });
    };
    double deepest = depth();
    if (deepest < 0 && piece.partner != TrimmedPiece::kAlone) {
        find_triangle(buffers, placement, piece.partner);
        if (const double beside = depth(); beside > deepest)
            deepest = beside;
        else
            find_triangle(buffers, placement, number);
    }
    is_beyond = deepest < -piece.tolerance;
}

void ExactHit::find_triangle(const Buffers& buffers, const Placements::Placement* placement, unsigned number)
{
    triangle = number;
    for (size_t k = 0; k < 3; ++k) {
        const V3f& corner = buffers.vertices[buffers.triangles[number][k]];
        corners[k] = placement ? placement->transform.at(corner) : V3d(corner);
    }
}

V2d ExactHit::weights() const
{
    const V3d along(direction), &a = corners[0];
    const V3d side1 = corners[1] - a, side2 = corners[2] - a;
    const V3d p = along.cross(side2), s = V3d(origin) - a, q = s.cross(side1);
    const double scale = 1 / side1.dot(p);
    return { s.dot(p) * scale, along.dot(q) * scale };
}

} // namespace vmlight::embree
