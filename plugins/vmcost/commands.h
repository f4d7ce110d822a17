// SPDX-License-Identifier: Apache-2.0
/// Command lines that make what was measured, to copy.
#pragma once

#include "sweep.h"

#include <vmlight/stage/recipe/recipe.h>

#include <string>

namespace vmlight::cost {

/// What the commands are for. Paths are as the user gave them.
struct CommandInputs
{
    /// The mesh, its occluders and mesh parameters; of the bake's parameters, those of CostParams::set_scene().
    VismapRecipe mesh;
    std::string environment;
    /// Colour space, OCIO config, layer and layout of the environment; the rest is ignored.
    CfemRecipe light;
    bool sanitize = false;
};

/// The bake and the lighting of a setting as a line for a shell: "makevismap ... && makelightmap ...". Maps are of the
/// default size, or of a part of it if the setting's are. "" for kTraced, which no executable makes.
std::string command_text(const Setting& setting, const CommandInputs& inputs);

} // namespace vmlight::cost
