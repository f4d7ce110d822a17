// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/sun_light.h>

#include <vmlight/cfem/one_color.h>

#include <algorithm>

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

bool is_black(OIIO::cspan<OIIO::ImageBuf> cfem, const std::vector<Sun>* suns)
{
    const auto is_zero = [](const auto& rgb) { return rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0; };
    if (suns && !std::all_of(suns->begin(), suns->end(), [&](const Sun& sun) { return is_zero(sun.color); }))
        return false;
    const auto color = find_one_color(cfem);
    return color && is_zero(*color);
}

} // namespace vmlight
