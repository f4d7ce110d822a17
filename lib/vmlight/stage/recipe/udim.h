// SPDX-License-Identifier: Apache-2.0
/// "<UDIM>" in the paths of recipes.
#pragma once

#include <vmlight/stage/recipe/recipe.h>

#include <OpenImageIO/imageio.h>

#include <string>
#include <type_traits>

namespace vmlight {

/// The recipe with "<UDIM>" in its paths replaced by its tile number. Opening a recipe starts with this; keys, queries
/// and printed recipes keep "<UDIM>".
template <class Recipe> Recipe resolve_udim(Recipe recipe)
{
    const int udim = udim_of(recipe);
    recipe.visit([&](const char*, auto& value, const auto& allowed, const char*) {
        using Allowed = std::decay_t<decltype(allowed)>;
        if constexpr (std::is_same_v<Allowed, Path>)
            value = udim_path(value, udim);
        else if constexpr (std::is_same_v<Allowed, Paths>)
            for (std::string& path : value)
                path = udim_path(path, udim);
    });
    return recipe;
}

/// The value of a recipe's parameter as text; "" if there is no such parameter.
template <class Recipe> std::string recipe_value(Recipe recipe, const std::string& key)
{
    std::string text;
    recipe.visit([&](const char* name, auto& value, const auto& allowed, const char*) {
        if (key == name)
            text = value_text(value, allowed);
    });
    return text;
}

/// Set `vmlight:udim` of a cfem or lightmap if its tile is not 1001. A vismap has it among its parameters.
inline void tag_udim(OIIO::ImageSpec& spec, int udim)
{
    if (udim != kFirstUdim)
        spec.attribute("vmlight:udim", std::to_string(udim));
}

} // namespace vmlight
