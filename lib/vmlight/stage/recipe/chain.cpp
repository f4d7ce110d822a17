// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/recipe/chain.h>

#include <vmlight/base/format.h>
#include <vmlight/image/channels.h>
#include <vmlight/stage/recipe/recipe_effects.h>
#include <vmlight/stage/recipe/strand_recipe.h>
#include <vmlight/stage/recipe/udim.h>

#include <algorithm>
#include <filesystem>

namespace vmlight {
namespace {

constexpr size_t kLongestChain = 64;

// The same file reached through another path to its folder is the same recipe. Its own name is kept even if it is a
// link, because the name may give a UDIM tile. A cycle through links still comes back to a name.
std::string identity(const std::string& name)
{
    const std::filesystem::path path = recipe_path(name);
    std::error_code ignored;
    const auto folder
        = std::filesystem::weakly_canonical(std::filesystem::absolute(path, ignored).parent_path(), ignored);
    return (ignored ? path : folder / path.filename()).string() + name.substr(path.string().size());
}

std::string missing(const std::string& what, const RecipeChain& chain)
{
    return (chain.empty() ? "" : format("\"{}\": ", chain.back())) + what + " is missing";
}

template <class Recipe> std::string effects_fault(const Recipe& recipe, const RecipeChain& chain)
{
    const std::string fault = switched_fault(recipe);
    return fault.empty() ? "" : with_location(recipe, "effects", chain, (chain.empty() ? "effects: " : "") + fault);
}

// `reason` starts with a key and ": ", unless it concerns several keys.
std::string parameter_with_location(const LightmapRecipe& recipe, const RecipeChain& chain, const std::string& reason)
{
    const size_t colon = reason.find(": ");
    if (chain.empty())
        return reason;
    return colon == std::string::npos ? format("\"{}\": {}", chain.back(), reason)
                                      : with_location(recipe, reason.substr(0, colon), chain, reason.substr(colon + 2));
}

} // namespace

bool link_recipe(RecipeChain& chain, const std::string& name, std::string& error)
{
    const auto same = [id = identity(name)](const std::string& other) { return identity(other) == id; };
    const auto first = std::find_if(chain.begin(), chain.end(), same);
    if (first == chain.end() && chain.size() < kLongestChain) {
        chain.push_back(name);
        return true;
    }
    std::string way;
    for (auto at = first; at != chain.end(); ++at)
        way += format("\"{}\" -> ", *at);
    error = first != chain.end() ? format("\"{}\" reads itself: {}\"{}\"", name, way, name)
                                 : format("\"{}\": more than {} nested recipes", name, kLongestChain);
    return false;
}

template <class Recipe>
std::string with_location(const Recipe& recipe, const std::string& key, const RecipeChain& chain,
                          const std::string& reason)
{
    Recipe read;
    std::string ignored;
    if (chain.empty() || !read_recipe(read, chain.back(), ignored))
        return reason;
    Recipe now = recipe;
    udim_of(read) = udim_of(now);
    if (recipe_value(resolve_udim(read), key) != recipe_value(resolve_udim(now), key))
        return reason;
    return recipe_place(chain.back(), key) + ": " + reason;
}

std::string recipe_fault(const VismapRecipe& recipe, const RecipeChain& chain)
{
    if (recipe.mesh.empty())
        return missing("mesh", chain);
    if (std::string key; bakes_strands(recipe)) {
        const std::string fault = strand_fault(recipe, key);
        return fault.empty() ? "" : with_location(recipe, key, chain, (chain.empty() ? key + ": " : "") + fault);
    }
    if (recipe.unwrap && recipe.vismap_params.udim != kFirstUdim)
        return with_location(recipe, "unwrap", chain,
                             format("{}the atlas is tile {}, and tile {} is empty", chain.empty() ? "unwrap: " : "",
                                    kFirstUdim, recipe.vismap_params.udim));
    const std::string key = recipe.material_normals ? "material_normals" : "normal_map";
    if (recipe.unwrap && recipe.has_normal_map())
        return with_location(recipe, key, chain,
                             format("{}with unwrap the mesh gets other UVs than those of the normal map; write the "
                                    "unwrapped mesh by --write-mesh, and bake that with a normal map made for it",
                                    chain.empty() ? key + ": " : ""));
    if (recipe.material_normals && !recipe.normal_map.empty())
        return with_location(
            recipe, key, chain,
            format("{}a normal map is given too: set only one of them", chain.empty() ? "material_normals: " : ""));
    return effects_fault(recipe, chain);
}

std::string recipe_fault(const CfemRecipe& recipe, const RecipeChain& chain)
{
    return recipe.environment.empty() ? missing("environment", chain) : "";
}

std::string recipe_fault(const LightmapRecipe& recipe, const RecipeChain& chain)
{
    if (recipe.vismap.empty())
        return missing("vismap", chain);
    if (recipe.cfem.empty() && recipe.environment.empty())
        return missing("environment or cfem", chain);
    if (!recipe.cfem.empty() && !recipe.environment.empty())
        return with_location(recipe, "cfem", chain, "environment is set too: set only one of them");
    if (const std::string fault = effects_fault(recipe, chain); !fault.empty())
        return fault;
    Rotation rotation;
    std::string error;
    return lightmap_rotation(rotation, recipe.lightmap_params, error) ? ""
                                                                      : parameter_with_location(recipe, chain, error);
}

#define VMLIGHT_DEFINE(Recipe)                                                                                         \
    template std::string with_location(const Recipe&, const std::string&, const RecipeChain&, const std::string&);
VMLIGHT_RECIPES(VMLIGHT_DEFINE)
#undef VMLIGHT_DEFINE

std::string input_fault(const std::string& name, const std::string& stage, InputKind wanted)
{
    if (is_recipe_name(name)) {
        const char* noun = wanted == InputKind::Vismap ? "a vismap"
            : wanted == InputKind::Cfem                ? "a cfem"
                                                       : "an environment";
        const bool good = wanted == InputKind::Albedo || (wanted == InputKind::Vismap && stage == kVismapStage)
            || (wanted == InputKind::Cfem && stage == kCfemStage);
        return good ? "" : format("\"{}\": is the recipe of a {}, not of {}", name, stage, noun);
    }
    if (wanted == InputKind::Environment && stage == kCfemStage)
        return format("\"{}\": is already filtered: use it as cfem", name);
    if ((wanted == InputKind::Environment && !stage.empty())
        || (wanted == InputKind::Cfem && !stage.empty() && stage != kCfemStage))
        return format("\"{}\": is neither an environment nor a CFEM: its vmlight:stage is \"{}\"", name, stage);
    return "";
}

} // namespace vmlight
