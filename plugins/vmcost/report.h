// SPDX-License-Identifier: Apache-2.0
/// The report: one self-contained page that recommends settings.
#pragma once

#include "commands.h"
#include "effects.h"
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
    /// typical_spread() of the timings.
    double spread = 0;
    CommandInputs commands;
    std::vector<EffectCost> effects;
    std::vector<Picture> plots;
    /// By environment, one picture per model.
    std::vector<std::pair<std::string, std::vector<Picture>>> heat_maps;
    Facts facts;
    /// The page of make_live_page(), or "".
    std::string live_page;
};

/// The report as HTML with everything embedded.
std::string report_html(const Report& report);

/// For each of goals(): one line with the fastest setting that reaches it, and one with its command.
std::vector<std::string> choice_lines(const std::vector<Point>& points, const CommandInputs& commands);

/// What to say of timings whose typical_spread() is this, or "".
std::string busy_note(double spread);

} // namespace vmlight::cost
