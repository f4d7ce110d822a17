// SPDX-License-Identifier: Apache-2.0
/// The images that a lightmap reads, opened.
#pragma once

#include <vmlight/stage/albedo_source.h>
#include <vmlight/stage/bounce_shading.h>
#include <vmlight/stage/light_color.h>
#include <vmlight/stage/output_color.h>
#include <vmlight/stage/pixel_source.h>
#include <vmlight/stage/recipe/chain.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/stage/sun_shading.h>

#include <memory>
#include <string>

namespace vmlight {

struct LightmapImages
{
    PixelSourcePointer vismap;
    PixelSourcePointer cfem; ///< the recipe's, or that of its environment, of an implicit CfemRecipe
    PixelSourcePointer environment; ///< nullptr if the recipe has a CFEM instead
    std::shared_ptr<AlbedoSource> albedo; ///< nullptr without
    std::shared_ptr<SunShading> suns; ///< nullptr if the recipe's suns are off, or `auto` and cannot be traced
    std::string no_suns; ///< why they cannot, if the recipe asks for them, in a clause
    std::shared_ptr<BounceShading> bounce; ///< nullptr if the recipe's bounce is off, or `auto` and cannot be traced
    std::string no_bounce; ///< why it cannot, if the recipe asks for it, in a clause
    LightColor light; ///< how the colour of the CFEM is converted
    std::string key; ///< changes with any of them, and with the OCIO config if one is used
};

/// How the colours of light, albedo and result are converted, such as "albedo: sRGB -> ACEScg"; "" if none are.
std::string conversions_of(const LightmapRecipe& recipe, const LightmapImages& images, const OutputColor& output);

/// Open them; `recipe` has its UDIM tile resolved. False, with `error`, if one cannot be opened.
bool open_images(LightmapImages& dst, const LightmapRecipe& recipe, std::string& error, const RecipeChain& chain);

} // namespace vmlight
