// SPDX-License-Identifier: Apache-2.0
/// Points of a mesh's surface that rays can start from.
#pragma once

#include <vmlight/mesh/mesh.h>
#include <vmlight/trace/occluder.h>

#include <array>
#include <cstdint>

namespace vmlight {

/// How far off the surface rays start, in units of a SceneFrame, in which the baked mesh fills [-1, 1] whatever its own
/// units: 256 times the rounding of its coordinates, so that no ray meets the surface it comes from.
constexpr double kOffset = 1.0 / (1 << 16);
/// The same where something lies as near as that: 8 times the rounding, half of the least gap through which surfaces
/// are told apart. Embree's floats may put it on the wrong side of a sliver: Occluder::clear_blocked() must be told.
constexpr double kNearOffset = 1.0 / (1 << 21);
/// How far from the edges of a triangle they start.
constexpr double kEdgeOffset = 1.0 / (1 << 14);
/// Triangles with no side as long as this are points to what is traced from them.
constexpr double kTinyTriangle = 8 * kNearOffset;

/// A point to bake, in scene space.
struct SurfacePoint
{
    Imath::V3f origin; ///< where rays start: kOffset off the surface, until settle_origins() says otherwise
    Imath::V3f near_origin; ///< kNearOffset off it
    Imath::V3f normal; ///< the interpolated normal, of unit length
    Imath::V3f geometric_normal; ///< the triangle's, on the side of its corner normals
    bool is_near = false; ///< of `origin`: for Occluder::clear_blocked()
};

/// Have rays start nearer to those of `count` points, at most kPacketSize, above which something lies within twice
/// kOffset. One ray each, all asked about at once; each point's answer is its own.
void settle_origins(SurfacePoint* points, int count, const Occluder& occluder);

/// A mesh in a scene frame. Keeps what it worked out for the last triangle: one to a thread.
class Surface
{
public:
    Surface(const Mesh& mesh, const SceneFrame& frame)
        : m_mesh(mesh)
        , m_frame(frame)
    {
    }

    /// The point with these weights of the triangle's second and third corners.
    /// The normal is the interpolated one, or the triangle's where those of the corners cancel or lean under it.
    /// The position is kept off the triangle's edges by kEdgeOffset (a quarter of a small triangle's height): rays
    /// from an edge could slip behind a neighbour that meets it at a sharp angle.
    /// Not checked: that the triangle has an area.
    SurfacePoint at(uint32_t triangle, float weight1, float weight2);

private:
    void take(uint32_t triangle);

    const Mesh& m_mesh;
    const SceneFrame& m_frame;
    uint32_t m_triangle = ~0u;
    std::array<Imath::V3d, 3> m_corner, m_corner_normal;
    std::array<double, 3> m_least_weight;
    Imath::V3d m_normal;
};

} // namespace vmlight
