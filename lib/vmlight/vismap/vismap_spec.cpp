// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/baker.h>

#include <vmlight/image/channels.h>
#include <vmlight/image/color.h>
#include <vmlight/version.h>
#include <vmlight/vismap/basis.h>
#include <vmlight/vismap/reconstruct.h>
#include <vmlight/vismap/sun_visibility.h>

#include <algorithm>

namespace vmlight {

OIIO::ImageSpec describe_vismap(const std::string& mesh_name, const VismapParams& params)
{
    std::vector<std::string> names(kVismapChannels.begin(), kVismapChannels.end());
    if (params.has("normal"))
        names.insert(names.end(), kNormalChannels.begin(), kNormalChannels.end());
    if (params.has("error"))
        names.push_back(kErrorChannel);
    const std::vector<std::string> suns = sun_channels(params.sun_directions);
    names.insert(names.end(), suns.begin(), suns.end());
    const std::vector<std::string> basis = basis_channels(params);
    names.insert(names.end(), basis.begin(), basis.end());
    if (params.has("coverage"))
        names.push_back(kCoverageChannel);
    OIIO::ImageSpec spec(params.size().width, params.size().height, int(names.size()), OIIO::TypeDesc::FLOAT);
    spec.channelnames = names;
    spec.tile_width = spec.tile_height = kTileSize;
    spec.tile_depth = 1;
    tag_data(spec);
    append_params(spec, params);
    if (params.target_error > 0)
        spec.erase_attribute("vmlight:samples");
    if (params.sun_directions.empty())
        spec.erase_attribute("vmlight:sun_directions");
    // A map without ground has the metadata that it always had.
    for (const char* name : { "ground", "ground_height" })
        if (!params.ground)
            spec.erase_attribute(metadata_name(name));
    if (!is_reconstructed(params))
        spec.erase_attribute("vmlight:reconstruct");
    spec.attribute("vmlight:stage", kVismapStage);
    spec.attribute("vmlight:version", VMLIGHT_VERSION_STRING);
    spec.attribute("vmlight:mesh", mesh_name);
    return spec;
}

MarginChannels margin_channels_of(const std::vector<std::string>& names)
{
    const int copied = int(std::count_if(names.begin(), names.end(), holds_whole_numbers));
    const int unfilled = int(std::count(names.begin(), names.end(), kCoverageChannel));
    return { int(names.size()) - copied - unfilled, copied };
}

} // namespace vmlight
