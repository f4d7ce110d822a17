// SPDX-License-Identifier: Apache-2.0
/// Recipes that read recipes: who leads to whom, what each must be given, and where in its file a fault is told.
#pragma once

#include <vmlight/stage/recipe/recipe.h>

#include <string>
#include <vector>

namespace vmlight {

/// Names of the recipes on the way to the one at hand, which is the last, outermost first; each a path, with its
/// ?query. Empty if there is no file behind it.
using RecipeChain = std::vector<std::string>;

/// Add `name` to `chain`. False, with the way that was gone in `error`, if that recipe is on it already, by whatever
/// path, or if 64 are: each reads its inputs by recursion.
bool link_recipe(RecipeChain& chain, const std::string& name, std::string& error);

/// `reason`, led by where the last recipe of `chain` gives `key`, for there the user can mend it: `"a.lightmap" line 3:
/// albedo: ...`. The reason alone if there is no file, or a flag or a caller has put another value in that one's place.
template <class Recipe>
std::string placed(const Recipe& recipe, const std::string& key, const RecipeChain& chain, const std::string& reason);

/// What keeps `recipe` from being made, led by its place, or "": an input that is not given, or two where one is
/// wanted; rotations that are none or exclude one another. Not checked: that the inputs exist, and single parameters.
std::string recipe_fault(const VismapRecipe& recipe, const RecipeChain& chain);
std::string recipe_fault(const CfemRecipe& recipe, const RecipeChain& chain);
std::string recipe_fault(const LightmapRecipe& recipe, const RecipeChain& chain);

/// What an input of a recipe must be. An environment lights a lightmap; a cfem filters a panorama, in which a pipeline
/// may have left the tags of anything.
enum class Input
{
    Vismap,
    Cfem,
    Environment,
    Panorama,
    Albedo
};

/// What keeps the image `name` from being such an input, or "". `stage` is its `vmlight:stage`, "" if it has none, or
/// that of its recipe. Not checked: its channels.
std::string input_fault(const std::string& name, const std::string& stage, Input wanted);

} // namespace vmlight
