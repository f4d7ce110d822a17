// SPDX-License-Identifier: Apache-2.0
/// The ground: everything below a horizontal plane without end, which blocks rays without tracing them.
#pragma once

#include <vmlight/math/ray_fan.h>
#include <vmlight/trace/surface.h>

#include <Imath/ImathVec.h>

#include <limits>

namespace vmlight {

/// What of its hemisphere a surface sees where the ground alone occludes: V and B.
struct GroundView
{
    double visibility = 1;
    Imath::V3d direction { 0 };
};

/// The part of the hemisphere around `normal` above the horizon (y > 0), weighted by the cosine.
/// V = (1 + n.y) / 2. B is the moment of a spherical wedge: with t the angle from n to y,
/// B = (4 / (3 pi)) (n ((pi - t) / 2 + sin(2t) / 4) + (y - n cos(t)) sin(t) / 2).
GroundView ground_view(const Imath::V3d& normal);

class GroundPlane
{
public:
    /// No ground: blocks nothing.
    GroundPlane() = default;
    /// @param height   of the plane; `length` of rays; both in scene units
    GroundPlane(double height, double length)
        : m_exists(true)
        , m_height(height)
        , m_length(length)
    {
    }

    bool exists() const { return m_exists; }
    /// Of the plane, in scene units.
    double height() const { return m_height; }

    /// Height of the surface at `point` above the plane; 0 within rounding, where the point lies on it: it then sees
    /// what is above the horizon and nothing below, whichever side it faces.
    double height_of(const SurfacePoint& point) const;

    /// The ground blocks rays whose direction has a y below this: all of them where the point is below the ground, none
    /// without a ground.
    float lowest_ray(const SurfacePoint& point) const;

    /// Clear the bit of each ray that the ground blocks: those that descend, within their length, and all rays of a
    /// point below the ground.
    void clear_blocked(RayFan& fan, const SurfacePoint& point) const;

    /// Whether the ground hides all directions below the horizon and no other, so that ground_view() holds.
    bool hides_lower_half(const SurfacePoint& point) const;

private:
    bool m_exists = false;
    double m_height = 0, m_length = std::numeric_limits<double>::infinity();
};

} // namespace vmlight
