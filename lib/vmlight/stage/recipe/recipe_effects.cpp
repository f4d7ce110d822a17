// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/recipe/recipe_effects.h>

#include <vmlight/effects/effect.h>
#include <vmlight/vismap/reconstruct.h>

#include <OpenImageIO/strutil.h>

#include <vector>

namespace vmlight {
namespace {

bool is_named_on(const LightmapRecipe& recipe, const char* effect)
{
    EffectSwitches switches;
    std::string ignored;
    return EffectSwitches::parse(switches, recipe.effects, LightmapRecipe::kStage, ignored) && switches.names(effect)
        && switches.of(effect) == Switch::on;
}

EffectFacts known_facts(const VismapRecipe& recipe, const EffectSwitches& switches)
{
    EffectFacts facts;
    BakeFacts& bake = facts.bake;
    bake.triangles = 1;
    for (const std::string& path : recipe.occluder)
        bake.occluders.push_back({ path, 1, CasterReach::reaches, 0 });
    bake.no_cutouts = recipe.cutout_params.cutouts == "off";
    bake.cutouts.triangles = bake.no_cutouts ? 0 : 1;
    bake.has_normal_map = recipe.has_normal_map();
    bake.has_ground = recipe.vismap_params.ground;
    bake.given_reach = bake.reach = recipe.vismap_params.max_distance;
    bake.margin = recipe.vismap_params.margin;
    bake.udim = recipe.vismap_params.udim;
    bake.udim_given = recipe.udim_given;
    bake.no_reconstruct = why_not_reconstructed(recipe);
    bake.half = switches.of("half") == Switch::on;
    bake.poses = switches.of("poses") == Switch::on ? 2 : 1;
    return facts;
}

} // namespace

EffectFacts known_facts(const LightmapRecipe& recipe, const EffectSwitches& switches)
{
    EffectFacts facts;
    LightFacts& light = facts.light;
    light.has_environment = recipe.cfem.empty();
    light.is_one_color = true; // so that nothing calls for a filter
    light.converts_color = switches.of("color-conversion") == Switch::on;
    light.has_albedo = !recipe.albedo.empty();
    light.albedo_low = switches.of("albedo") == Switch::off ? 1 : 0;
    light.wants_suns = wants_suns(recipe);
    light.wants_bounce = wants_bounce(recipe);
    return facts;
}

namespace {

// What a key demands and a switch leaves out. That `auto` asks for it is no contradiction: the switch shows what it
// adds.
std::string contradiction(const LightmapRecipe& recipe, const EffectSwitches& switches)
{
    if (recipe.suns == "on" && switches.names("suns") && switches.of("suns") == Switch::off)
        return "-suns contradicts suns = on";
    if (recipe.bounce_params.bounce == "on" && switches.names("bounce") && switches.of("bounce") == Switch::off)
        return "-bounce contradicts bounce = on";
    return "";
}

std::string contradiction(const VismapRecipe&, const EffectSwitches&)
{
    return "";
}

template <class Recipe> std::string fault_of(const Recipe& recipe)
{
    EffectSwitches switches;
    std::vector<EffectDecision> ignored;
    std::string error;
    if (EffectSwitches::parse(switches, recipe.effects, Recipe::kStage, error)
        && (error = contradiction(recipe, switches)).empty()
        && decide_effects(ignored, Recipe::kStage, known_facts(recipe, switches), switches, error))
        return "";
    const OIIO::string_view prefix = "effects: ";
    return OIIO::Strutil::starts_with(error, prefix) ? error.substr(prefix.size()) : error;
}

} // namespace

bool wants_suns(const LightmapRecipe& recipe)
{
    return recipe.suns != "off" || is_named_on(recipe, "suns");
}

bool wants_bounce(const LightmapRecipe& recipe)
{
    return recipe.bounce_params.bounce != "off" || is_named_on(recipe, "bounce");
}

std::string why_not_reconstructed(const VismapRecipe& recipe)
{
    EffectSwitches switches;
    std::string ignored;
    if (recipe.vismap_params.reconstruct != "off" && recipe.has_normal_map()
        && !(EffectSwitches::parse(switches, recipe.effects, VismapRecipe::kStage, ignored)
             && switches.of("normal-map") == Switch::off))
        return "with a normal map, neighbouring texels have normals of their own";
    return reconstruct_fault(recipe.vismap_params);
}

std::string switched_fault(const VismapRecipe& recipe)
{
    return fault_of(recipe);
}

std::string switched_fault(const LightmapRecipe& recipe)
{
    return fault_of(recipe);
}

} // namespace vmlight
