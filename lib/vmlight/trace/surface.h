// SPDX-License-Identifier: Apache-2.0
/// Points on a mesh's surface to trace rays from.
#pragma once

#include <vmlight/mesh/mesh.h>
#include <vmlight/trace/occluder.h>

#include <array>
#include <cstdint>

namespace vmlight {

/// Distance of ray origins from the surface, in units of SceneFrame, where the baked mesh fits in [-1, 1]: 256 times
/// the rounding of coordinates, so that no ray hits the surface it starts from.
constexpr double kRayOffset = 1.0 / (1 << 16);
/// The same where another surface is that near: 8 times the rounding, half of the smallest gap between surfaces that is
/// resolved. Embree's floats may put it on the wrong side of a sliver: pass `is_near` to Occluder::clear_blocked().
constexpr double kNearRayOffset = 1.0 / (1 << 21);
/// Least distance of ray origins from the edges of their triangle.
constexpr double kEdgeOffset = 1.0 / (1 << 14);
/// Triangles whose sides are all shorter than this are too small to be resolved by rays that start nearby.
constexpr double kTinyTriangle = 8 * kNearRayOffset;

/// A point to bake, in scene space.
struct SurfacePoint
{
    Imath::V3f origin; ///< where rays start: kRayOffset off the surface, until adjust_ray_origins() says otherwise
    Imath::V3f near_origin; ///< kNearRayOffset off it
    Imath::V3f normal; ///< to shade with, of unit length: the mesh's, unless a normal map changes it
    Imath::V3f mesh_normal; ///< the interpolated normal of the mesh, of unit length
    Imath::V3f geometric_normal; ///< the triangle's, on the side of its corner normals
    bool is_near = false; ///< `origin` is near_origin: for Occluder::clear_blocked()
};

/// Move the origins of those points to near_origin that have another surface within twice kRayOffset above them. Traces
/// one ray per point. Points do not depend on each other.
/// @param count    at most kPacketSize
void adjust_ray_origins(SurfacePoint* points, int count, const Occluder& occluder);

/// The normal of a triangle on the side of its corner normals, unit length; zero without area. In double: the normal of
/// a sliver rounded to floats may point anywhere.
Imath::V3d surface_normal(const Mesh& mesh, const std::array<uint32_t, 3>& triangle);

/// A flat surface at a position that a ray met, both in scene space: all of its normals are `normal`, of unit length.
/// Its ray origins are farther off it where floats round more.
SurfacePoint flat_surface(const Imath::V3f& position, const Imath::V3f& normal);

/// The unit normal of what a ray along `direction` met, on the side that the ray came from; zero where the triangle has
/// no area. In double: squares of far triangles' normals overflow floats.
Imath::V3f facing_normal(const NearestHit& hit, const Imath::V3f& direction);

/// The surface of a mesh in a SceneFrame. Caches the last triangle: use one per thread.
class Surface
{
public:
    Surface(const Mesh& mesh, const SceneFrame& frame)
        : m_mesh(mesh)
        , m_frame(frame)
    {
    }

    /// The point with these barycentric weights of the triangle's second and third corners. Its normal is interpolated,
    /// or the triangle's where the corners' normals cancel or point below the surface. Its position is kept off the
    /// triangle's edges by kEdgeOffset (or a quarter of a small triangle's height): rays from an edge could slip behind
    /// a neighbour at a sharp angle. Not checked: that the triangle has area.
    SurfacePoint at(uint32_t triangle, float weight1, float weight2);

private:
    void load_triangle(uint32_t triangle);

    const Mesh& m_mesh;
    const SceneFrame& m_frame;
    uint32_t m_triangle = ~0u;
    std::array<Imath::V3d, 3> m_corner, m_corner_normal;
    std::array<double, 3> m_least_weight;
    Imath::V3d m_normal;
};

} // namespace vmlight
