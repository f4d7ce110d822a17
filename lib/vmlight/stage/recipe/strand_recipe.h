// SPDX-License-Identifier: Apache-2.0
/// Recipes that bake strands instead of a mesh.
#pragma once

#include <vmlight/stage/recipe/recipe.h>

#include <string>

namespace vmlight {

/// Whether the recipe bakes strands: it gives them a radius, or its mesh is a file of nothing else.
bool bakes_strands(const VismapRecipe& recipe);

/// Why strands cannot be baked by this recipe, or "": what it sets is for meshes. `key` is set to what.
std::string strand_fault(const VismapRecipe& recipe, std::string& key);

/// Why `key` has no effect, or "": it is a key of the recipe for meshes, and this bakes strands, or the other way
/// round.
std::string unused_by_strands(const VismapRecipe& recipe, const std::string& key);

} // namespace vmlight
