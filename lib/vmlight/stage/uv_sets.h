// SPDX-License-Identifier: Apache-2.0
/// The other UV sets of a recipe's mesh.
#pragma once

#include <vmlight/stage/recipe/recipe.h>

#include <functional>
#include <string>

namespace vmlight {

/// Read the mesh of `recipe` again with each of its UV sets but the one that the recipe asks for, and call
/// visit(set, part) with what is chosen of it, if that has texture coordinates. Ends at the first set that the mesh
/// lacks, 0 aside.
void for_each_other_uv_set(const VismapRecipe& recipe, const std::function<void(int set, const Mesh& part)>& visit);

/// Why a mesh without texture coordinates cannot be baked, with the UV sets that it has.
std::string no_uvs_error(const VismapRecipe& recipe);

} // namespace vmlight
