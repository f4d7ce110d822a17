// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/stage/recipe/recipe.h>

#include <string>

namespace vmlight {

/// The UV sets, materials and nodes of the recipe's mesh with their triangle counts, one a line: what its parameters
/// `uv_set`, `material` and `node` choose from. A node's count includes those below it. False, with the reason in
/// `error`, if the mesh is missing or cannot be read.
bool list_mesh(std::string& dst, const VismapRecipe& recipe, std::string& error);

} // namespace vmlight
