// SPDX-License-Identifier: Apache-2.0
/// What a bake is going to simulate and why, before it starts: --explain and --dry-run.
#pragma once

#include <vmlight/effects/effect.h>
#include <vmlight/stage/forecast_costs.h>
#include <vmlight/stage/make_options.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/vismap/normal_map.h>
#include <vmlight/vismap/vismap.h>

#include <functional>
#include <string>
#include <vector>

namespace vmlight {

/// The ray-tracing scene of a recipe with its switches, which are not those of the bake.
using SceneOf = std::function<bool(BakeScenePointer& dst, const VismapRecipe& recipe, std::string& error)>;

struct BakeForecast
{
    std::vector<EffectDecision> decisions;
    int64_t covered = 0;
    double bake_seconds = 0; ///< 0 unless a dry run
    int64_t tests = 0; ///< BakeFacts::tests
};

/// Decide on the effects of `recipe` as given, whose scene and normal map with its switches applied are `scene` and
/// `normal_map`. Reports the table if the options ask for it; warns of each effect that is left out though the scene
/// calls for it, with the difference of V with and without, which traces some texels of both scenes.
///
/// @returns false, with the reason in `error`, if the switches ask for what is impossible, or the work was stopped
bool forecast_bake(BakeForecast& dst, const BakeScenePointer& scene, const NormalMapPointer& normal_map,
                   const VismapRecipe& recipe, const SceneOf& scene_of, const MakeOptions& options, std::string& error);

/// Report the expected time and memory of a bake, from the start of the process to its end.
void report_forecast(const BakeForecast& forecast, const VismapRecipe& recipe, const TimeTaken& taken,
                     const MakeOptions& options);

/// Work of the bakes of a scene so far.
struct BakeWork
{
    int64_t hits = 0, lookups = 0; ///< CutoutWork
    int64_t below_ground = 0, margin = 0;

    static BakeWork so_far(const BakeScene& scene);
};

/// Report what the bake really took, since `before`, effect by effect.
void report_taken(const BakeForecast& forecast, const VismapReport& report, const BakeWork& before,
                  const BakeScene& scene, const MakeOptions& options);

} // namespace vmlight
