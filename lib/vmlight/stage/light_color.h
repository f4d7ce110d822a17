// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/cfem/suns.h>
#include <vmlight/image/color.h>
#include <vmlight/stage/recipe/recipe.h>

#include <OpenImageIO/imagebuf.h>

#include <string>
#include <vector>

namespace vmlight {

/// The colour of a lightmap's light, and how it gets there from that of a CFEM: an environment is in the working space
/// already.
struct LightColor
{
    OIIO::ImageSpec spec; ///< the CFEM's, tagged with the space of the light
    ColorConversion conversion; ///< empty if nothing changes
    std::string note;
    std::vector<std::string> warnings;

    /// Bring the images of a CFEM to the space of the light; nthreads: 0 means OIIO's default.
    void convert(std::vector<OIIO::ImageBuf>& cfem, int nthreads) const;
    /// The same of the suns that were split off it.
    void convert(std::vector<Sun>& suns) const;
};

/// Whether the light may be converted: it is a CFEM, and the recipe or its labels name its space.
bool may_convert_light(const LightmapRecipe& recipe, const OIIO::ImageSpec& cfem);

/// Choose by the recipe's colorspace, else the CFEM's own labels; its name says nothing. Without a config, light stays
/// in its own primaries. A CFEM without labels is in the working space. False, with the reason in `error`, as
/// to_scene_linear().
bool describe_light(LightColor& dst, const LightmapRecipe& recipe, const OIIO::ImageSpec& cfem, std::string& error);

/// An error of how an environment is filtered on the way to light, where the parameters of the filter have the prefix
/// "cfem_": "; set NAME to" names them so.
std::string with_filter_prefix(const std::string& error);

} // namespace vmlight
