// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/surface.h>

#include <algorithm>
#include <cmath>

namespace vmlight {

using Imath::V3d;
using Imath::V3f;

void adjust_ray_origins(SurfacePoint* points, int count, const Occluder& occluder)
{
    std::array<V3f, kPacketSize> origins, directions;
    for (int i = 0; i < kPacketSize; ++i) { // unused lanes must hold valid numbers too
        origins[size_t(i)] = points[std::min(i, count - 1)].near_origin;
        directions[size_t(i)] = points[std::min(i, count - 1)].geometric_normal;
    }
    const uint8_t close = occluder.find_blocked(origins.data(), directions.data(), count, float(2 * kRayOffset));
    for (int i = 0; i < count; ++i)
        if (close >> i & 1) {
            points[i].origin = points[i].near_origin;
            points[i].is_near = true;
        }
}

V3d surface_normal(const Mesh& mesh, const std::array<uint32_t, 3>& triangle)
{
    V3d shading(0);
    for (const uint32_t corner : triangle) {
        const V3d normal(mesh.normals[corner]);
        shading += std::isfinite(normal.length2()) ? normal : V3d(0);
    }
    const V3d area_normal = triangle_area_normal(mesh, triangle);
    // Vertex normals decide which side is outside, not the winding, which is wrong in files far more often.
    return area_normal.normalized() * (shading.dot(area_normal) < 0 ? -1 : 1);
}

SurfacePoint flat_surface(const V3f& position, const V3f& normal)
{
    // Floats round far away.
    const double reach
        = std::max({ 1.0, double(std::abs(position.x)), double(std::abs(position.y)), double(std::abs(position.z)) });
    SurfacePoint point;
    point.normal = point.mesh_normal = point.geometric_normal = normal;
    point.origin = position + normal * float(reach * kRayOffset);
    point.near_origin = position + normal * float(reach * kNearRayOffset);
    return point;
}

V3f facing_normal(const NearestHit& hit, const V3f& direction)
{
    const V3d normal = V3d(hit.normal).normalized();
    return V3f(normal.dot(V3d(direction)) > 0 ? -normal : normal);
}

SurfacePoint Surface::at(uint32_t triangle, float weight1, float weight2)
{
    if (triangle != m_triangle)
        load_triangle(triangle);
    std::array<double, 3> weight { 1.0 - double(weight1) - double(weight2), weight1, weight2 };
    double total = 0;
    for (int k = 0; k < 3; ++k)
        total += weight[k] = std::max(weight[k], m_least_weight[k]);
    V3d position(0), normal(0);
    for (int k = 0; k < 3; ++k) {
        position += m_corner[k] * (weight[k] / total);
        normal += m_corner_normal[k] * weight[k];
    }
    SurfacePoint point;
    point.geometric_normal = V3f(m_normal);
    point.mesh_normal = normal.dot(m_normal) > 1e-3 * normal.length() ? V3f(normal.normalized()) : V3f(m_normal);
    point.normal = point.mesh_normal;
    point.origin = V3f(position + m_normal * kRayOffset);
    point.near_origin = V3f(position + m_normal * kNearRayOffset);
    return point;
}

void Surface::load_triangle(uint32_t triangle)
{
    m_triangle = triangle;
    const auto& corners = m_mesh.triangles[triangle];
    for (int k = 0; k < 3; ++k) {
        // The floats that are traced: the point must be in the plane of the traced triangle.
        m_corner[k] = V3d(m_frame.to_scene(m_mesh.positions[corners[k]]));
        const V3d normal(m_mesh.normals[corners[k]]);
        m_corner_normal[k] = std::isfinite(normal.length2()) ? normal : V3d(0);
    }
    const double area = (m_corner[1] - m_corner[0]).cross(m_corner[2] - m_corner[0]).length();
    m_normal = surface_normal(m_mesh, corners);
    for (int k = 0; k < 3; ++k) {
        const double edge = (m_corner[(k + 1) % 3] - m_corner[(k + 2) % 3]).length();
        const double height = edge > 0 ? area / edge : 0;
        m_least_weight[k] = height > 0 ? std::min(0.25, kEdgeOffset / height) : 0.25;
    }
}

} // namespace vmlight
