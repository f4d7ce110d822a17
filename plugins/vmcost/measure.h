// SPDX-License-Identifier: Apache-2.0
/// Bakes, lights, compares and takes the time.
#pragma once

#include "inputs.h"
#include "journal.h"

#include <vector>

namespace vmlight::cost {

struct Measured
{
    std::vector<Row> rows;
    int measured = 0, reused = 0;
};

/// Measure settings under each environment, or take the rows from the journal in `folder`, to which each new row is
/// added at once. Heat maps of the default settings are written beside it.
///
/// Times are the least of a few for what is short. A row is measured anew when the mesh, an occluder, the environment's
/// pixels, a parameter or the number of threads is another. Not noticed: another version of the program of the same
/// number, or another machine.
///
/// @param inputs   with their references
/// @returns false, with the reason in `error`, if memory runs out, a file cannot be written or the work was stopped
bool measure(Measured& dst, const std::vector<Setting>& settings, const Inputs& inputs, const CostParams& params,
             const std::string& folder, const MakeOptions& options, std::string& error);

} // namespace vmlight::cost
