// SPDX-License-Identifier: Apache-2.0
/// The switches of effects in a vismap recipe, applied.
#pragma once

#include <vmlight/effects/switches.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/trace/caster_reach.h>

#include <string>
#include <vector>

namespace vmlight {

/// The recipe's switches, which recipe_fault() has checked.
EffectSwitches switches_of(const std::string& effects, const char* stage);

/// `effects` without those words of `words` that are in it.
std::string without_words(const std::string& effects, const std::vector<std::string>& words);

/// `effects` without what it switches off: what it switches on stays.
std::string without_switches_off(const std::string& effects);

/// What the recipe bakes: without the ground, cut-outs, the normal map, the maximum distance, reconstruction or the
/// margin, if they are switched off; without reconstruction also if there is a normal map; tracing all texels, if
/// self-occlusion is switched on.
VismapRecipe with_switches(const VismapRecipe& recipe);

/// What goes into the recipe's ray-tracing scene.
SceneChoice scene_choice(const VismapRecipe& recipe);

/// The effects that are switched off, in the order of the table, for the metadata: "-ground,-margin", or "". What is
/// switched on has the same pixels as what was decided, and so is not there.
std::string switched_off(const std::string& effects, const char* stage);

} // namespace vmlight
