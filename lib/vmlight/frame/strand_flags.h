// SPDX-License-Identifier: Apache-2.0
/// Flags of pictures that show strands, or meshes and strands: which of them can have an effect.
#pragma once

#include <vmlight/frame/strand_specular.h>
#include <vmlight/stage/recipe/recipe.h>

#include <string>
#include <vector>

namespace vmlight {

/// Whether one of the files `paths`, which a picture shows, is of strands. Their radius is that of `recipe`.
bool shows_strands(const VismapRecipe& recipe, const std::vector<std::string>& paths);

/// The bake of the first mesh of `paths`; of the first strands if there is no mesh.
VismapRecipe shown_recipe(const VismapRecipe& recipe, const std::vector<std::string>& paths);

/// Whether `name` is a flag of strands in pictures: `strand_color`, or a key of StrandParams or SpecularParams.
bool is_strand_flag(const std::string& name);

/// Why no value of such a flag can change the picture, or "".
std::string unused_strand_flag(const std::string& name, bool shows_strands, bool is_white,
                               const SpecularParams& specular);

} // namespace vmlight
