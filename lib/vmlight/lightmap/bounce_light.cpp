// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/bounce_light.h>

#include <cstddef>

namespace vmlight {

void BounceLight::add(OIIO::ROI part, double gain, float* rgb) const
{
    const size_t count = 3 * size_t(part.width());
    for (int y = part.ybegin; y < part.yend; ++y, rgb += count) {
        const float* from
            = &light[3 * (size_t(y - roi.ybegin) * size_t(roi.width()) + size_t(part.xbegin - roi.xbegin))];
        for (size_t i = 0; i < count; ++i)
            rgb[i] = float(double(rgb[i]) + double(from[i]) * gain);
    }
}

} // namespace vmlight
