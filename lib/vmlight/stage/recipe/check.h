// SPDX-License-Identifier: Apache-2.0
/// Which keys of a recipe matter, whatever the files that it names hold.
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
