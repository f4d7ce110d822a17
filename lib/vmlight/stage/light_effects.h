// SPDX-License-Identifier: Apache-2.0
/// What lighting a map is going to simulate and why: --explain of makelightmap.
#pragma once

#include <vmlight/base/export.h>
#include <vmlight/lightmap/lightmap.h>
#include <vmlight/stage/make_options.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/stage/recipe/recipe.h>

#include <string>

namespace vmlight {

/// The recipe without what its switches of effects leave out: the albedo, the bounce, the suns or the rotation.
VMLIGHT_API LightmapRecipe with_switches(const LightmapRecipe& recipe);

/// A lightmap as the user asked for it, and as it is made: with the switches of effects applied.
struct SwitchedLight
{
    LightmapRecipe asked;
    LightmapParams asked_params, params; ///< of this frame
};

/// Decide on the effects of a lightmap whose inputs, with its switches applied, are `inputs`; report the table if the
/// options ask for it, and warn of what is left out though it would change the picture, with the difference of the
/// light with and without, for which both are lit. False, with the reason in `error`, if the switches ask for what is
/// impossible, or what is left out cannot be read.
VMLIGHT_API bool explain_light(const LightmapInputs& inputs, const SwitchedLight& light, const MakeOptions& options,
                               std::string& error);

} // namespace vmlight
