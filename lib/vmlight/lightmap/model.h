// SPDX-License-Identifier: Apache-2.0
/// The models of make_lightmap(): which there are, what of a visibility map and of the light each reads, and which one
/// `auto` stands for.
#pragma once

#include <vmlight/lightmap/lightmap.h>

#include <OpenImageIO/imageio.h>

#include <string>
#include <vector>

namespace vmlight {

/// The images of a stack that a model looks light up in.
enum class ModelLight
{
    cfem, ///< the first, or one CFEM alone
    lobes, ///< all but the last
    radiance ///< the last, or the environment alone as make_radiance() makes it
};

/// Whether the model of that name reads the environment itself, to which a filter means nothing.
bool reads_radiance(const std::string& model);

struct ShadingModel
{
    std::string name;
    ModelLight light = ModelLight::cfem;
    /// Channels of the visibility map, in the order in which the model's kernel reads them. V and B come first, but for
    /// `ao`: V and the normal.
    std::vector<std::string> channels;
    /// Of `sh`: the bands that the map has, V and B included.
    int order = 0;
};

/// The model that `params` asks for; for `auto` the best that `vismap` has channels for, if all light is at hand
/// (`has_stack`: a stack, or an environment to make it from), else `paper`.
///
/// @returns false, with the reason in `error`, if `vismap` is none or has not what the model reads.
bool find_model(ShadingModel& dst, const LightmapParams& params, const OIIO::ImageSpec& vismap, bool has_stack,
                std::string& error);

} // namespace vmlight
