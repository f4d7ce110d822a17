// SPDX-License-Identifier: Apache-2.0
/// What a bake is going to simulate and why, before it starts: --explain and --dry-run.
#pragma once

#include <vmlight/effects/effect.h>
#include <vmlight/stage/make_options.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/vismap/normal_map.h>
#include <vmlight/vismap/vismap.h>

#include <functional>
#include <string>
#include <vector>

namespace vmlight {

/// The scene of a recipe, with other switches.
using SceneOf = std::function<bool(BakeScenePointer& dst, const VismapRecipe& recipe, std::string& error)>;

struct BakeForecast
{
    std::vector<EffectDecision> decisions;
    int64_t covered = 0;
    double bake_seconds = 0; ///< 0 unless a dry run
};

/// Decide on the effects of `recipe` as given, whose scene and normal map with its switches applied are `scene` and
/// `normal_map`. Reports the table if the options ask for it; warns of each effect that is left out though the scene
/// calls for it, with the difference of V with and without, which traces some texels of both scenes.
///
/// @returns false, with the reason in `error`, if the switches ask for what is impossible, or the work was stopped
bool forecast_bake(BakeForecast& dst, const BakeScenePointer& scene, const NormalMapPointer& normal_map,
                   const VismapRecipe& recipe, const SceneOf& scene_of, const MakeOptions& options, std::string& error);

/// Seconds since the forecast began: until the scene was built, and of the processor by all threads.
struct TimeTaken
{
    double read = 0, processor = 0;
};

/// Report the expected time and memory of a bake, from the start of the process to its end.
void report_forecast(const BakeForecast& forecast, const VismapRecipe& recipe, const TimeTaken& taken,
                     const MakeOptions& options);

/// Report what the bake really took.
void report_taken(const VismapReport& report, const MakeOptions& options);

} // namespace vmlight
