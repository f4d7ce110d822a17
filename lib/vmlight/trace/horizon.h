// SPDX-License-Identifier: Apache-2.0
/// What cannot block a ray of a triangle, because it does not rise above the triangle's tangent plane.
#pragma once

#include <vmlight/trace/occluder.h>
#include <vmlight/trace/surface.h>

#include <Imath/ImathVec.h>

#include <algorithm>
#include <array>

namespace vmlight {

/// An axis-aligned box around floats of a scene.
struct SceneBox
{
    Imath::V3f low { 3e38f }, high { -3e38f };

    void add(const Imath::V3f& p)
    {
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], p[axis]);
            high[axis] = std::max(high[axis], p[axis]);
        }
    }
    void add(const SceneBox& box)
    {
        for (int axis = 0; axis < 3; ++axis) { // empty boxes add nothing
            low[axis] = std::min(low[axis], box.low[axis]);
            high[axis] = std::max(high[axis], box.high[axis]);
        }
    }
    /// Of the nearest points of both; 0 where they overlap.
    double distance2(const SceneBox& other) const
    {
        double sum = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double gap
                = std::max({ double(low[axis]) - other.high[axis], double(other.low[axis]) - high[axis], 0.0 });
            sum += gap * gap;
        }
        return sum;
    }
};

/// The box around the triangles of a mesh.
SceneBox scene_box(const Mesh& mesh, const SceneFrame& frame);

/// The tangent plane of a triangle, in double over the floats that are traced, with a margin for all rounding on the
/// way of a ray:
/// - rays start kRayOffset above the plane; their directions are floats that are found to point above it in floats, so
///   that they sink by at most kSink of their length. What is below the plane by `kSink x distance - kRayOffset / 2` is
///   never met. In the scene of the object, [-1, 1], that is nothing;
/// - rays start kNearRayOffset above it only where something is higher than that, which kRise excludes. Vertices of one
///   flat face round to less: 3 x 2^-25 each.
class Horizon
{
public:
    static constexpr double kRise = kNearRayOffset / 2;
    static constexpr double kSink = 1.0 / (1 << 21);

    /// @param corners  of the triangle, in scene space
    /// @param normal   unit length, as SurfacePoint::geometric_normal before it is rounded
    Horizon(const std::array<Imath::V3d, 3>& corners, const Imath::V3d& normal)
        : m_corner(corners[0])
        , m_normal(normal)
        , m_plane(std::min({ corners[0].dot(normal), corners[1].dot(normal), corners[2].dot(normal) }))
    {
    }

    /// Whether no ray of the triangle can meet this point.
    bool hides(const Imath::V3d& p) const { return is_below(p.dot(m_normal) - m_plane, (p - m_corner).length()); }

    /// Whether no ray can meet anything in the box. False does not mean that one does.
    bool hides(const SceneBox& box) const
    {
        const Imath::V3d low(box.low), high(box.high), middle = (low + high) * 0.5;
        double top = -m_plane;
        for (int axis = 0; axis < 3; ++axis)
            top += m_normal[axis] * (m_normal[axis] > 0 ? high[axis] : low[axis]);
        return is_below(top, (middle - m_corner).length() + (high - middle).length());
    }

private:
    static bool is_below(double height, double distance)
    {
        return height <= kRise && height + kSink * distance <= kRayOffset / 2;
    }
    Imath::V3d m_corner, m_normal;
    double m_plane;
};

} // namespace vmlight
