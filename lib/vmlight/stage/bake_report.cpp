// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/bake_report.h>

#include <vmlight/base/words.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>

namespace vmlight {
namespace {

using OIIO::Strutil::fmt::format;

double percent(int64_t part, int64_t whole)
{
    return whole ? 100.0 * double(part) / double(whole) : 0.0;
}

// What lies in other tiles surprises only who did not ask for one; what straddles a border, and what no tile has,
// everyone.
void report_outside(const MakeOptions& options, const UvReport& uv, const VismapRecipe& recipe)
{
    const auto warn = [&](const std::string& line) { options.warn ? options.warn(line) : void(); };
    const int64_t across = uv.outside - uv.fully_outside;
    if (!recipe.udim_given && uv.outside > 0)
        warn(format("{} of {} {} out of [0,1] in uv: what lies outside is not baked{}", uv.outside,
                    counted(uv.triangles, "triangle", "triangles"), plural(uv.outside, "reaches", "reach"),
                    uv.outside > uv.beyond_udims ? "; it is in other UDIM tiles, see udim" : ""));
    if (recipe.udim_given && across > 0)
        warn(format("{} of {} {} out of tile {} in uv: what lies outside is not in its map", across,
                    counted(uv.triangles, "triangle", "triangles"), plural(across, "reaches", "reach"),
                    recipe.vismap_params.udim));
    if (recipe.udim_given && uv.beyond_udims > 0 && !options.again)
        warn(format("{} of {} {} out of all UDIM tiles, to u below 0 or above 10 or v below 0: what lies there is not "
                    "baked",
                    uv.beyond_udims, counted(uv.triangles, "triangle", "triangles"),
                    plural(uv.beyond_udims, "reaches", "reach")));
}

// What is not baked although its triangles are in the tile, and what is baked from too far away.
void report_lost(const MakeOptions& options, const VismapReport& report)
{
    const UvReport& uv = report.uv;
    if (uv.uncovered_islands > 0 && options.warn)
        options.warn(
            format("{} of {} in uv ({}) {} no texel: {} thinner than one, without area or too far out, and not baked",
                   uv.uncovered_islands, counted(uv.islands, "island", "islands"),
                   counted(uv.uncovered_triangles, "triangle", "triangles"),
                   plural(uv.uncovered_islands, "covers", "cover"), plural(uv.uncovered_islands, "it is", "they are")));
    if (report.tiny > 0 && options.warn && !options.again)
        options.warn(format("{} of {} {} smaller than 4e-6 of the mesh: what lies as near to {} as that is not seen",
                            report.tiny, counted(uv.triangles, "triangle", "triangles"),
                            plural(report.tiny, "is", "are"), plural(report.tiny, "it", "them")));
}

// Warned of from where rounding is as large as the least gap through which surfaces are told apart.
void report_rounding(const MakeOptions& options, const VismapReport& report)
{
    if (report.rounding > 1e-6 && options.warn && !options.again)
        options.warn(
            format("the mesh lies so far from the origin that floats, which its coordinates are, round them to "
                   "{:.1g} of its size",
                   report.rounding));
}

std::string error_line(const VismapReport& report)
{
    const std::string texels = counted(report.error_texels, "texel", "texels");
    const std::string rays = counted(report.samples, "ray", "rays");
    if (report.error == 0)
        return format("error: 0 ({} baked twice {} the same both times) at {} a texel; {:.2f} s", texels,
                      plural(report.error_texels, "is", "are"), rays, report.pilot_seconds);
    return format("error: {:.2g} (RMS of V, from {} baked twice) at {} a texel; {:.2f} s", report.error, texels, rays,
                  report.pilot_seconds);
}

} // namespace

void report_bake(const MakeOptions& options, const VismapReport& report, const OIIO::ImageSpec& spec,
                 const VismapRecipe& recipe)
{
    const auto say = [&](const std::string& line) { options.say ? options.say(line) : void(); };
    const auto warn = [&](const std::string& line) { options.warn ? options.warn(line) : void(); };
    const UvReport& uv = report.uv;
    const std::string tile = recipe.udim_given ? format("tile {}", recipe.vismap_params.udim) : "[0,1]";
    say(format(
        "uv: {} {} {:.1f} % of {}x{} texels; {} {}; triangles: {} reach out of {}, {} lie elsewhere, {} mirrored, "
        "{} without area in uv, {} in space, {} without uv",
        uv.triangles, plural(uv.triangles, "triangle covers", "triangles cover"),
        percent(report.covered, report.texels), spec.width, spec.height, report.overlapping,
        plural(report.overlapping, "texel overlaps", "texels overlap"), uv.outside - uv.fully_outside, tile,
        uv.fully_outside, uv.mirrored, uv.degenerate_uv, uv.degenerate_3d, uv.without_uv));
    say(format("bake: {:.2f} M rays in {:.2f} s, {:.2f} M rays/s; build {:.2f} s, margin {:.2f} s",
               double(report.rays) * 1e-6, report.bake_seconds,
               double(report.rays) * 1e-6 / std::max(report.bake_seconds, 1e-9), report.build_seconds,
               report.margin_seconds));
    if (report.error_texels > 0)
        say(error_line(report));
    if (report.expected_seconds > recipe.time_budget)
        warn(format("time_budget: {} a texel, the least there is, {} about {:.2g} s, not {:.6g}",
                    counted(report.samples, "ray", "rays"), plural(report.samples, "takes", "take"),
                    report.expected_seconds, recipe.time_budget));
    if (report.overlapping > 0)
        warn(
            format("{} ({:.2f} % of those covered) {} to more than one triangle: the first triangle of the file has {}",
                   counted(report.overlapping, "texel", "texels"), percent(report.overlapping, report.covered),
                   plural(report.overlapping, "belongs", "belong"), plural(report.overlapping, "it", "them")));
    report_outside(options, uv, recipe);
    if (uv.without_uv > 0 && !options.again)
        warn(format("{} of {} {}", uv.without_uv, counted(uv.triangles, "triangle", "triangles"),
                    plural(uv.without_uv, "has no uv: it casts, and is not baked",
                           "have no uv: they cast, and are not baked")));
    report_lost(options, report);
    report_rounding(options, report);
    if (report.covered == 0)
        warn("no texel centre is covered: the map is empty");
    else if (report.dark > report.covered / 2)
        warn(format("{:.0f} % of the covered texels see nothing: do the normals point inwards?",
                    percent(report.dark, report.covered)));
}

} // namespace vmlight
