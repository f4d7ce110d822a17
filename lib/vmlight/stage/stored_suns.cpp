// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/stored_suns.h>

#include <vmlight/vismap/sun_visibility.h>

#include <algorithm>
#include <cmath>

namespace vmlight {

std::vector<int> StoredSuns::channels_of(const std::vector<Disc>& wanted) const
{
    constexpr double kTolerance = latlong::pi / 720; // a quarter of a degree
    std::vector<int> found;
    for (const Disc& disc : wanted) {
        const auto same = std::find_if(discs.begin(), discs.end(), [&](const Disc& own) {
            return (own.direction - disc.direction).length() < kTolerance
                && std::abs(own.half_angle - disc.half_angle) < std::max(kTolerance, 0.25 * disc.half_angle);
        });
        if (same == discs.end())
            return {};
        found.push_back(channels[size_t(same - discs.begin())]);
    }
    return found;
}

StoredSuns stored_suns(const OIIO::ImageSpec& vismap)
{
    StoredSuns suns;
    std::string ignored; // whoever bakes such a map reports it
    const std::string text = vismap.get_string_attribute("vmlight:sun_directions");
    if (!parse_sun_directions(suns.discs, text, ignored))
        return {};
    for (const std::string& channel : sun_channels(text))
        suns.channels.push_back(vismap.channelindex(channel));
    const bool has_all = std::count(suns.channels.begin(), suns.channels.end(), -1) == 0;
    return has_all ? suns : StoredSuns {};
}

std::vector<Disc> discs_in_object_space(const std::vector<Sun>& suns, const Rotation& rotation)
{
    std::vector<Disc> discs;
    for (const Sun& sun : suns) // the inverse of a rotation is its transpose
        discs.push_back({ rotate(rotation.transposed(), sun.disc.direction), sun.disc.half_angle });
    return discs;
}

} // namespace vmlight
