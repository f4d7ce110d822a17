// SPDX-License-Identifier: Apache-2.0
/// The other UV sets of a recipe's mesh.
#pragma once

#include <vmlight/stage/recipe/recipe.h>

#include <Imath/ImathVec.h>

#include <functional>
#include <string>
#include <vector>

namespace vmlight {

/// Read the mesh of `recipe` again with each of its UV sets but the one that the recipe asks for, and call
/// visit(set, part) with what is chosen of it, if that has texture coordinates. Ends at the first set that the mesh
/// lacks, 0 aside.
void for_each_other_uv_set(const VismapRecipe& recipe, const std::function<void(int set, const Mesh& part)>& visit);

/// The UVs that textures ask for, where they are not, or will not be, those of `mesh`: for each UV set three a
/// triangle, NaN where a corner has none; or nothing.
///
/// @param sets     that textures ask for
/// @param own_set  that `mesh` has
/// @param is_lost  those will be replaced
/// @param read_again   reads the same triangles with another UV set
std::vector<std::vector<Imath::V2f>> other_uvs(const Mesh& mesh, const std::vector<int>& sets, int own_set,
                                               bool is_lost, const std::function<bool(Mesh& dst, int set)>& read_again);

/// Why a mesh without texture coordinates cannot be baked, with the UV sets that it has.
std::string no_uvs_error(const VismapRecipe& recipe);

} // namespace vmlight
