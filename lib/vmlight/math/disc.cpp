// SPDX-License-Identifier: Apache-2.0
#include <vmlight/math/disc.h>

namespace vmlight {

using Imath::V3d;
using Imath::V3f;

DiscSamples::DiscSamples(const Disc& disc)
    : m_directions(kCount)
{
    const V3d axis = disc.direction;
    // Any frame around the axis, the same for all texels.
    const V3d side = (std::abs(axis.y) < 0.9 ? V3d(0, 1, 0) : V3d(1, 0, 0)).cross(axis).normalized();
    const V3d up = axis.cross(side);
    const double half_sine = std::sin(0.5 * disc.half_angle);
    for (uint32_t i = 0; i < kCount; ++i) {
        // sin^2(angle / 2) is uniform over a cap; in this form small angles keep their digits.
        const double square = half_sine * half_sine * ((i + 0.5) / kCount);
        const double turn = 2 * latlong::pi * (double(i * 0x9e3779b9u) * 0x1p-32);
        const double sine = 2 * std::sqrt(square * (1 - square));
        m_directions[i] = V3f(axis * (1 - 2 * square) + side * (sine * std::cos(turn)) + up * (sine * std::sin(turn)));
    }
}

} // namespace vmlight
