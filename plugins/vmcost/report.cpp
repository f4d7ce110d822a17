// SPDX-License-Identifier: Apache-2.0
#include "report.h"

#include "heat_map.h"
#include "models.h"
#include "number_text.h"

#include <vmlight/base/format.h>

#include <OpenImageIO/strutil.h>

namespace vmlight::cost {
namespace {

constexpr int kManyPictures = 100;

constexpr const char* kHead = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<style>
body { font: 15px/1.5 sans-serif; color: #222; max-width: 72em; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.5em; } h2 { font-size: 1.15em; margin-top: 2em; }
p { max-width: 60em; } .busy { border-left: 4px solid #d55e00; padding-left: .8em; }
.wide { overflow-x: auto; } table { border-collapse: collapse; margin: .7em 0; }
th, td { padding: .25em .8em; border-bottom: 1px solid #ddd; text-align: right; }
th:first-child, td:first-child { text-align: left; } th { font-weight: 600; vertical-align: bottom; }
.command td { text-align: left; padding-bottom: .7em; } .command code { overflow-wrap: anywhere; font-size: .85em; }
figure { margin: 1em 0; } figcaption { color: #555; font-size: .92em; max-width: 48em; }
figure svg { width: 100%; height: auto; max-width: 760px; }
.heat { display: flex; flex-wrap: wrap; gap: .6em; } .heat figure { margin: 0; text-align: center; }
.heat img { width: 128px; image-rendering: pixelated; } h3 { font-size: 1em; margin-bottom: .3em; }
iframe { width: 100%; height: 32em; border: 1px solid #ddd; }
.effects td:last-child, .effects th:last-child { text-align: left; max-width: 26em; } .none { color: #777; } dl { display: grid; grid-template-columns: max-content auto; gap: .1em 1.2em; }
dt { color: #555; } dd { margin: 0; overflow-wrap: anywhere; }
@media print { body { margin: 0; font-size: 11px; max-width: none; } figure, table { break-inside: avoid; } }
</style>
)";

std::string cells(const char* tag, const std::vector<std::string>& texts)
{
    std::string row = "<tr>";
    for (const std::string& text : texts)
        row += format("<{0}>{1}</{0}>", tag, text);
    return row + "</tr>\n";
}

// A table that scrolls if it does not fit.
std::string wide(const std::string& table)
{
    return "<div class=wide>" + table + "</div>\n";
}

std::string setting_text(const Setting& setting)
{
    std::string text = format("{}, {} rays", setting.model, setting.samples);
    if (setting.cfem_width && setting.cfem_width != default_setting(setting.model).cfem_width)
        text += format(", light {} wide", setting.cfem_width);
    if (setting.divisor > 1)
        text += format(", map at 1/{} size", setting.divisor);
    return text + (setting.storage == "half" ? ", half" : "");
}

std::string with_half(double value, double half)
{
    return percent_text(value) + " &plusmn; " + percent_text(half);
}

std::vector<std::string> cost_cells(const Point& point)
{
    return { point.bake > 0 ? seconds_text(point.bake) : "&ndash;",
             point.light > 0 ? seconds_text(point.light) : "&ndash;", seconds_text(point.shade),
             point.bytes ? format("{}", point.bytes) : "&ndash;" };
}

std::vector<Point> select(const std::vector<Point>& points, bool traced)
{
    std::vector<Point> found;
    for (const Point& point : points)
        if ((point.setting.model == kTraced) == traced)
            found.push_back(point);
    return found;
}

std::string choice_rows(const std::string& goal, const Point& point, const CommandInputs& commands)
{
    std::vector<std::string> row { goal, setting_text(point.setting), with_half(point.rmse, point.rmse_half),
                                   percent_text(point.rmse_by_visibility) };
    for (const std::string& cell : cost_cells(point))
        row.push_back(cell);
    row.push_back(seconds_text(point.total(kManyPictures)));
    std::string text = cells("td", row);
    const std::string command = command_text(point.setting, commands);
    if (!command.empty())
        text += format("<tr class=command><td colspan={}><code>{}</code></td></tr>\n", row.size(), escaped(command));
    return text;
}

std::string choices(const Report& report)
{
    const std::vector<Point> models = select(report.points, false), traced = select(report.points, true);
    const std::vector<double> reached = goals(models);
    std::string text = "<table>\n"
        + cells("th",
                { "for an error of", "choose", "error", "weighted by visibility", "bake (once)",
                  "filter (per environment)", "shade (per rotation)", "bytes per texel",
                  format("{} rotations", kManyPictures) });
    for (const double goal : reached)
        text += choice_rows(percent_text(goal), *cheapest(models, goal), report.commands);
    if (const Point* best = nearest(models))
        text += choice_rows(reached.empty() ? "nearest" : "the least", *best, report.commands);
    for (const double goal : reached)
        if (const Point* found = cheapest(traced, goal))
            text += choice_rows(percent_text(goal), *found, report.commands);
    return wide(text + "</table>\n");
}

std::string knees(const std::vector<Point>& points)
{
    std::string text = "<table>\n"
        + cells("th",
                { "model", "rays", "error", "weighted by visibility", "worst environment", "95 % of texels below",
                  "bias", "bake", "filter", "shade", "bytes" });
    for (const ModelVariant& model : model_variants()) {
        const std::vector<Point> line = curve(points, model.name);
        if (line.empty())
            continue;
        const Point& at = knee(line);
        std::vector<std::string> row { model.name,
                                       format("{}", at.setting.samples),
                                       with_half(at.rmse, at.rmse_half),
                                       percent_text(at.rmse_by_visibility),
                                       percent_text(at.worst),
                                       percent_text(at.p95),
                                       with_half(at.bias, at.bias_half) };
        for (const std::string& cell : cost_cells(at))
            row.push_back(cell);
        text += cells("td", row);
    }
    return wide(text + "</table>\n");
}

std::string image(const std::string& png, const std::string& alternative)
{
    return format("<img alt=\"{}\" src=\"data:image/png;base64,{}\">", escaped(alternative),
                  OIIO::Strutil::base64_encode(png));
}

std::string heat_maps(const Report& report)
{
    std::string text;
    for (const auto& [environment, pictures] : report.heat_maps) {
        text += format("<h3>{}</h3>\n<div class=heat>\n", escaped(environment));
        for (const Picture& picture : pictures)
            text += format("<figure>{}<figcaption>{}</figcaption></figure>\n",
                           image(picture.png, environment + ", " + picture.caption), escaped(picture.caption));
        text += "</div>\n";
    }
    return text;
}

// The page is text of an attribute, so that the report stays one file.
std::string live_view(const std::string& page)
{
    if (page.empty())
        return "<p class=none>This mesh is too large to be shown live in a report.</p>\n";
    return format("<iframe title=\"The mesh, lit live\" loading=lazy srcdoc=\"{}\"></iframe>\n", escaped(page));
}

std::string effects_table(const std::vector<EffectCost>& effects)
{
    if (effects.empty())
        return "<p class=none>This scene calls for none that could be left out.</p>\n";
    std::string text = "<table class=effects>\n"
        + cells("th",
                { "effect", "with", "without", "share of the time", "V off without it", "light off without it",
                  "called for, because" });
    for (const EffectCost& effect : effects) {
        const double share = effect.seconds > 0 ? 1 - effect.without / effect.seconds : 0;
        text += cells("td",
                      { effect.name, seconds_text(effect.seconds), seconds_text(effect.without), percent_text(share),
                        effect.visibility > 0 ? format("{:.3f}", effect.visibility) : "&ndash;",
                        percent_text(effect.light), escaped(effect.reason) });
    }
    return wide(text + "</table>\n");
}

} // namespace

std::vector<std::string> choice_lines(const std::vector<Point>& points, const CommandInputs& commands)
{
    const std::vector<Point> models = select(points, false);
    std::vector<std::string> lines;
    const auto add = [&](const std::string& goal, const Point& point) {
        lines.push_back(format("{}: {}, {} in {}", goal, setting_text(point.setting), percent_text(point.rmse),
                               seconds_text(point.total())));
        lines.push_back("  " + command_text(point.setting, commands));
    };
    for (const double goal : goals(models))
        add(percent_text(goal), *cheapest(models, goal));
    const Point* best = nearest(models);
    if (best && lines.empty())
        add("nearest", *best);
    return lines;
}

std::string busy_note(double spread)
{
    return spread > kBusySpread ? format(
               "timings are uncertain: repeated runs took {} longer than the shortest; measure again into a new folder "
               "when the machine is idle",
               percent_text(spread))
                                : "";
}

std::string report_html(const Report& report)
{
    std::string text = kHead + format("<title>{0}</title></head><body>\n<h1>{0}</h1>\n", escaped(report.title));
    text += "<h2>What to choose</h2>\n<p>The fastest way to a first picture. Errors are RMS over the surface against "
            "ray tracing, relative to "
            "the mean light, averaged over the environments. A setting reaches an error if its whole confidence "
            "interval is below it. Weighted by visibility, creases that see little of the sky count less. "
            "<i>traced</i> bakes nothing and ray traces the light again for each picture and rotation.</p>\n"
        + choices(report);
    const std::string busy = busy_note(report.spread);
    if (!busy.empty())
        text += "<p class=busy>Note: " + busy + ".</p>\n";
    text += "<h2>What accuracy costs</h2>\n";
    for (const Picture& plot : report.plots)
        text += format("<figure>{}<figcaption>{}</figcaption></figure>\n", plot.svg, escaped(plot.caption));
    if (report.plots.empty())
        text += "<p class=none>No plots: they were disabled.</p>\n";
    text += format("<h2>Each model at its knee</h2>\n<p>The smallest number of rays beyond which the error falls by "
                   "less than {:g} %.</p>\n",
                   100 * kKneeGain)
        + knees(report.points);
    text
        += "<h2>What each effect costs</h2>\n<p>The mesh baked at the reference's size with everything that this scene "
           "calls for, and once more without each effect alone. V and light are off by so much without it, RMS over "
           "the surface; light is that of the model lobe, relative to its mean. Whatever is left out in this way is "
           "gone from the picture (<i>--effects -NAME</i>); what the scene does not call for costs nothing and is not "
           "listed.</p>\n"
        + effects_table(report.effects);
    text += format("<h2>Where the errors are</h2>\n<p>At the default settings, in texture space: red is too bright, "
                   "blue too "
                   "dark, full colour is {:g} % of the mean light or more. Grey is not covered by the mesh.</p>\n",
                   100.0 * kHeatRange)
        + heat_maps(report);
    text += "<h2>What it looks like</h2>\n<p>The mesh, white, baked at the reference's size with the default number of "
            "rays, "
            "in the light of the first environments. Drag to orbit, Shift and drag to turn the light; the panel "
            "compares "
            "models.</p>\n"
        + live_view(report.live_page);
    text += "<h2>How it was measured</h2>\n<p>The reference traces pairs of rays, one sampling the cosine and one the "
            "light, with independent "
            "random numbers. Its variance, estimated per texel, is subtracted from the mean square error. &plusmn; is "
            "half a 95 % confidence interval over texels of the surface and rays of bake and reference, not over "
            "environments, rotations or meshes. The 95th percentile includes the reference's noise. Bake and shade "
            "times "
            "are for the whole map at the reference's size: the minimum of several runs, in memory, without file "
            "access. Shading sets up its lookups each time, which matters for small maps.</p>\n<dl>\n";
    for (const auto& [name, value] : report.facts)
        text += format("<dt>{}</dt><dd>{}</dd>\n", escaped(name), escaped(value));
    return text + "</dl>\n</body></html>\n";
}

} // namespace vmlight::cost
