// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/model.h>

#include <vmlight/image/channels.h>
#include <vmlight/math/harmonics.h>
#include <vmlight/math/packed_visibility.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <array>

namespace vmlight {
namespace {

using OIIO::Strutil::fmt::format;

bool has_channel(const OIIO::ImageSpec& spec, const std::string& name)
{
    return spec.channelindex(name) >= 0;
}

// Bands that the harmonics of `vismap` fill, with V and B: 2 if it has none.
int harmonic_order(const OIIO::ImageSpec& vismap)
{
    int count = 4;
    while (count < Harmonics::kLargestOrder * Harmonics::kLargestOrder
           && has_channel(vismap, format("{}{}", kHarmonicChannel, count)))
        ++count;
    int order = 2;
    while ((order + 1) * (order + 1) <= count)
        ++order;
    return order;
}

std::string best_model(const OIIO::ImageSpec& vismap)
{
    return has_channel(vismap, format("{}0", kCellsChannel)) ? "cells"
        : has_channel(vismap, format("{}0", kMaskChannel))   ? "mask"
        : harmonic_order(vismap) > 2                         ? "sh"
                                                             : "lobe";
}

} // namespace

bool reads_radiance(const std::string& model)
{
    return model == "sh" || model == "mask" || model == "cells";
}

bool find_model(ShadingModel& dst, const LightmapParams& params, const OIIO::ImageSpec& vismap, bool has_stack,
                std::string& error)
{
    std::array<int, 4> ignored;
    if (!find_vismap_channels(vismap, ignored, error))
        return false;
    dst = {};
    dst.name = params.model != "auto" ? params.model : has_stack ? best_model(vismap) : "paper";
    dst.channels.assign(kVismapChannels.begin(), kVismapChannels.end());
    const auto add = [&](const char* prefix, int from, int to) {
        for (int i = from; i < to; ++i)
            dst.channels.push_back(format("{}{}", prefix, i));
    };
    const auto add_normal
        = [&] { dst.channels.insert(dst.channels.end(), kNormalChannels.begin(), kNormalChannels.end()); };
    std::string flag;
    if (dst.name == "ao") {
        dst.channels.resize(1);
        add_normal();
        flag = "--channels normal";
    } else if (dst.name == "lobe") {
        dst.light = ModelLight::lobes;
    } else if (reads_radiance(dst.name)) {
        dst.light = ModelLight::radiance;
        flag = "--basis " + dst.name;
    }
    if (dst.name == "sh") {
        dst.order = harmonic_order(vismap);
        add(kHarmonicChannel, 4, std::max(dst.order * dst.order, 9)); // fewer than three bands are none to ask for
    } else if (dst.name == "mask" || dst.name == "cells") {
        add_normal();
        dst.name == "mask" ? add(kMaskChannel, 0, kMaskFloats) : add(kCellsChannel, 0, kCellsFloats);
    }
    for (const std::string& name : dst.channels)
        if (!has_channel(vismap, name)) {
            error = format("no channel \"{}\" among {}: the model {} needs what makevismap {} bakes", name,
                           OIIO::Strutil::join(vismap.channelnames, ", "), dst.name, flag);
            return false;
        }
    return true;
}

} // namespace vmlight
