// SPDX-License-Identifier: Apache-2.0
#include <vmlight/math/strand_pattern.h>

#include <vmlight/math/latlong.h>
#include <vmlight/math/sampling_kernel.h>

#include <algorithm>
#include <cmath>

namespace vmlight {

using Imath::V3f;
using kernel::reverse_bits;
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
    : m_count(count)
    , m_owen(sampler == "sobol")
{
    std::vector<Point32> points = sample_points(sampler, count);
    points.resize(size_t((count + kPacketSize - 1) / kPacketSize) * kPacketSize, points.back());
    for (const Point32& p : points) {
        m_u.push_back(m_owen ? reverse_bits(p.u) : p.u);
        m_v.push_back(m_owen ? reverse_bits(p.v) : p.v);
    }
}

void StrandPattern::directions(RayFan& fan, const V3f& tangent, Point32 texel) const
{
    kernel::strand_directions({ m_u.data(), m_v.data(), m_count, false, m_owen, texel.u, texel.v }, strand_angles(),
                              TangentFrame(tangent), fan);
    std::fill(fan.lanes.begin(), fan.lanes.end(), uint8_t(0xff));
    if (const int beyond = int(fan.lanes.size()) * kPacketSize - m_count; beyond > 0)
        fan.lanes.back() = uint8_t(0xff >> beyond);
}

} // namespace vmlight
