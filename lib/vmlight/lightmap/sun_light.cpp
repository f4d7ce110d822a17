// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/sun_light.h>

namespace vmlight {

void SunLight::add(OIIO::ROI part, double gain, float* rgb) const
{
    const size_t count = suns.size();
    for (int y = part.ybegin; y < part.yend; ++y) {
        const float* seen
            = &visibility[(size_t(y - roi.ybegin) * size_t(roi.width()) + size_t(part.xbegin - roi.xbegin)) * count];
        for (int x = part.xbegin; x < part.xend; ++x, rgb += 3)
            for (const Sun& sun : suns)
                if (const double t = double(*seen++) * gain; t > 0)
                    for (size_t c = 0; c < 3; ++c)
                        rgb[c] = float(double(rgb[c]) + sun.color[c] * t);
    }
}

} // namespace vmlight
