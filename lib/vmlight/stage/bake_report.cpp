// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/bake_report.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/stage/overlap_hint.h>
#include <vmlight/stage/uv_warnings.h>
#include <vmlight/vismap/reconstruct.h>

#include <algorithm>

namespace vmlight {
namespace {

// Triangles in other tiles are news only to those who asked for no tile; those across a border, or in no tile, to
// everyone.
void report_outside(const MakeOptions& options, const UvReport& uv, const VismapRecipe& recipe)
{
    const auto warn = [&](const std::string& line) { options.report_warning(line); };
    const int64_t across = uv.outside - uv.fully_outside, in_others = uv.outside - uv.beyond_udims;
    if (!recipe.udim_given && in_others > 0)
        warn(format("{} of {} {} outside [0,1] in UV, into other UDIM tiles: that part is not baked; <UDIM> in -o "
                    "bakes every tile",
                    in_others, count_text(uv.triangles, "triangle", "triangles"),
                    plural(in_others, "reaches", "reach")));
    if (recipe.udim_given && across > 0)
        warn(format("{} of {} {} outside tile {} in UV: the part outside is not in this map", across,
                    count_text(uv.triangles, "triangle", "triangles"), plural(across, "reaches", "reach"),
                    recipe.vismap_params.udim));
    if (uv.beyond_udims > 0 && !options.repeated_inputs)
        warn(beyond_udims_warning(uv));
}

// Triangles of the tile that are not baked, and those too small to bake well.
void report_lost(const MakeOptions& options, const VismapReport& report)
{
    const UvReport& uv = report.uv;
    if (uv.uncovered_islands > 0 && options.warn)
        options.warn(format(
            "{} of {} in UV ({}) {} no texel and {} not baked: thinner than a texel, without area, or too far away",
            uv.uncovered_islands, count_text(uv.islands, "island", "islands"),
            count_text(uv.uncovered_triangles, "triangle", "triangles"),
            plural(uv.uncovered_islands, "covers", "cover"), plural(uv.uncovered_islands, "is", "are")));
    if (report.tiny > 0 && options.warn && !options.repeated_inputs)
        options.warn(format("{} of {} {} smaller than 4e-6 of the mesh: occluders closer to {} than that are missed",
                            report.tiny, count_text(uv.triangles, "triangle", "triangles"),
                            plural(report.tiny, "is", "are"), plural(report.tiny, "it", "them")));
}

// What the mesh's file and those of its occluders say.
void report_files(const MakeOptions& options, const VismapReport& report)
{
    if (options.repeated_inputs || options.repeated_mesh)
        return;
    if (!report.normals_from.empty())
        options.report("normals: " + report.normals_from);
    for (const std::string& warning : report.warnings)
        options.report_warning(warning);
}

void report_overlap(const MakeOptions& options, const VismapReport& report, const VismapRecipe& recipe,
                    const Mesh& mesh)
{
    if (report.overlapping == 0 || !options.warn)
        return;
    const std::string hint
        = has_heavy_overlap(report) && !options.repeated_inputs ? overlap_hint(report, mesh, recipe) : "";
    options.warn(format(
        "{} ({:.2f} % of the covered ones) {} to more than one triangle: the first triangle in the file wins{}{}",
        count_text(report.overlapping, "texel", "texels"), percent_of(report.overlapping, report.covered),
        plural(report.overlapping, "belongs", "belong"), hint.empty() ? "" : ". ", hint));
}

// From where rounding is as large as the smallest gap that separates two surfaces.
void report_rounding(const MakeOptions& options, const VismapReport& report)
{
    if (report.rounding > 1e-6 && options.warn && !options.repeated_inputs)
        options.warn(
            format("the mesh is so far from the origin that its float coordinates are rounded to {:.1g} of its "
                   "size: move it closer to the origin",
                   report.rounding));
}

std::string error_line(const VismapReport& report, bool is_reconstructed)
{
    if (is_reconstructed)
        return format("error: {:.2g} (RMS of V, from texels that were traced with more rays) at {} per texel; {:.2f} s",
                      report.error, count_text(report.samples, "ray", "rays"), report.pilot_seconds);
    const std::string texels = count_text(report.error_texels, "texel", "texels");
    const std::string rays = count_text(report.samples, "ray", "rays");
    if (report.error == 0)
        return format("error: 0 ({} baked twice {} identical) at {} per texel; {:.2f} s", texels,
                      plural(report.error_texels, "is", "are"), rays, report.pilot_seconds);
    return format("error: {:.2g} (RMS of V, from {} baked twice) at {} per texel; {:.2f} s", report.error, texels, rays,
                  report.pilot_seconds);
}

} // namespace

std::string dark_warning(int64_t dark, int64_t covered)
{
    return dark > covered / 2 ? format("{:.0f} % of the covered texels see no light: normals that point inwards, or "
                                       "surfaces inside others or below the ground?",
                                       percent_of(dark, covered))
                              : "";
}

void report_bake(const MakeOptions& options, const VismapReport& report, const OIIO::ImageSpec& spec,
                 const VismapRecipe& recipe, const Mesh& mesh)
{
    const auto say = [&](const std::string& line) { options.report(line); };
    const auto warn = [&](const std::string& line) { options.report_warning(line); };
    const UvReport& uv = report.uv;
    const std::string tile = recipe.udim_given ? format("tile {}", recipe.vismap_params.udim) : "[0,1]";
    report_files(options, report);
    say(format(
        "uv: {} {} {:.1f} % of {}x{} texels; {} {}; triangles: {} reach outside {}, {} in other tiles, {} mirrored, "
        "{} without area in UV, {} in space, {} without UVs",
        uv.triangles, plural(uv.triangles, "triangle covers", "triangles cover"),
        percent_of(report.covered, report.texels), spec.width, spec.height, report.overlapping,
        plural(report.overlapping, "texel is shared", "texels are shared"), uv.outside - uv.fully_outside, tile,
        uv.fully_outside, uv.mirrored, uv.degenerate_uv, uv.degenerate_3d, uv.without_uv));
    say(format("bake: {:.2f} M rays in {:.2f} s, {:.2f} M rays/s; build {:.2f} s, margin {:.2f} s",
               double(report.rays) * 1e-6, report.bake_seconds,
               double(report.rays) * 1e-6 / std::max(report.bake_seconds, 1e-9), report.build_seconds,
               report.margin_seconds));
    if (is_reconstructed(recipe.vismap_params))
        say(format("reconstruct: from neighbours within {} texels; {:.2f} s", NeighbourWindow::kReach,
                   report.reconstruct_seconds));
    if (report.error_texels > 0)
        say(error_line(report, is_reconstructed(recipe.vismap_params)));
    if (report.expected_seconds > recipe.time_budget)
        warn(format("time_budget: even {} per texel, the minimum, {} about {:.2g} s, more than {:.6g}",
                    count_text(report.samples, "ray", "rays"), plural(report.samples, "takes", "take"),
                    report.expected_seconds, recipe.time_budget));
    report_overlap(options, report, recipe, mesh);
    report_outside(options, uv, recipe);
    if (uv.without_uv > 0 && !options.repeated_inputs)
        warn(without_uv_warning(uv));
    report_lost(options, report);
    report_rounding(options, report);
    if (report.covered == 0)
        warn("no texel centre is covered: the map is empty");
    else if (const std::string warning = dark_warning(report.dark, report.covered); !warning.empty())
        warn(warning);
}

} // namespace vmlight
