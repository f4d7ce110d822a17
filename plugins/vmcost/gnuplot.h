// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace vmlight::cost {

/// Why gnuplot cannot be run, or "". Names the package to install.
std::string gnuplot_fault();

/// Run a gnuplot script and capture its stdout. Returns false, with the reason in `error`, if gnuplot cannot be started
/// or fails; its own messages go to stderr.
bool run_gnuplot(std::string& output, const std::string& script, std::string& error);

} // namespace vmlight::cost
