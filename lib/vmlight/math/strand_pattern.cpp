// SPDX-License-Identifier: Apache-2.0
#include <vmlight/math/strand_pattern.h>

#include <vmlight/math/latlong.h>

#include <algorithm>
#include <cmath>

namespace vmlight {

using Imath::V3d;
using Imath::V3f;
using latlong::pi;

double strand_angle(double u)
{
    // theta - sin theta cos theta is (2/3) theta^3 (1 - theta^2 / 5 + ...) near 0, and symmetric around pi / 2.
    const double share = std::min(u, 1 - u), z = std::cbrt(1.5 * pi * share);
    double theta = z * (1 + z * z / 15 + 0.0198 * z * z * z * z);
    for (int step = 0; step < 2 && theta > 0; ++step) { // Newton's method: from an error of .005 to one below 1e-9
        const double sine = std::sin(theta), cosine = std::cos(theta);
        theta -= (theta - sine * cosine - pi * share) / (2 * sine * sine);
    }
    return u <= 0.5 ? theta : pi - theta;
}

StrandPattern::StrandPattern(const std::string& sampler, int count)
    : m_owen(sampler == "sobol")
{
    for (uint32_t i = 0; i < uint32_t(count); ++i)
        m_points.push_back(sampler == "halton" ? halton_point(i)
                               : m_owen        ? sobol_point(i)
                                               : fibonacci_point(i, uint32_t(count)));
    sort_for_packets(m_points);
}

void StrandPattern::directions(RayFan& fan, const V3f& tangent, Point32 texel) const
{
    const TangentFrame frame(tangent);
    std::fill(fan.lanes.begin(), fan.lanes.end(), uint8_t(0));
    for (int i = 0; i < fan.packets * kPacketSize; ++i) {
        const Point32& point = m_points[size_t(std::min(i, count() - 1))];
        const uint32_t u = m_owen ? owen_scramble(point.u, texel.u) : point.u + texel.u;
        const uint32_t v = m_owen ? owen_scramble(point.v, texel.v) : point.v + texel.v;
        const double theta = strand_angle((u + 0.5) * 0x1p-32), azimuth = 2 * pi * ((v + 0.5) * 0x1p-32);
        const double sine = std::sin(theta);
        const V3d d = V3d(frame.tangent) * (sine * std::cos(azimuth))
            + V3d(frame.bitangent) * (sine * std::sin(azimuth)) + V3d(frame.normal) * std::cos(theta);
        fan.x[i] = float(d.x), fan.y[i] = float(d.y), fan.z[i] = float(d.z);
        if (i < count())
            fan.lanes[size_t(i / kPacketSize)] |= uint8_t(1u << i % kPacketSize);
    }
}

} // namespace vmlight
