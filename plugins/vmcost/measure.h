// SPDX-License-Identifier: Apache-2.0
/// The measurement: bakes, lights, compares and takes times.
#pragma once

#include "inputs.h"
#include "journal.h"
#include "sweep.h"
#include "whole_progress.h"

#include <vector>

namespace vmlight::cost {

struct Measured
{
    std::vector<Row> rows;
    int measured = 0, reused = 0;
};

/// Measure all settings under each environment. Rows that the journal in `folder` already has are reused; new ones are
/// added to it at once. Also writes heat maps of the default settings.
///
/// Short times are the minimum of several runs. A row is measured again if the mesh, an occluder, the environment's
/// pixels, a parameter, the number of threads or the version changed. Not detected: another machine, or another build
/// of the same version.
///
/// @param inputs   with their references
/// @returns false, with the reason in `error`, if memory runs out, a file cannot be written or the work was interrupted
bool measure(Measured& dst, const std::vector<Setting>& settings, const Inputs& inputs, const CostParams& params,
             const std::string& folder, const MakeOptions& options, WholeProgress& progress, std::string& error);

} // namespace vmlight::cost
