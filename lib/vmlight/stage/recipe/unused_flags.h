// SPDX-License-Identifier: Apache-2.0
/// Which parameters have no effect, whatever the files that a recipe names hold (but of a mesh, its format counts).
/// Flags are checked, keys in a file are not.
#pragma once

#include <vmlight/stage/recipe/recipe.h>

#include <string>

namespace vmlight {

/// Why no value of `key` can change the picture, given the other parameters, or "" if it can. The OCIO config always
/// can: its effect depends on the files.
#define VMLIGHT_DECLARE(Recipe) std::string unused_reason(const Recipe& recipe, const std::string& key);
VMLIGHT_RECIPES(VMLIGHT_DECLARE)
#undef VMLIGHT_DECLARE

} // namespace vmlight
