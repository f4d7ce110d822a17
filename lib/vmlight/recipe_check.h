// SPDX-License-Identifier: Apache-2.0
/// What is wrong with a recipe by itself, whatever the files that it names hold.
#pragma once

#include <vmlight/export.h>
#include <vmlight/recipe.h>

#include <string>

namespace vmlight {

/// An input that is missing, or one too many; rotations that are none or exclude one another; or "". Begins with the
/// key and ": " if one key is at fault. Not checked: single values, which were when they were read.
VMLIGHT_API std::string recipe_fault(const VismapRecipe& recipe);
VMLIGHT_API std::string recipe_fault(const CfemRecipe& recipe);
VMLIGHT_API std::string recipe_fault(const LightmapRecipe& recipe);

/// Why `key` cannot change the picture, given the others, whatever its value; or "" if it can. The OCIO config always
/// can: what it is good for depends on the files.
VMLIGHT_API std::string unused_reason(const VismapRecipe& recipe, const std::string& key);
VMLIGHT_API std::string unused_reason(const CfemRecipe& recipe, const std::string& key);
VMLIGHT_API std::string unused_reason(const LightmapRecipe& recipe, const std::string& key);

} // namespace vmlight
