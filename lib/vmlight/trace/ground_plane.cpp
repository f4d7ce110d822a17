// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/ground_plane.h>

#include <algorithm>
#include <cmath>

namespace vmlight {

using Imath::V3d;

namespace {

constexpr double kPi = 3.14159265358979323846;
// A flat face that lies on the plane: its floats, and those of a point within, round to less.
constexpr double kOnPlane = kNearRayOffset;

} // namespace

GroundView ground_view(const V3d& normal)
{
    const V3d up(0, 1, 0);
    const double cosine = std::clamp(normal.y, -1.0, 1.0), sine = std::min(1.0, std::hypot(normal.x, normal.z));
    const double angle = std::atan2(sine, cosine);
    GroundView view;
    view.visibility = 0.5 * (1 + cosine);
    if (view.visibility > 0)
        view.direction = (normal * ((kPi - angle) / 2 + sine * cosine / 2) + (up - normal * cosine) * (sine / 2))
            * (4 / (3 * kPi));
    return view;
}

double GroundPlane::height_of(const SurfacePoint& point) const
{
    // Not `origin`: it is anywhere from kNearRayOffset to kRayOffset off the surface.
    const double height = double(point.near_origin.y) - double(point.geometric_normal.y) * kNearRayOffset - m_height;
    return std::abs(height) <= kOnPlane ? 0 : height;
}

bool GroundPlane::hides_lower_half(const SurfacePoint& point) const
{
    const double height = height_of(point);
    return m_exists && (height == 0 || (height > 0 && m_length == std::numeric_limits<double>::infinity()));
}

float GroundPlane::lowest_ray(const SurfacePoint& point) const
{
    constexpr float kAll = std::numeric_limits<float>::infinity();
    const double height = m_exists ? height_of(point) : 0;
    return !m_exists ? -kAll : height < 0 ? kAll : float(-height / m_length);
}

void GroundPlane::clear_blocked(RayFan& fan, const SurfacePoint& point) const
{
    if (!m_exists)
        return;
    const float lowest = lowest_ray(point);
    for (int packet = 0; packet < fan.packets; ++packet) {
        const float* y = fan.y + packet * kPacketSize;
        uint8_t open = 0;
        for (int lane = 0; lane < kPacketSize; ++lane)
            open |= uint8_t(y[lane] >= lowest) << lane;
        fan.lanes[size_t(packet)] &= open;
    }
}

} // namespace vmlight
