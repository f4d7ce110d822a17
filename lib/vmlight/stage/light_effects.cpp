// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/light_effects.h>

#include <vmlight/base/format.h>
#include <vmlight/effects/effect.h>
#include <vmlight/lightmap/model.h>
#include <vmlight/stage/bake_switches.h>
#include <vmlight/stage/sun_choice.h>
#include <vmlight/stage/sun_shading.h>

#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <cmath>

namespace vmlight {
namespace {

double degrees_of(const Rotation& r)
{
    // From the antisymmetric part and the trace: exact near 0, unlike the arc cosine.
    const double x = r[2][1] - r[1][2], y = r[0][2] - r[2][0], z = r[1][0] - r[0][1];
    return std::atan2(std::sqrt(x * x + y * y + z * z), r[0][0] + r[1][1] + r[2][2] - 1) * 180 / M_PI;
}

// Of the light as it is without the switches.
bool find_sun_facts(LightFacts& dst, const LightmapInputs& inputs, const LightmapRecipe& recipe,
                    const MakeOptions& options, std::string& error)
{
    dst.wants_suns = recipe.suns != "off" || inputs.suns;
    if (!dst.wants_suns)
        return true;
    std::vector<Sun> suns;
    if (inputs.suns) {
        suns = inputs.suns->list;
    } else {
        dst.no_suns = recipe.cfem.empty() ? why_no_suns(recipe, inputs.vismap.spec())
                                          : format("\"{}\" was filtered with its suns, if it has any", recipe.cfem);
        if (dst.no_suns.empty() && !suns_of_light(suns, recipe, error, options.chain))
            return false;
    }
    dst.suns = int(suns.size());
    dst.sun_share = inputs.cfem.empty() ? 0 : sun_share(suns, inputs.cfem[0], inputs.suns != nullptr);
    return true;
}

} // namespace

LightmapRecipe with_switches(const LightmapRecipe& recipe)
{
    const EffectSwitches switches = switches_of(recipe.effects, LightmapRecipe::kStage);
    LightmapRecipe switched = recipe;
    if (switches.of("albedo") == Switch::off)
        switched.albedo = switched.albedo_colorspace = switched.albedo_layer = "";
    if (switches.of("suns") == Switch::off) {
        switched.suns = "off";
        switched.mesh.clear();
        switched.occluder.clear();
    } else if (switches.of("suns") == Switch::on && switches.names("suns")) {
        switched.suns = "on";
    }
    if (switches.of("rotation") == Switch::off) {
        const LightmapParams defaults;
        LightmapParams& params = switched.lightmap_params;
        params.rotate = defaults.rotate;
        params.matrix = defaults.matrix;
        params.quaternion = defaults.quaternion;
        params.env_rotate = defaults.env_rotate;
    }
    return switched;
}

bool explain_light(const LightmapInputs& inputs, const LightmapRecipe& recipe, const LightmapParams& params,
                   const MakeOptions& options, std::string& error)
{
    const EffectSwitches switches = switches_of(recipe.effects, LightmapRecipe::kStage);
    EffectFacts facts;
    LightFacts& light = facts.light;
    Rotation rotation;
    ShadingModel model;
    const bool has_stack = inputs.cfem.size() > 1
        || (!inputs.cfem.empty() && inputs.cfem[0].spec().get_float_attribute("vmlight:lobe") == 1);
    if (!lightmap_rotation(rotation, params, error)
        || !choose_model(model, params, inputs.vismap.spec(), has_stack, error))
        return false;
    light.rotation_degrees = degrees_of(rotation);
    light.model = model.name;
    light.levels = int(inputs.cfem.size());
    light.has_environment = recipe.cfem.empty();
    light.color_note = inputs.color;
    light.converts_color = !inputs.color.empty();
    light.has_albedo = !recipe.albedo.empty();
    if (inputs.albedo.initialized()) {
        const auto range = OIIO::ImageBufAlgo::computePixelStats(inputs.albedo);
        light.albedo_low = *std::min_element(range.min.begin(), range.min.end());
        light.albedo_high = *std::max_element(range.max.begin(), range.max.end());
    }
    if (!find_sun_facts(light, inputs, recipe, options, error))
        return false;
    std::vector<EffectDecision> decisions;
    if (!decide_effects(decisions, LightmapRecipe::kStage, facts, switches, error))
        return false;
    if (options.explain) {
        options.report("effects:");
        for (const std::string& line : decision_lines(decisions))
            options.report(line);
    }
    if (const std::string missing = left_out(decisions); !missing.empty() && !options.repeated_inputs)
        options.report_warning(format("effects: the picture has {}, left out", missing));
    return true;
}

} // namespace vmlight
