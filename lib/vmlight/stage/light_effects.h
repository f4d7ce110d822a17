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

/// The recipe without what its switches of effects leave out: the albedo, the bounce, or the rotation.
VMLIGHT_API LightmapRecipe with_switches(const LightmapRecipe& recipe);

/// Decide on the effects of `recipe` as given, whose inputs are read; report the table if the options ask for it, and
/// warn of what is left out though it would change the picture. False, with the reason in `error`, if the switches ask
/// for what is impossible.
VMLIGHT_API bool explain_light(const LightmapInputs& inputs, const LightmapRecipe& recipe, const LightmapParams& params,
                               const MakeOptions& options, std::string& error);

} // namespace vmlight
