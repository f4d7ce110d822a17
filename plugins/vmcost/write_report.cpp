// SPDX-License-Identifier: Apache-2.0
#include "write_report.h"

#include "gnuplot.h"
#include "heat_map.h"
#include "heat_map_file.h"
#include "models.h"
#include "named_channels.h"
#include "plots.h"
#include "report.h"

#include <vmlight/base/format.h>
#include <vmlight/base/interrupt.h>
#include <vmlight/base/output_file.h>
#include <vmlight/base/parallel.h>
#include <vmlight/version.h>

#include <OpenImageIO/strutil.h>

namespace vmlight::cost {
namespace {

constexpr int kHeatSide = 128; // pictures embedded in the page

bool draw(std::vector<Picture>& dst, const std::vector<Point>& points, const std::string& folder, std::string& error)
{
    for (const Plot& plot : plots(points)) {
        std::string svg, png;
        if (!run_gnuplot(svg, svg_script(plot), error) || !run_gnuplot(png, png_script(plot), error)
            || !write_file(format("{}/{}.svg", folder, plot.name), svg, error)
            || !write_file(format("{}/{}.png", folder, plot.name), png, error))
            return false;
        // Embedded in HTML, an SVG has no XML prologue.
        dst.push_back({ plot.caption, svg.substr(std::min(svg.size(), svg.find("<svg"))), "" });
    }
    return true;
}

bool read_heat_maps(Report& report, const Measured& measured, const Inputs& inputs, const std::string& folder,
                    std::string& error)
{
    for (const Environment& environment : inputs.environments) {
        auto& [name, pictures] = report.heat_maps.emplace_back(environment.name, std::vector<Picture> {});
        for (const Row& row : measured.rows) {
            const std::string& model = row.setting.model;
            if (row.environment != name || !(row.setting == default_setting(model)))
                continue;
            OIIO::ImageBuf map;
            Picture& picture = pictures.emplace_back();
            picture.caption = format("{}, {:.1f} %", model, 100 * row.errors.rmse.value);
            if (!read_channels(map, heat_map_path(folder, name, model) + ".exr", kHeatMapChannels, error)
                || !heat_map_png(picture.png, map, kHeatSide, error))
                return false;
        }
    }
    return true;
}

Facts facts_of(const Inputs& inputs, const CostParams& params, const MakeOptions& options)
{
    const BakeScene& scene = *inputs.scene;
    std::vector<std::string> names;
    for (const Environment& environment : inputs.environments)
        names.push_back(environment.name);
    return { { "mesh", scene.mesh().name },
             { "triangles", format("{}, including occluders", scene.triangle_count()) },
             { "environments", OIIO::Strutil::join(names, ", ") },
             { "reference", format("{0}x{0} texels, {1} pairs of rays", params.side(), params.pairs()) },
             { "threads", format("{}", worker_count(options.threads)) },
             { "seed", format("{}", params.seed) },
             { "vmlight", VMLIGHT_VERSION_STRING } };
}

} // namespace

bool write_report(const Measured& measured, const std::vector<EffectCost>& effects, const Inputs& inputs,
                  const CostParams& params, const CommandInputs& commands, const std::string& live_page,
                  const std::string& folder, const MakeOptions& options, std::string& error)
{
    const DeferInterrupts writing;
    Report report;
    report.title = "What accuracy costs: " + inputs.scene->mesh().name;
    report.points = summarize(measured.rows);
    report.spread = typical_spread(measured.rows);
    report.commands = commands;
    report.effects = effects;
    report.live_page = live_page;
    report.facts = facts_of(inputs, params, options);
    return (params.no_plots || draw(report.plots, report.points, folder, error))
        && read_heat_maps(report, measured, inputs, folder, error)
        && write_file(folder + "/costs.csv", csv_text(measured.rows), error)
        && write_file(folder + "/costs.json", json_text(measured.rows, report.facts, effects), error)
        && write_file(folder + "/report.html", report_html(report), error);
}

} // namespace vmlight::cost
