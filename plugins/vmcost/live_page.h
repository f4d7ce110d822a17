// SPDX-License-Identifier: Apache-2.0
/// The measured mesh as a page that lights it live, for the report.
#pragma once

#include "inputs.h"

#include <string>

namespace vmlight::cost {

/// The most environments that the page has, in the order in which they were given.
constexpr int kLivePageLights = 3;

/// Bake the mesh at the reference's size with the default rays, and make a page of it and the first environments.
///
/// @param html     set to the page, or to "" if the mesh is too large for one
/// @param light    as read_inputs()
/// @returns false, with the reason in `error`, if a stage fails or `progress` stopped the work
bool make_live_page(std::string& html, const Inputs& inputs, const CfemRecipe& light, const CostParams& params,
                    const MakeOptions& options, const Progress& progress, std::string& error);

} // namespace vmlight::cost
