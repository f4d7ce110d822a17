// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/recipe/strand_recipe.h>

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/strands/read_strands.h>
#include <vmlight/vismap/basis.h>
#include <vmlight/vismap/strand_map.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace vmlight {
namespace {

constexpr const char* kNotOfStrands = "a map of strands does not use it";

} // namespace

bool bakes_strands(const VismapRecipe& recipe)
{
    const auto is_strands = [&](const std::string& path) { return is_strand_occluder(recipe, path); };
    if (is_strand_file(recipe.mesh))
        return true;
    if (recipe.strand_params.radius.empty())
        return false;
    return std::none_of(recipe.occluder.begin(), recipe.occluder.end(), is_strands) || has_lines_alone(recipe.mesh);
}

bool is_strand_occluder(const VismapRecipe& recipe, const std::string& path)
{
    return is_strand_file(path) || (!recipe.strand_params.radius.empty() && has_lines_alone(path));
}

std::string strand_fault(const VismapRecipe& recipe, std::string& key)
{
    std::map<std::string, std::string> defaults;
    VismapRecipe whole, own = recipe;
    whole.visit([&](const char* name, auto& value, const auto& allowed, const char*) {
        defaults[name] = value_text(value, allowed);
    });
    std::string fault;
    own.visit([&](const char* name, auto& value, const auto& allowed, const char*) {
        if (!fault.empty() || is_strand_parameter(name) || value_text(value, allowed) == defaults[name])
            return;
        key = name;
        fault = kNotOfStrands;
    });
    if (fault.empty() && recipe.time_budget > 0) {
        key = "time_budget";
        fault = kNotOfStrands;
    }
    if (const std::string& basis = recipe.vismap_params.basis; fault.empty() && !find_basis(basis).has_strands) {
        key = "basis";
        fault = format("strands have no basis {}: its cells are those of a hemisphere", basis);
    }
    return fault;
}

std::string unused_by_strands(const VismapRecipe& recipe, const std::string& key)
{
    if (!bakes_strands(recipe))
        return key == "strand_texels" ? "only maps of strands use it" : "";
    const std::vector<std::string> keys = param_names(VismapRecipe());
    const bool is_of_recipe = key == "time_budget" || std::find(keys.begin(), keys.end(), key) != keys.end();
    return is_of_recipe && !is_strand_parameter(key) ? kNotOfStrands : "";
}

} // namespace vmlight
