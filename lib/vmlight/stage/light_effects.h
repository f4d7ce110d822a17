// SPDX-License-Identifier: Apache-2.0
/// What lighting a map is going to simulate and why: --explain of makelightmap.
#pragma once

#include <vmlight/base/export.h>
#include <vmlight/lightmap/lightmap.h>
#include <vmlight/stage/make_options.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/stage/recipe/recipe.h>

#include <OpenImageIO/imagebuf.h>

#include <functional>
#include <string>

namespace vmlight {

/// What the recipe lights: without the albedo, the bounce, the suns or the rotation, if they are switched off; with
/// suns and a bounce that are switched on by name, as if suns = "on" and bounce = "on" asked for them; filtering
/// light of one colour, looking it up, or multiplying by an albedo of 1, where `filter`, `stack-levels` or `albedo` is
/// switched on, by name or as one of all.
VMLIGHT_API LightmapRecipe with_switches(const LightmapRecipe& recipe);

/// A lightmap as the user asked for it, and as it is made: with the switches of effects applied.
struct SwitchedLight
{
    LightmapRecipe asked;
    LightmapParams asked_params, params; ///< of this frame
};

/// Whether a reader can follow the switches of a recipe, which recipe_fault() has checked: those that depend on its
/// inputs.
///
/// @param light            what the model reads
/// @param converts_color   whether light or result change their colour space
/// @param read_map         reads the visibility map, if that is switched off
/// @returns false, with the reason in `error`, if what is switched on is impossible, or what is switched off cannot be
///          left out
bool check_switches(const LightmapRecipe& recipe, OIIO::cspan<OIIO::ImageBuf> light, bool converts_color,
                    const std::function<bool(OIIO::ImageBuf& map, std::string& error)>& read_map, std::string& error);

/// Decide on the effects of a lightmap whose inputs, with its switches applied, are `inputs`; report the table if the
/// options ask for it, and warn of what is left out though it would change the picture, with the difference of the
/// light with and without, for which both are lit. False, with the reason in `error`, if the switches ask for what is
/// impossible, or what is left out cannot be read.
VMLIGHT_API bool explain_light(const LightmapInputs& inputs, const SwitchedLight& light, const MakeOptions& options,
                               std::string& error);

} // namespace vmlight
