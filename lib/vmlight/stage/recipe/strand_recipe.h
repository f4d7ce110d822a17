// SPDX-License-Identifier: Apache-2.0
/// Recipes that bake strands instead of a mesh.
#pragma once

#include <vmlight/stage/recipe/recipe.h>

#include <string>

namespace vmlight {

/// Whether the recipe bakes strands: its mesh is a file of nothing else, or it gives strands a radius and no occluder
/// is one. OBJ and glTF files are read to know what they hold, if there is a radius and an occluder.
bool bakes_strands(const VismapRecipe& recipe);

/// Whether an occluder of the recipe is read as strands: it is a file of nothing else; of an OBJ or glTF if there is a
/// radius.
bool is_strand_occluder(const VismapRecipe& recipe, const std::string& path);

/// Why strands cannot be baked by this recipe, or "": what it sets is for meshes. `key` is set to what.
std::string strand_fault(const VismapRecipe& recipe, std::string& key);

/// Why `key` has no effect, or "": it is a key of the recipe for meshes, and this bakes strands, or the other way
/// round.
std::string unused_by_strands(const VismapRecipe& recipe, const std::string& key);

} // namespace vmlight
