// SPDX-License-Identifier: Apache-2.0
/// Recipes that read recipes: their order, what each needs, and the location of a fault in its file.
#pragma once

#include <vmlight/stage/recipe/recipe.h>

#include <string>
#include <vector>

namespace vmlight {

/// Names of nested recipes, outermost first, the current one last; each a path with its ?query. Empty for a recipe that
/// has no file.
using RecipeChain = std::vector<std::string>;

/// Append `name` to `chain`. False, with the whole cycle in `error`, if that recipe is in the chain already, by any
/// path, or if the chain has 64: recipes are read recursively.
bool link_recipe(RecipeChain& chain, const std::string& name, std::string& error);

/// `reason` after the place where the last recipe of `chain` sets `key`, where the user can fix it: `"a.lightmap" line
/// 3: albedo: ...`. The reason alone if there is no file, or a flag or a caller has overridden the value.
template <class Recipe>
std::string with_location(const Recipe& recipe, const std::string& key, const RecipeChain& chain,
                          const std::string& reason);

/// Why `recipe` cannot be made, with its location, or "": a missing input, two inputs that exclude each other, an
/// invalid rotation or more than one, switches of effects that the recipe does not allow. Not checked: that the inputs
/// exist and allow the switches, and the ranges of parameters.
#define VMLIGHT_DECLARE(Recipe) std::string recipe_fault(const Recipe& recipe, const RecipeChain& chain);
VMLIGHT_RECIPES(VMLIGHT_DECLARE)
#undef VMLIGHT_DECLARE

/// The kind of image that an input must be. An environment lights a lightmap; a panorama, filtered by a cfem, may carry
/// any tags that a pipeline left in it.
enum class InputKind
{
    Vismap,
    Cfem,
    Environment,
    Panorama,
    Albedo
};

/// Why the image `name` cannot be such an input, or "". `stage` is its `vmlight:stage` ("" if not set), or the stage of
/// its recipe. Not checked: its channels.
std::string input_fault(const std::string& name, const std::string& stage, InputKind wanted);

} // namespace vmlight
