// SPDX-License-Identifier: Apache-2.0
#include "effects.h"

#include "bounce_bench.h"
#include "lights.h"
#include "map_differences.h"
#include "timing.h"

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/base/text_format.h>
#include <vmlight/image/channels.h>
#include <vmlight/lightmap/sun_light.h>
#include <vmlight/stage/bake_forecast.h>
#include <vmlight/stage/bake_switches.h>
#include <vmlight/stage/normal_map_file.h>
#include <vmlight/stage/scene_cache.h>
#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/sun_visibility.h>

#include <algorithm>

namespace vmlight::cost {
namespace {

constexpr int kLightWidth = 128;
constexpr const char* kEffectModel = "lobe";

bool stage_failed(const OIIO::ImageBuf& image, std::string& error)
{
    error = oiio::error_line(image);
    return false;
}

// A map, and the light on it under each environment.
struct EffectPicture
{
    OIIO::ImageBuf map;
    std::vector<OIIO::ImageBuf> lit;
    Timing bake;
};

class EffectBench
{
public:
    EffectBench(const Inputs& inputs, const CostParams& params, const MakeOptions& options, const Progress& progress)
        : m_inputs(inputs)
        , m_options(options)
        , m_progress(progress)
        , m_lights(inputs, params, options)
    {
        m_quiet.threads = options.threads;
    }

    bool bake(EffectPicture& dst, const VismapRecipe& recipe, std::string& error)
    {
        const VismapRecipe switched = with_switches(recipe);
        BakeScenePointer scene;
        NormalMapPointer normal_map;
        if (!scene_of(scene, recipe, error) || !read_normals(normal_map, switched, scene, error))
            return false;
        const auto make = [&] {
            return make_vismap(dst.map, scene, switched.vismap_params, nullptr, m_options.threads, m_progress, 0,
                               normal_map);
        };
        if (!measure_time(dst.bake, make))
            return stage_failed(dst.map, error);
        dst.lit.resize(m_inputs.environments.size());
        for (size_t i = 0; i < dst.lit.size(); ++i) {
            const FilteredLight* light = find_light(i, false, error);
            if (!light || !shade(dst.lit[i], dst.map, *light, nullptr, error))
                return false;
        }
        return true;
    }

    bool decide(std::vector<EffectDecision>& dst, const VismapRecipe& recipe, std::string& error)
    {
        BakeForecast forecast;
        NormalMapPointer normal_map;
        if (!read_normals(normal_map, recipe, m_inputs.scene, error))
            return false;
        const SceneOf scenes = [this](BakeScenePointer& scene, const VismapRecipe& other, std::string& reason) {
            return scene_of(scene, other, reason);
        };
        if (!forecast_bake(forecast, m_inputs.scene, normal_map, recipe, scenes, m_quiet, error))
            return false;
        dst = forecast.decisions;
        return true;
    }

    // Suns, split off and traced, against suns that stay in the environment. Nothing is added if there are none.
    bool add_suns(std::vector<EffectCost>& dst, const EffectPicture& plain, const VismapRecipe& recipe,
                  std::string& error)
    {
        EffectCost cost { "suns", "", 0, 0, 0, 0 };
        size_t found = 0, sunny = 0;
        SunTracer tracer;
        for (size_t i = 0; i < plain.lit.size(); ++i) {
            const FilteredLight *split = find_light(i, true, error), *whole = find_light(i, false, error);
            if (!split || !whole)
                return false;
            if (split->suns.empty())
                continue;
            NormalMapPointer normal_map;
            if (found == 0
                && (!read_normals(normal_map, recipe, m_inputs.scene, error)
                    || !tracer.prepare(m_inputs.scene, recipe.vismap_params, error, m_options.threads, m_progress,
                                       normal_map)))
                return false;
            found += split->suns.size();
            ++sunny;
            OIIO::ImageBuf lit, without;
            SunLight suns { split->suns, plain.map.roi(), {} };
            std::vector<Disc> discs;
            for (const Sun& sun : suns.suns)
                discs.push_back(sun.disc);
            Timing with_suns, without_suns;
            if (!measure_time(with_suns,
                              [&] {
                                  return tracer.trace(suns.visibility, discs, m_options.threads, m_progress)
                                      && shade(lit, plain.map, *split, &suns, error);
                              })
                || !measure_time(without_suns, [&] { return shade(without, plain.map, *whole, nullptr, error); })) {
                error = error.empty() ? "interrupted" : error;
                return false;
            }
            cost.seconds += with_suns.seconds;
            cost.without += without_suns.seconds;
            cost.light += light_difference(without, lit, plain.map);
        }
        if (sunny == 0)
            return true;
        for (double* mean : { &cost.seconds, &cost.without, &cost.light })
            *mean /= double(sunny);
        cost.reason = format("{} in {} of {}; seconds are of one rotation", count_text(int64_t(found), "sun", "suns"),
                             sunny, count_text(int64_t(plain.lit.size()), "environment", "environments"));
        dst.push_back(cost);
        return true;
    }

