// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace vmlight::cost {

/// Why no plots can be drawn, or "": the package that is missing is named.
std::string gnuplot_fault();

/// What gnuplot writes to its standard output for a script. False, with the reason in `error`, if it cannot be started
/// or says that the script is wrong, which it tells on stderr.
bool run_gnuplot(std::string& output, const std::string& script, std::string& error);

} // namespace vmlight::cost
