// SPDX-License-Identifier: Apache-2.0
/// Flags of tools that take a mesh and an environment as they are, without recipes.
#pragma once

#include <vmlight/cli/main.h>

#include <string>

namespace vmlight {

/// Add --colorspace, --colorconfig, --layer and --layout: how the environment is read. `recipe` must outlive run().
void add_environment_options(StageMain& stage, CfemRecipe& recipe);

/// Whether mesh and environment are given in the wrong order: what is wrong, or "".
std::string operand_order_fault(const std::string& mesh, const std::string& environment);

} // namespace vmlight
