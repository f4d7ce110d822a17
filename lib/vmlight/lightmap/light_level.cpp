// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/light_level.h>

#include <vmlight/base/format.h>
#include <vmlight/image/channels.h>
#include <vmlight/image/color.h>
#include <vmlight/image/color_labels.h>
#include <vmlight/image/color_space.h>
#include <vmlight/image/primaries.h>
#include <vmlight/lightmap/lightmap.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace vmlight {

std::array<double, 3> luminance_weights(const OIIO::ImageSpec& spec)
{
    const ColorLabels labels = read_color_labels(spec, spec.format);
    const LinearSpace* space = labels.primaries ? labels.primaries : linear_space_named(labels.interop_id);
    return luminance_of_primaries(space ? *space : *linear_space_named(kLinearRec709));
}

LightLevel measure_light(const OIIO::ImageBuf& lightmap, const OIIO::ImageBuf& vismap)
{
    const OIIO::ImageSpec& map = vismap.spec();
    const int covered = map.channelindex(kCoverageChannel);
    const int at = covered >= 0 ? covered : map.channelindex(kVismapChannels[0]);
    const float least = covered >= 0 ? 0.5f : 0.0f;
    const std::array<double, 3> weights = luminance_weights(lightmap.spec());
    const auto* rgb = static_cast<const float*>(lightmap.localpixels());
    const auto* texel = static_cast<const float*>(vismap.localpixels());
    std::vector<float> lit;
    double sum = 0;
    for (OIIO::imagesize_t i = 0; i < map.image_pixels(); ++i, rgb += 3, texel += map.nchannels) {
        const double luminance = weights[0] * rgb[0] + weights[1] * rgb[1] + weights[2] * rgb[2];
        if (!(texel[at] > least) || !(luminance > 0))
            continue;
        sum += luminance;
        lit.push_back(float(luminance));
    }
    LightLevel level;
    level.texels = int64_t(lit.size());
    if (lit.empty())
        return level;
    level.mean = sum / double(lit.size());
    const auto rank = lit.begin() + std::ptrdiff_t(0.95 * double(lit.size() - 1));
    std::nth_element(lit.begin(), rank, lit.end());
    level.percentile95 = *rank;
    return level;
}

GrayExposure GrayExposure::of(double mean)
{
    if (!(mean > 0))
        return {};
    const double wanted = std::log2(kMiddleGray / mean),
                 stops = std::clamp(wanted, LightmapParams::kExposure.min, LightmapParams::kExposure.max);
    return { stops, mean * std::exp2(stops), stops == wanted };
}

std::string GrayExposure::advice() const
{
    return is_gray
        ? format("--exposure {:.2f} brings the mean to {}", stops, kMiddleGray)
        : format("no --exposure brings the mean to {}: {:.2f} brings it to {:.3g}", kMiddleGray, stops, mean);
}

GrayExposure LightLevel::gray_exposure(double exposure) const
{
    GrayExposure gray = texels == 0 ? GrayExposure() : GrayExposure::of(mean * std::exp2(-exposure));
    gray.stops = std::round(100 * gray.stops) / 100;
    return gray;
}

double covered_luminance(const OIIO::ImageBuf& picture, const std::string& space)
{
    OIIO::ImageSpec spec;
    tag_scene_linear(spec, space);
    const std::array<double, 3> weights = luminance_weights(spec);
    double sum = 0, alpha = 0;
    for (OIIO::ImageBuf::ConstIterator<float> pixel(picture); !pixel.done(); ++pixel) {
        for (int c = 0; c < 3; ++c)
            sum += weights[size_t(c)] * double(pixel[c]);
        alpha += double(pixel[3]);
    }
    return alpha > 0 ? sum / alpha : 0;
}

} // namespace vmlight
