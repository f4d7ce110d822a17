// SPDX-License-Identifier: Apache-2.0
/// What a recipe alone says of its switches of effects, before its inputs are read.
#pragma once

#include <vmlight/effects/facts.h>
#include <vmlight/effects/switches.h>
#include <vmlight/stage/recipe/recipe.h>

#include <string>

namespace vmlight {

/// Whether the recipe asks for suns, or for bounced light: by its own key, or by name in its switches. What its
/// switches leave out is asked for all the same.
bool wants_suns(const LightmapRecipe& recipe);
bool wants_bounce(const LightmapRecipe& recipe);

/// Why the switches of the recipe cannot be followed, whatever its inputs are, or "": a word is no switch, what is
/// switched on is not given, or what is switched off cannot be left out. The stages refuse the rest, see
/// decide_effects().
std::string switched_fault(const VismapRecipe& recipe);
std::string switched_fault(const LightmapRecipe& recipe);

/// Why the map of the recipe is not reconstructed, a phrase, or "".
std::string why_not_reconstructed(const VismapRecipe& recipe);

/// What the recipe says of its light. What only its inputs know is taken to allow the switches.
EffectFacts known_facts(const LightmapRecipe& recipe, const EffectSwitches& switches);

} // namespace vmlight
