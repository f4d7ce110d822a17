// SPDX-License-Identifier: Apache-2.0
/// Scripts for gnuplot: error against what it costs, one curve a model, means over environments.
#pragma once

#include "summary.h"

#include <string>
#include <vector>

namespace vmlight::cost {

struct Plot
{
    /// Of its files, without extension.
    std::string name;
    /// What it shows, in a sentence.
    std::string caption;
    /// All but the terminal.
    std::string script;
};

/// Error against total time, against bytes a texel, and against rays.
std::vector<Plot> plots(const std::vector<Point>& points);

/// The script of a plot as SVG, to stand in a page among others; or as PNG.
std::string svg_script(const Plot& plot);
std::string png_script(const Plot& plot);

} // namespace vmlight::cost
