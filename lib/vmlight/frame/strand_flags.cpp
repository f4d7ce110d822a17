// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/strand_flags.h>

#include <vmlight/stage/recipe/strand_recipe.h>

#include <algorithm>

namespace vmlight {
namespace {

constexpr const char *kColorFlag = "strand_color", *kExponentFlag = "strand_exponent";

} // namespace

bool shows_strands(const VismapRecipe& recipe, const std::vector<std::string>& paths)
{
    return std::any_of(paths.begin(), paths.end(),
                       [&](const std::string& path) { return is_strand_occluder(recipe, path); });
}

VismapRecipe shown_recipe(const VismapRecipe& recipe, const std::vector<std::string>& paths)
{
    VismapRecipe shown = recipe;
    for (const std::string& path : paths)
        if (!is_strand_occluder(recipe, path)) {
            shown.mesh = path;
            shown.strand_params = {};
            break;
        }
    return shown;
}

bool is_strand_flag(const std::string& name)
{
    for (const std::vector<std::string>& names : { param_names(StrandParams()), param_names(SpecularParams()) })
        if (std::find(names.begin(), names.end(), name) != names.end())
            return true;
    return name == kColorFlag;
}

std::string unused_strand_flag(const std::string& name, bool shows_strands, bool is_white,
                               const SpecularParams& specular)
{
    if (name == kColorFlag && is_white)
        return "--white shows all white";
    if (!shows_strands)
        return "no object is strands";
    return name == kExponentFlag && specular.strand_specular == 0 ? "only --strand-specular uses it" : "";
}

} // namespace vmlight
