// SPDX-License-Identifier: Apache-2.0
/// Which keys of a recipe matter, whatever the files that it names hold.
#pragma once

#include <vmlight/stage/recipe/recipe.h>

#include <string>

namespace vmlight {

/// Why `key` cannot change the picture, given the others, whatever its value; or "" if it can. The OCIO config always
/// can: what it is good for depends on the files.
std::string unused_reason(const VismapRecipe& recipe, const std::string& key);
std::string unused_reason(const CfemRecipe& recipe, const std::string& key);
std::string unused_reason(const LightmapRecipe& recipe, const std::string& key);

} // namespace vmlight
