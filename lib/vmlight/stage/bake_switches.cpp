// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/bake_switches.h>

#include <vmlight/effects/effect.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>

namespace vmlight {

EffectSwitches switches_of(const std::string& effects, const char* stage)
{
    EffectSwitches switches;
    std::string ignored;
    EffectSwitches::parse(switches, effects, stage, ignored);
    return switches;
}

std::string without_words(const std::string& effects, const std::vector<std::string>& words)
{
    std::vector<std::string> left;
    for (const std::string& part : OIIO::Strutil::splits(effects, ","))
        if (std::find(words.begin(), words.end(), std::string(OIIO::Strutil::strip(part))) == words.end())
            left.push_back(part);
    return left.empty() ? "auto" : OIIO::Strutil::join(left, ",");
}

std::string without_switches_off(const std::string& effects)
{
    std::vector<std::string> off;
    for (const std::string& part : OIIO::Strutil::splits(effects, ","))
        if (const std::string word(OIIO::Strutil::strip(part)); !word.empty() && word[0] == '-')
            off.push_back(word);
    return without_words(effects, off);
}

VismapRecipe with_switches(const VismapRecipe& recipe)
{
    const EffectSwitches switches = switches_of(recipe.effects, VismapRecipe::kStage);
    const VismapParams defaults;
    VismapRecipe switched = recipe;
    VismapParams& params = switched.vismap_params;
    if (switches.of("ground") == Switch::off) {
        params.ground = false;
        params.ground_height = defaults.ground_height;
    }
    if (switches.of("cut-outs") == Switch::off)
        switched.cutout_params.cutouts = "off";
    if (switches.of("normal-map") == Switch::off) {
        switched.normal_map.clear();
        switched.material_normals = false;
    }
    if (switches.of("max-distance") == Switch::off)
        params.max_distance = defaults.max_distance;
    if (switches.of("margin") == Switch::off)
        params.margin = 0;
    if (switches.of("reconstruction") == Switch::off || switched.has_normal_map())
        params.reconstruct = "off";
    params.skip_open = switches.of("self-occlusion") != Switch::on;
    return switched;
}

SceneChoice scene_choice(const VismapRecipe& recipe)
{
    const EffectSwitches switches = switches_of(recipe.effects, VismapRecipe::kStage);
    SceneChoice choice;
    choice.self = switches.of("self-occlusion") != Switch::off;
    choice.occluders = switches.of("occluders") != Switch::off;
    choice.cull = recipe.cull_occluders && switches.of("occluders") != Switch::on;
    if (switches.of("cut-outs") == Switch::on)
        choice.cutouts = CutoutMode::every_hit;
    if (!recipe.occluder.empty()) // without, maps of any distance share the scene
        choice.reach = recipe.vismap_params.max_distance;
    return choice;
}

std::string switched_off(const std::string& effects, const char* stage)
{
    const EffectSwitches switches = switches_of(effects, stage);
    std::string text;
    for (const Effect& effect : all_effects())
        if (std::string(effect.stage) == stage && switches.of(effect.name) == Switch::off)
            text += std::string(text.empty() ? "-" : ",-") + effect.name;
    return text;
}

} // namespace vmlight
