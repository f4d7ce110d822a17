// SPDX-License-Identifier: Apache-2.0
/// One page that says what to choose, without reading anything else.
#pragma once

#include "summary.h"
#include "tables.h"

#include <string>
#include <vector>

namespace vmlight::cost {

struct Picture
{
    std::string caption;
    /// An SVG element, or the bytes of a PNG.
    std::string svg, png;
};

struct Report
{
    std::string title;
    std::vector<Point> points;
    std::vector<Picture> plots;
    /// Of each environment one of each model.
    std::vector<std::pair<std::string, std::vector<Picture>>> heat_maps;
    Facts facts;
};

/// HTML with all of it inside: nothing is fetched.
std::string report_html(const Report& report);

/// What reaches an error, or comes nearest to it: one line of text.
std::string choice_text(const std::vector<Point>& points, double target);

} // namespace vmlight::cost
