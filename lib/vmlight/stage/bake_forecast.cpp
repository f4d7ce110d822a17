// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/bake_forecast.h>

#include <vmlight/base/format.h>
#include <vmlight/base/parallel.h>
#include <vmlight/base/text_format.h>
#include <vmlight/base/work_counts.h>
#include <vmlight/effects/bake_facts.h>
#include <vmlight/math/difference.h>
#include <vmlight/stage/bake_switches.h>
#include <vmlight/stage/large_map.h>
#include <vmlight/stage/normal_map_file.h>
#include <vmlight/stage/recipe/recipe_effects.h>
#include <vmlight/vismap/forecast.h>
#include <vmlight/vismap/pose_sequence.h>
#include <vmlight/vismap/reconstruct.h>

#include <algorithm>

namespace vmlight {
namespace {

// Rays per texel where two scenes are compared: V to about .02.
constexpr int kCompared = 64;
// CPU seconds per texel and channel to fill the margin on one thread. Measured on maps of 1024 and 2048, half covered.
constexpr double kMarginSeconds = 10e-9;
// The same per covered texel that is averaged with its neighbours.
constexpr double kReconstructSeconds = 0.4e-6;

VismapParams without_pilot(VismapParams params)
{
    params.target_error = 0;
    params.reconstruct = "off";
    params.channels.erase(std::remove(params.channels.begin(), params.channels.end(), "error"), params.channels.end());
    return params;
}

// What is baked of a recipe.
struct Bake
{
    VismapParams params;
    BakeScenePointer scene;
    NormalMapPointer normal_map;
};

bool find_bake(Bake& dst, const VismapRecipe& recipe, const SceneOf& scene_of, const MakeOptions& options,
               std::string& error)
{
    const VismapRecipe switched = with_switches(recipe);
    std::vector<std::string> ignored;
    dst.params = switched.vismap_params;
    return scene_of(dst.scene, recipe, error)
        && read_normal_map(dst.normal_map, switched, { dst.scene, &dst.scene->mesh() }, options.threads, ignored,
                           ignored, error);
}

// How far V of the texels is from that of another bake.
bool compare_bakes(Difference& dst, const Bake& bake, const Bake& whole, const MakeOptions& options, std::string& error)
{
    std::vector<double> seen[2];
    for (int k = 0; k < 2; ++k) {
        const Bake& own = k ? whole : bake;
        if (!sample_visibility(seen[k], *own.scene, own.normal_map.get(), without_pilot(own.params), kCompared,
                               options.threads, options.step("compare", 0, 0))) {
            error = "interrupted";
            return false;
        }
    }
    for (size_t i = 0; i < seen[0].size(); ++i)
        dst.add(seen[0][i], seen[1][i]);
    return true;
}

// The facts of the recipe. Each effect is judged beside the others as they are switched, itself not switched off.
bool find_facts(BakeFacts& dst, const Bake& bake, const VismapBaker& baker, int64_t covered, const VismapRecipe& recipe,
                const SceneOf& scene_of, BakeScenePointer& kept, const MakeOptions& options, std::string& error)
{
    VismapRecipe asked = recipe;
    asked.effects = without_words(recipe.effects, { "-self-occlusion", "-cut-outs" });
    kept = bake.scene;
    if (asked.effects != recipe.effects) {
        VismapBaker other;
        if (!scene_of(kept, asked, error)
            || !other.prepare(kept, without_pilot(baker.params()), error, options.threads))
            return false;
        dst = bake_facts(*kept, other, covered);
    } else {
        dst = bake_facts(*bake.scene, baker, covered);
    }
    NormalMapPointer normal_map = bake.normal_map;
    std::vector<std::string> ignored;
    if (switches_of(recipe.effects, VismapRecipe::kStage).of("normal-map") == Switch::off
        && !read_normal_map(normal_map, recipe, { kept, &kept->mesh() }, options.threads, ignored, ignored, error))
        return false;
    const VismapParams& given = recipe.vismap_params;
    dst.has_ground = given.ground;
    if (given.ground_height != VismapParams::kLowest)
        dst.ground_height = given.ground_height;
    dst.faces_up = dst.faces_up && !bake.normal_map;
    dst.no_cutouts = recipe.cutout_params.cutouts == "off";
    dst.has_normal_map = recipe.has_normal_map();
    dst.has_flat_normal_map = recipe.has_normal_map() && !normal_map;
    dst.has_material_normals = recipe.material_normals;
    dst.given_reach = given.max_distance;
    dst.no_reconstruct = why_not_reconstructed(recipe);
    dst.margin = given.margin;
    dst.udim_given = recipe.udim_given;
    dst.half = options.half;
    dst.poses = options.pose_count;
    dst.pose_error = options.poses ? options.poses->error() : -1;
    return true;
}

bool warn_of_missing(const std::string& missing, const Bake& bake, const VismapRecipe& recipe, const SceneOf& scene_of,
                     const MakeOptions& options, std::string& error)
{
    VismapRecipe asked = recipe;
    asked.effects = "auto";
    Bake whole;
    Difference off;
    if (!find_bake(whole, asked, scene_of, options, error) || !compare_bakes(off, bake, whole, options, error))
        return false;
    if (off.rms() > 0)
        options.report_warning(
            format("effects: {} switched off, which changes this scene: V is off by about {:.2g} (RMS), light by that "
                   "share of the open sky's",
                   missing, off.rms()));
    return true;
}

} // namespace

bool forecast_bake(BakeForecast& dst, const BakeScenePointer& scene, const NormalMapPointer& normal_map,
                   const VismapRecipe& recipe, const SceneOf& scene_of, const MakeOptions& options, std::string& error)
{
    const Bake bake { with_switches(recipe).vismap_params, scene, normal_map };
    VismapBaker baker;
    VismapParams params = options.dry_run ? bake.params : without_pilot(bake.params);
    params.skip_open = true; // a fact, whether it is made use of or not
    MapForecast map;
    if (!baker.prepare(scene, params, error, options.threads, options.step("prepare", 0, 0),
                       options.dry_run ? recipe.time_budget : 0))
        return false;
    if (!forecast_map(map, *scene, baker, options.dry_run, bake.params.skip_open, options.threads,
                      options.step("prepare", 0, 0))) {
        error = "interrupted";
        return false;
    }
    EffectFacts facts;
    BakeScenePointer kept; // for the comparison to share
    if (!find_facts(facts.bake, bake, baker, map.covered, recipe, scene_of, kept, options, error)
        || !decide_effects(dst.decisions, VismapRecipe::kStage, facts,
                           switches_of(recipe.effects, VismapRecipe::kStage), error))
        return false;
    dst.covered = map.covered;
    dst.bake_seconds = map.seconds;
    dst.tests = facts.bake.tests;
    if (options.explain || options.dry_run) {
        options.report_answer("effects:");
        for (const std::string& line : decision_lines(dst.decisions))
            options.report_answer(line);
    }
    const std::string missing = left_out(dst.decisions);
    return missing.empty() || options.repeated_inputs
        || warn_of_missing(missing, bake, recipe, scene_of, options, error);
}

void report_forecast(const BakeForecast& forecast, const VismapRecipe& recipe, const TimeTaken& taken,
                     const MakeOptions& options)
{
    const OIIO::ImageSpec spec = describe_vismap("", recipe.vismap_params);
    const double values = double(spec.image_pixels()) * spec.nchannels;
    // Poses of a sequence keep texels of each other: how many, only their bakes say.
    const double poses = options.poses ? double(options.pose_count) : 1;
    const double margin = poses * (recipe.vismap_params.margin != 0 ? values * kMarginSeconds : 0);
    const double average = is_reconstructed(recipe.vismap_params)
        ? double(forecast.covered) * kReconstructSeconds / worker_count(options.threads)
        : 0;
    const double bake = poses
        * (average
           + (recipe.time_budget > 0 && forecast.bake_seconds > recipe.time_budget ? recipe.time_budget
                                                                                   : forecast.bake_seconds));
    const double write = poses * write_seconds(spec, options.threads), read = poses * taken.read;
    const double bytes = expected_bytes(map_bytes(recipe, options));
    const double start = options.forecasts ? options.forecasts->start(taken) : start_seconds(taken);
    const double seconds = start + read + bake + margin + write;
    if (options.forecasts)
        options.forecasts->add(seconds, bytes);
    const std::string compared = !options.poses && options.pose_count > 1
        ? format("; comparing {} comes on top", count_text(options.pose_count - 1, "other pose", "other poses"))
        : "";
    options.report_answer(
        format("expected: {}{:.2f} s: start {:.2f} s, read and build {:.2f} s, bake {:.2f} s, margin and "
               "file {:.2f} s; {:.0f} MB of memory{}{}",
               poses > 1 ? "at most " : "", seconds, start, read, bake, margin + write, bytes / 1e6,
               poses > 1 ? format("; each of {:.0f} poses baked whole", poses) : "", compared));
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
    options.report_answer(
        format("took: {:.2f} M rays ({:.1f} per covered texel); {:.1f} % of covered texels traced none; bake "
               "{:.2f} s, build {:.2f} s, margin {:.2f} s",
               double(report.rays) * 1e-6, double(report.rays) / covered, 100 * double(report.open) / covered,
               report.bake_seconds, report.build_seconds, report.margin_seconds));
    const BakeWork now = BakeWork::so_far(scene);
    options.report_answer(
        format("  deciding: {:.3f} M boxes and vertices compared with horizons", double(forecast.tests) * 1e-6));
    if (const int64_t hits = now.hits - before.hits; hits > 0)
        options.report_answer(format("  cut-outs: {:.2f} M hits looked up an opacity, {:.1f} % of them in the texture",
                                     double(hits) * 1e-6, 100 * double(now.lookups - before.lookups) / double(hits)));
    if (const int64_t blocked = now.below_ground - before.below_ground; blocked > 0)
        options.report_answer(format("  ground: {:.2f} M directions blocked without a ray", double(blocked) * 1e-6));
    if (report.reconstruct_seconds > 0)
        options.report_answer(format("  reconstruction: {:.3f} M texels in {:.2f} s", double(report.covered) * 1e-6,
                                     report.reconstruct_seconds));
    if (const int64_t filled = now.margin - before.margin; filled > 0)
        options.report_answer(format("  margin: {:.3f} M texels filled", double(filled) * 1e-6));
}

} // namespace vmlight
