// SPDX-License-Identifier: Apache-2.0
/// gnuplot scripts: error against cost, one curve per model, averaged over environments.
#pragma once

#include "summary.h"

#include <string>
#include <vector>

namespace vmlight::cost {

struct Plot
{
    /// Base name of its files.
    std::string name;
    /// What it shows.
    std::string caption;
    /// gnuplot commands, except for the terminal.
    std::string script;
};

/// Error against total time, bytes per texel and rays per texel.
std::vector<Plot> plots(const std::vector<Point>& points);

/// The complete script for SVG, to embed in a page, and for PNG.
std::string svg_script(const Plot& plot);
std::string png_script(const Plot& plot);

} // namespace vmlight::cost
