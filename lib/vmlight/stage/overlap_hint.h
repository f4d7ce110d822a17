// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/vismap/vismap.h>

#include <string>

namespace vmlight {

/// Whether so much of a map is shared by several triangles that the UVs were not made for baking.
bool has_heavy_overlap(const VismapReport& report);

/// What would overlap less than the map of `report`, a whole bake of `mesh`: another UV set, or one map for each
/// instance or material. Reads the mesh again for its other UV sets. "" if nothing would.
std::string overlap_hint(const VismapReport& report, const Mesh& mesh, const VismapRecipe& recipe);

} // namespace vmlight
