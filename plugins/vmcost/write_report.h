// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "commands.h"
#include "effects.h"
#include "inputs.h"
#include "measure.h"

namespace vmlight::cost {

/// Write costs.csv, costs.json, the plots as SVG and PNG, and report.html to `folder`, each atomically. Returns false,
/// with the reason in `error`.
/// @param live_page    from make_live_page()
bool write_report(const Measured& measured, const std::vector<EffectCost>& effects, const Inputs& inputs,
                  const CostParams& params, const CommandInputs& commands, const std::string& live_page,
                  const std::string& folder, const MakeOptions& options, std::string& error);

} // namespace vmlight::cost
