// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/light_facts.h>

#include <vmlight/effects/rows.h>
#include <vmlight/image/channels.h>

#include <cmath>
#include <vector>

namespace vmlight {

double rotation_degrees(const Rotation& r)
{
    // From the antisymmetric part and the trace: exact near 0, unlike the arc cosine.
    const double x = r[2][1] - r[1][2], y = r[0][2] - r[2][0], z = r[1][0] - r[0][1];
    return std::atan2(std::sqrt(x * x + y * y + z * z), r[0][0] + r[1][1] + r[2][2] - 1) * 180 / M_PI;
}

void find_visibility_facts(LightFacts& dst, const OIIO::ImageBuf& vismap)
{
    OIIO::ROI row = vismap.roi();
    row.chbegin = vismap.spec().channelindex(kVismapChannels[0]);
    row.chend = row.chbegin + 1;
    std::vector<float> values(size_t(row.width()));
    for (int y = vismap.ybegin(); y < vismap.yend(); ++y) {
        row.ybegin = y;
        row.yend = y + 1;
        if (!vismap.get_pixels(row, OIIO::TypeFloat, values.data()))
            return;
        for (const float value : values) {
            dst.lit += value > 0;
            dst.shadowed += value > 0 && value < 1;
            dst.hidden += !(value > 0);
        }
    }
}

bool find_bounce_facts(LightFacts& dst, BounceShading* bounce, const OIIO::ImageBuf& vismap, const MakeOptions& options,
                       std::string& error)
{
    TransportForecast forecast;
    if (!bounce || !(options.explain || options.dry_run) || !calls_for_bounce(dst))
        return true;
    if (!bounce->forecast(forecast, vismap, options, error))
        return false;
    dst.traced_rays = forecast.rays;
    dst.traced_points = forecast.points;
    return true;
}

} // namespace vmlight
