// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/light_effects.h>

#include <vmlight/base/format.h>
#include <vmlight/cfem/one_color.h>
#include <vmlight/cfem/suns.h>
#include <vmlight/effects/effect.h>
#include <vmlight/lightmap/input.h>
#include <vmlight/lightmap/model.h>
#include <vmlight/math/difference.h>
#include <vmlight/stage/bake_switches.h>
#include <vmlight/stage/light_facts.h>
#include <vmlight/stage/recipe/recipe_effects.h>
#include <vmlight/stage/recipe/udim.h>
#include <vmlight/stage/stored_suns.h>
#include <vmlight/stage/sun_choice.h>
#include <vmlight/stage/sun_shading.h>

#include <algorithm>
#include <cmath>

namespace vmlight {
namespace {

void find_albedo_facts(LightFacts& dst, const OIIO::ImageBuf& albedo, int nthreads)
{
    dst.albedo_low = 1; // not read
    dst.albedo_high = 0;
    AlbedoReader reader;
    std::string ignored; // whoever multiplies by it reports it
    float low = 0, high = 0;
    // At its own size: what it is resized to is between the same bounds.
    if (!albedo.initialized() || !reader.open(albedo, albedo.roi_full(), nthreads, ignored)
        || !reader.find_range(low, high))
        return;
    dst.albedo_low = double(low);
    dst.albedo_high = double(high);
}

// Of the light as it is without the switches.
bool find_sun_facts(LightFacts& dst, const LightmapInputs& inputs, const LightmapRecipe& recipe,
                    const Rotation& rotation, const MakeOptions& options, std::string& error)
{
    dst.wants_suns = wants_suns(recipe) || inputs.suns;
    if (!dst.wants_suns)
        return true;
    std::vector<Sun> suns;
    if (inputs.suns) {
        suns = inputs.suns->list;
    } else {
        dst.no_suns = recipe.cfem.empty() ? why_no_suns(recipe, inputs.vismap.spec(), recipe.vismap)
                                          : format("\"{}\" was filtered with its suns, if it has any", recipe.cfem);
        if (dst.no_suns.empty() && !suns_of_light(suns, recipe, error, options.chain))
            return false;
    }
    dst.wide_discs = int(std::count_if(suns.begin(), suns.end(), is_wide));
    dst.suns = int(suns.size()) - dst.wide_discs;
    dst.has_stored_suns = !stored_suns(inputs.vismap.spec()).channels_of(discs_in_object_space(suns, rotation)).empty();
    dst.is_rest = inputs.suns && !suns.empty();
    dst.sun_share = inputs.cfem.empty() ? 0 : sun_share(suns, inputs.cfem[0], inputs.suns != nullptr);
    return true;
}

bool find_facts(LightFacts& dst, const LightmapInputs& inputs, const LightmapRecipe& recipe,
                const LightmapParams& params, const MakeOptions& options, std::string& error)
{
    Rotation rotation;
    ShadingModel model;
    const bool has_stack = inputs.cfem.size() > 1
        || (!inputs.cfem.empty() && inputs.cfem[0].spec().get_float_attribute("vmlight:lobe") == 1);
    if (!lightmap_rotation(rotation, params, error)
        || !choose_model(model, params, inputs.vismap.spec(), has_stack, error))
        return false;
    dst.rotation_degrees = rotation_degrees(rotation);
    dst.model = model.name;
    dst.levels = int(inputs.cfem.size());
    dst.has_environment = recipe.cfem.empty();
    dst.is_one_color = find_one_color(inputs.cfem).has_value();
    dst.is_black = is_black(inputs.cfem, inputs.suns ? &inputs.suns->list : nullptr);
    dst.color_note = inputs.color();
    dst.converts_color = !dst.color_note.empty();
    dst.has_albedo = !recipe.albedo.empty();
    find_albedo_facts(dst, inputs.albedo, options.threads);
    dst.wants_bounce = wants_bounce(recipe);
    dst.bounce_rays = recipe.bounce_params.bounce_rays;
    dst.no_bounce = dst.wants_bounce ? why_no_trace(recipe, inputs.vismap.spec(), recipe.vismap) : "";
    find_visibility_facts(dst, inputs.vismap);
    return find_sun_facts(dst, inputs, recipe, rotation, options, error)
        && find_bounce_facts(dst, inputs.bounce.get(), inputs.vismap, options, error);
}

// How far the light is from what it would be with nothing switched off.
bool compare_lights(Difference& dst, const LightmapInputs& inputs, const SwitchedLight& light,
                    const MakeOptions& options, std::string& error)
{
    MakeOptions quiet;
    quiet.chain = options.chain;
    quiet.threads = options.threads;
    LightmapRecipe whole = light.asked;
    whole.effects = without_switches_off(light.asked.effects);
    LightmapInputs all = inputs; // what is the same is not read again
    OIIO::ImageBuf lit[2];
    if (!read_lightmap_inputs(all, whole, quiet, error) || !make_lightmap(lit[0], inputs, light.params, quiet, error)
        || !make_lightmap(lit[1], all, light.asked_params, quiet, error))
        return false;
    const auto *a = static_cast<const float*>(lit[0].localpixels()),
               *b = static_cast<const float*>(lit[1].localpixels());
    for (size_t i = 0; i < 3 * size_t(lit[0].spec().image_pixels()); ++i)
        if (a[i] != 0 || b[i] != 0) // no texel, or a black one
            dst.add(double(a[i]), double(b[i]));
    return true;
}

} // namespace

LightmapRecipe with_switches(const LightmapRecipe& recipe)
{
    const EffectSwitches switches = switches_of(recipe.effects, LightmapRecipe::kStage);
    LightmapRecipe switched = recipe;
    if (switches.of("albedo") == Switch::off)
        switched.albedo = switched.albedo_colorspace = switched.albedo_layer = "";
    if (switches.of("bounce") == Switch::off)
        switched.bounce_params = {};
    else if (switches.of("bounce") == Switch::on && switches.names("bounce"))
        switched.bounce_params.bounce = "on";
    if (switches.of("suns") == Switch::off)
        switched.suns = "off";
    else if (switches.of("suns") == Switch::on && switches.names("suns"))
        switched.suns = "on";
    const auto traces = [](const LightmapRecipe& r) { return r.suns != "off" || r.bounce_params.bounce != "off"; };
    if (traces(recipe) && !traces(switched)) {
        switched.mesh.clear();
        switched.occluder.clear();
    }
    if (switches.of("rotation") == Switch::off) {
        const LightmapParams defaults;
        LightmapParams& params = switched.lightmap_params;
        params.rotate = defaults.rotate;
        params.matrix = defaults.matrix;
        params.quaternion = defaults.quaternion;
        params.env_rotate = defaults.env_rotate;
    }
    switched.cfem_params.skip_one_color = switches.of("filter") != Switch::on;
    switched.lightmap_params.skip_one_color = switches.of("stack-levels") != Switch::on;
    switched.lightmap_params.skip_one_albedo = switches.of("albedo") != Switch::on;
    return switched;
}

bool check_switches(const LightmapRecipe& recipe, OIIO::cspan<OIIO::ImageBuf> light, bool converts_color,
                    const std::function<bool(OIIO::ImageBuf& map, std::string& error)>& read_map, std::string& error)
{
    const EffectSwitches switches = switches_of(recipe.effects, LightmapRecipe::kStage);
    EffectFacts facts = known_facts(recipe, switches);
    facts.light.is_one_color = find_one_color(light).has_value();
    facts.light.levels = int(light.size());
    facts.light.model = recipe.lightmap_params.model;
    facts.light.converts_color = converts_color;
    if (OIIO::ImageBuf map; switches.of("visibility") == Switch::off) {
        if (!read_map(map, error))
            return false;
        find_visibility_facts(facts.light, map);
    }
    std::vector<EffectDecision> ignored;
    return decide_effects(ignored, LightmapRecipe::kStage, facts, switches, error);
}

bool explain_light(const LightmapInputs& inputs, const SwitchedLight& given, const MakeOptions& options,
                   std::string& error)
{
    SwitchedLight light = given;
    light.asked = resolve_udim(given.asked);
    const EffectSwitches switches = switches_of(light.asked.effects, LightmapRecipe::kStage);
    EffectFacts facts;
    std::vector<EffectDecision> decisions;
    if (!find_facts(facts.light, inputs, light.asked, light.asked_params, options, error)
        || !decide_effects(decisions, LightmapRecipe::kStage, facts, switches, error))
        return false;
    if (options.explain || options.dry_run) {
        options.report_answer("effects:");
        for (const std::string& line : decision_lines(decisions))
            options.report_answer(line);
    }
    const std::string missing = left_out(decisions);
    if (missing.empty() || options.repeated_inputs)
        return true;
    Difference off;
    if (!compare_lights(off, inputs, light, options, error))
        return false;
    if (off.rms() == 0) // such as an albedo of 1, which is not read where it is switched off
        return true;
    options.report_warning(format("effects: the picture has {}, left out: light is off by about {:.2g} (RMS), and its "
                                  "mean is {:.2g}",
                                  missing, off.rms(), off.mean()));
    return true;
}

} // namespace vmlight
