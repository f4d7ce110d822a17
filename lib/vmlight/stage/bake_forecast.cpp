// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/bake_forecast.h>

#include <vmlight/base/format.h>
#include <vmlight/base/work_counts.h>
#include <vmlight/effects/bake_facts.h>
#include <vmlight/stage/bake_switches.h>
#include <vmlight/stage/normal_map_file.h>
#include <vmlight/vismap/forecast.h>
#include <vmlight/vismap/pose_sequence.h>

#include <algorithm>
#include <cmath>

namespace vmlight {
namespace {

// Rays per texel where two scenes are compared: V to about .02.
constexpr int kCompared = 64;
// CPU seconds per texel and channel to fill the margin on one thread. Measured on maps of 1024 and 2048, half covered.
constexpr double kMarginSeconds = 10e-9;

VismapParams without_pilot(VismapParams params)
{
    params.target_error = 0;
    params.channels.erase(std::remove(params.channels.begin(), params.channels.end(), "error"), params.channels.end());
    return params;
}

// How far V of the texels is from that of the recipe without its switches.
bool compare(double& rms, const BakeScenePointer& scene, const VismapRecipe& recipe, const SceneOf& scene_of,
             const MakeOptions& options, std::string& error)
{
    VismapRecipe whole = recipe;
    whole.effects = "auto";
    BakeScenePointer other;
    if (!scene_of(other, whole, error))
        return false;
    const VismapRecipe both[2] { with_switches(recipe), whole };
    std::vector<double> seen[2];
    for (int k = 0; k < 2; ++k) {
        const BakeScenePointer& own = k ? other : scene;
        NormalMapPointer normal_map;
        std::vector<std::string> ignored;
        if (!read_normal_map(normal_map, both[k], { own, &own->mesh() }, options.threads, ignored, ignored, error))
            return false;
        if (!sample_visibility(seen[k], *own, normal_map.get(), without_pilot(both[k].vismap_params), kCompared,
                               options.threads, options.step("compare", 0, 0))) {
            error = "interrupted";
            return false;
        }
    }
    double sum = 0;
    for (size_t i = 0; i < seen[0].size(); ++i)
        sum += std::pow(seen[0][i] - seen[1][i], 2);
    rms = seen[0].empty() ? 0 : std::sqrt(sum / double(seen[0].size()));
    return true;
}

} // namespace

bool forecast_bake(BakeForecast& dst, const BakeScenePointer& scene, const NormalMapPointer& normal_map,
                   const VismapRecipe& recipe, const SceneOf& scene_of, const MakeOptions& options, std::string& error)
{
    const VismapRecipe switched = with_switches(recipe);
    const EffectSwitches switches = switches_of(recipe.effects, VismapRecipe::kStage);
    VismapBaker baker;
    VismapParams params = options.dry_run ? switched.vismap_params : without_pilot(switched.vismap_params);
    params.skip_open = true; // a fact, whether it is made use of or not
    MapForecast map;
    if (!baker.prepare(scene, params, error, options.threads, options.step("prepare", 0, 0),
                       options.dry_run ? recipe.time_budget : 0))
        return false;
    if (!forecast_map(map, *scene, baker, options.dry_run, switched.vismap_params.skip_open, options.threads,
                      options.step("prepare", 0, 0))) {
        error = "interrupted";
        return false;
    }
    EffectFacts facts;
    facts.bake = bake_facts(*scene, baker, map.covered);
    facts.bake.has_ground = recipe.vismap_params.ground;
    if (recipe.vismap_params.ground_height != VismapParams::kLowest)
        facts.bake.ground_height = recipe.vismap_params.ground_height;
    if (switches.of("cut-outs") == Switch::off) {
        VismapRecipe whole = recipe;
        whole.effects = "auto";
        BakeScenePointer other;
        if (!scene_of(other, whole, error))
            return false;
        facts.bake.cutouts = other->occluder().cutouts();
    }
    facts.bake.has_normal_map = recipe.has_normal_map();
    facts.bake.has_flat_normal_map = switched.has_normal_map() && !normal_map;
    facts.bake.has_material_normals = recipe.material_normals;
    facts.bake.reach = recipe.vismap_params.max_distance;
    facts.bake.margin = recipe.vismap_params.margin;
    facts.bake.udim_given = recipe.udim_given;
    facts.bake.half = options.half;
    facts.bake.poses = options.pose_count;
    facts.bake.pose_error = options.poses ? options.poses->error() : -1;
    if (!decide_effects(dst.decisions, VismapRecipe::kStage, facts, switches, error))
        return false;
    dst.covered = map.covered;
    dst.bake_seconds = map.seconds;
    dst.tests = facts.bake.tests;
    if (options.explain || options.dry_run) {
        options.report("effects:");
        for (const std::string& line : decision_lines(dst.decisions))
            options.report(line);
    }
    const std::string missing = left_out(dst.decisions);
    if (missing.empty() || options.repeated_inputs)
        return true;
    double rms = 0;
    if (!compare(rms, scene, recipe, scene_of, options, error))
        return false;
    options.report_warning(
        format("effects: the scene calls for {}, left out: V is off by about {:.2g} (RMS), and so is "
               "light by that share of the open sky's",
               missing, rms));
    return true;
}

void report_forecast(const BakeForecast& forecast, const VismapRecipe& recipe, const TimeTaken& taken,
                     const MakeOptions& options)
{
    const OIIO::ImageSpec spec = describe_vismap("", recipe.vismap_params);
    const double values = double(spec.image_pixels()) * spec.nchannels;
    const double margin = recipe.vismap_params.margin != 0 ? values * kMarginSeconds : 0;
    const double bake = recipe.time_budget > 0 && forecast.bake_seconds > recipe.time_budget ? recipe.time_budget
                                                                                             : forecast.bake_seconds;
    const double write = write_seconds(spec, options.threads);
    // The map, and what the file's writer holds of it.
    const double bytes = expected_bytes(spec, 1.5);
    const double start = start_seconds(taken);
    options.report(format("expected: {:.2f} s: start {:.2f} s, read and build {:.2f} s, bake {:.2f} s, margin and file "
                          "{:.2f} s; {:.0f} MB of memory",
                          start + taken.read + bake + margin + write, start, taken.read, bake, margin + write,
                          bytes / 1e6));
}

BakeWork BakeWork::so_far(const BakeScene& scene)
{
    const CutoutWork cutouts = scene.occluder().cutout_work();
    return { cutouts.hits, cutouts.lookups, work_counts().directions_below_ground, work_counts().margin_texels };
}

void report_taken(const BakeForecast& forecast, const VismapReport& report, const BakeWork& before,
                  const BakeScene& scene, const MakeOptions& options)
{
    const double covered = double(std::max<int64_t>(1, report.covered));
    options.report(
        format("took: {:.2f} M rays ({:.1f} per covered texel); {:.1f} % of covered texels traced none; bake "
               "{:.2f} s, build {:.2f} s, margin {:.2f} s",
               double(report.rays) * 1e-6, double(report.rays) / covered, 100 * double(report.open) / covered,
               report.bake_seconds, report.build_seconds, report.margin_seconds));
    const BakeWork now = BakeWork::so_far(scene);
    options.report(
        format("  deciding: {:.3f} M boxes and vertices compared with horizons", double(forecast.tests) * 1e-6));
    if (const int64_t hits = now.hits - before.hits; hits > 0)
        options.report(format("  cut-outs: {:.2f} M hits asked, {:.1f} % of them the texture", double(hits) * 1e-6,
                              100 * double(now.lookups - before.lookups) / double(hits)));
    if (const int64_t blocked = now.below_ground - before.below_ground; blocked > 0)
        options.report(format("  ground: {:.2f} M directions blocked without a ray", double(blocked) * 1e-6));
    if (const int64_t filled = now.margin - before.margin; filled > 0)
        options.report(format("  margin: {:.3f} M texels filled", double(filled) * 1e-6));
}

} // namespace vmlight
