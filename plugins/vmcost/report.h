// SPDX-License-Identifier: Apache-2.0
/// The report: one self-contained page that recommends settings.
#pragma once

#include "summary.h"
#include "tables.h"

#include <string>
#include <vector>

namespace vmlight::cost {

struct Picture
{
    std::string caption;
    /// An SVG element, or a PNG file's bytes.
    std::string svg, png;
};

struct Report
{
    std::string title;
    std::vector<Point> points;
    std::vector<Picture> plots;
    /// By environment, one picture per model.
    std::vector<std::pair<std::string, std::vector<Picture>>> heat_maps;
    Facts facts;
};

/// The report as HTML with everything embedded.
std::string report_html(const Report& report);

/// One line of text: the fastest setting that reaches a target error, or the nearest one.
std::string choice_text(const std::vector<Point>& points, double target);

} // namespace vmlight::cost