    // One bounce against the sky's light alone. Nothing is added if no texel gets any.
    bool add_bounce(std::vector<EffectCost>& dst, const EffectPicture& plain, const VismapRecipe& recipe,
                    std::string& error)
    {
        BakeScenePointer scene;
        VismapRecipe whole = recipe;
        whole.cull_occluders = false;
        if (!scene_of(scene, whole, error))
            return false;
        BounceBench bench(scene, recipe.vismap_params.udim, plain.map, m_options.threads, m_progress);
        EffectCost cost { "bounce", "", 0, 0, 0, 0 };
        double first = 0;
        for (size_t i = 0; i < plain.lit.size(); ++i) {
            const FilteredLight* light = find_light(i, false, error);
            OIIO::ImageBuf lit, without;
            const Stopwatch whole_time;
            if (!light || !bench.light(lit, light->images, kEffectModel, error))
                return false;
            if (i == 0)
                first = whole_time();
            if (!bench.has_bounce())
                return true;
            Timing with_bounce, without_bounce;
            if (!measure_time(with_bounce, [&] { return bench.light(lit, light->images, kEffectModel, error); })
                || !measure_time(without_bounce, [&] { return shade(without, plain.map, *light, nullptr, error); }))
                return false;
            cost.seconds += with_bounce.seconds;
            cost.without += without_bounce.seconds;
            cost.light += light_difference(without, lit, plain.map);
        }
        for (double* mean : { &cost.seconds, &cost.without, &cost.light })
            *mean /= double(plain.lit.size());
        cost.reason
            = format("surfaces send back {} of their light; seconds are of one light, after {:.2g} s of tracing",
                     bench.albedo(), first);
        dst.push_back(cost);
        return true;
    }

private:
    bool scene_of(BakeScenePointer& dst, const VismapRecipe& recipe, std::string& error) const
    {
        SceneStamps stamps;
        std::string at;
        const VismapRecipe switched = with_switches(recipe);
        return stamp_scene(stamps, switched, at, error)
            && share_scene(dst, switched, stamps, m_options.threads, nullptr, at, error);
    }

    bool read_normals(NormalMapPointer& dst, const VismapRecipe& recipe, const BakeScenePointer& scene,
                      std::string& error) const
    {
        std::vector<std::string> ignored;
        return read_normal_map(dst, recipe, { scene, &scene->mesh() }, m_options.threads, ignored, ignored, error);
    }

    const FilteredLight* find_light(size_t environment, bool suns, std::string& error)
    {
        return m_lights.find(environment, ModelLight::lobes, kLightWidth, suns, m_progress, error);
    }

    bool shade(OIIO::ImageBuf& dst, const OIIO::ImageBuf& map, const FilteredLight& light, const SunLight* suns,
               std::string& error) const
    {
        LightmapParams params;
        params.model = kEffectModel;
        return make_lightmap(dst, map, light.images, suns, params, nullptr, m_options.threads, m_progress)
            || stage_failed(dst, error);
    }

    const Inputs& m_inputs;
    const MakeOptions& m_options;
    MakeOptions m_quiet;
    const Progress& m_progress;
    FilteredLights m_lights;
};

} // namespace

double effects_weight(size_t environments)
{
    return 500 + 100 * double(environments);
}

bool measure_effects(std::vector<EffectCost>& dst, const Inputs& inputs, const VismapRecipe& mesh,
                     const CostParams& params, const MakeOptions& options, const Progress& progress, std::string& error)
{
    VismapRecipe recipe = mesh;
    recipe.vismap_params = reference_map(params);
    recipe.vismap_params.seed = params.seed;
    recipe.vismap_params.margin = 0;
    recipe.vismap_params.channels = { "coverage" };
    EffectBench bench(inputs, params, options, progress);
    EffectPicture with;
    std::vector<EffectDecision> decisions;
    dst.clear();
    if (!bench.decide(decisions, recipe, error) || !bench.bake(with, recipe, error))
        return false;
    for (const Effect& effect : all_effects()) {
        std::string reason;
        for (const EffectDecision& decision : decisions)
            if (decision.name == effect.name && decision.called_for && effect.can_be_off)
                reason += (reason.empty() ? "" : "; ") + decision.reason;
        if (reason.empty())
            continue;
        EffectPicture without;
        recipe.effects = std::string("-") + effect.name;
        if (!bench.bake(without, recipe, error))
            return false;
        EffectCost cost { effect.name,
                          reason,
                          with.bake.seconds,
                          without.bake.seconds,
                          visibility_difference(with.map, without.map),
                          0 };
        for (size_t i = 0; i < with.lit.size(); ++i)
            cost.light += light_difference(without.lit[i], with.lit[i], with.map) / double(with.lit.size());
        dst.push_back(cost);
    }
    recipe.effects = "auto";
    if (!bench.add_suns(dst, with, recipe, error))
        return false;
    if (recipe.has_normal_map()) { // which points of a bounce do not have
        recipe.normal_map.clear();
        if (!bench.bake(with, recipe, error))
            return false;
    }
    return bench.add_bounce(dst, with, recipe, error);
}

} // namespace vmlight::cost
