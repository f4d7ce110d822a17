// SPDX-License-Identifier: Apache-2.0
#include <vmlight/math/strand_pattern.h>

#include <vmlight/math/latlong.h>
#include <vmlight/math/point_pattern.h>
#include <vmlight/math/sampling_kernel.h>

#include <algorithm>
#include <cmath>

namespace vmlight {

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

namespace {

Imath::V3d sine_direction(const Point32& p)
{
    const double angle = strand_angle(p.u * 0x1p-32), azimuth = 2 * pi * (p.v * 0x1p-32);
    return { std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth), std::cos(angle) };
}

const kernel::StrandAngles& strand_angles()
{
    static const kernel::StrandAngles all = [] {
        kernel::StrandAngles angles;
        constexpr int kInOctave = 1 << kernel::StrandAngles::kBits,
                      kEntries = kernel::StrandAngles::kOctaves * kInOctave;
        for (int i = 0; i <= kEntries; ++i) {
            const double share = std::ldexp(1 + double(i % kInOctave) / kInOctave, i / kInOctave - 25);
            angles.turns.push_back(float(strand_angle(share) / (2 * pi)));
        }
        return angles;
    }();
    return all;
}

} // namespace

StrandPattern::StrandPattern(const std::string& sampler, int count)
    : m_points(std::make_unique<PointPattern>(sampler, count, sine_direction))
{
}

StrandPattern::~StrandPattern() = default;

int StrandPattern::count() const
{
    return m_points->count();
}

void StrandPattern::directions(RayFan& fan, const V3f& tangent, Point32 texel) const
{
    kernel::strand_directions(m_points->points(texel, false), strand_angles(), TangentFrame(tangent), fan);
    std::fill(fan.lanes.begin(), fan.lanes.end(), uint8_t(0xff));
    if (const int beyond = int(fan.lanes.size()) * kPacketSize - count(); beyond > 0)
        fan.lanes.back() = uint8_t(0xff >> beyond);
}

} // namespace vmlight
