// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/surface_point.h>

#include <cmath>

namespace vmlight {

using Imath::V2d;
using Imath::V3d;

TextureFootprint FramePoint::footprint(const std::array<V2d, 3>& uvs) const
{
    TextureFootprint at;
    for (int k = 0; k < 3; ++k) {
        at.st += uvs[k] * weight[k];
        at.dx += uvs[k] * weight_dx[k];
        at.dy += uvs[k] * weight_dy[k];
    }
    return at;
}

V3d FramePoint::normal(const Mesh& mesh, uint32_t triangle) const
{
    const auto& corners = mesh.triangles[triangle];
    const V3d sum = mix(V3d(mesh.normals[corners[0]]), V3d(mesh.normals[corners[1]]), V3d(mesh.normals[corners[2]]));
    return sum.normalized();
}

bool intersect_plane(FramePoint& dst, const CameraRay& ray, const Mesh& mesh, uint32_t triangle)
{
    const auto& corners = mesh.triangles[triangle];
    const V3d& a = mesh.positions[corners[0]];
    const V3d ab = mesh.positions[corners[1]] - a, ac = mesh.positions[corners[2]] - a;
    const V3d normal = ab.cross(ac);
    const double facing = normal.dot(ray.direction), area = normal.length2();
    if (!(area > 0) || facing == 0)
        return false;
    dst.depth = normal.dot(a - ray.origin) / facing;
    dst.position = ray.origin + ray.direction * dst.depth;
    // Of an offset in the plane.
    const V3d to_second = ac.cross(normal) / area, to_third = normal.cross(ab) / area;
    const auto weights = [&](const V3d& offset, std::array<double, 3>& weight, double sum) {
        weight[1] = offset.dot(to_second);
        weight[2] = offset.dot(to_third);
        weight[0] = sum - weight[1] - weight[2];
    };
    weights(dst.position - a, dst.weight, 1);
    const auto change = [&](const V3d& origin, const V3d& direction, std::array<double, 3>& weight) {
        const V3d moved = origin + direction * dst.depth;
        weights(moved - ray.direction * (normal.dot(moved) / facing), weight, 0);
    };
    change(ray.origin_dx, ray.direction_dx, dst.weight_dx);
    change(ray.origin_dy, ray.direction_dy, dst.weight_dy);
    return std::isfinite(dst.depth + dst.weight[0] + dst.weight_dx[0] + dst.weight_dy[0]);
}

} // namespace vmlight
