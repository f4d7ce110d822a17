// SPDX-License-Identifier: Apache-2.0
/// Sources by name or by recipe. A recipe's inputs are opened here and not through OIIO, so that stages share what they
/// make and never wait for themselves.
#pragma once

#include <vmlight/stage/pixel_source.h>
#include <vmlight/stage/recipe/chain.h>

#include <string>
#include <vector>

namespace vmlight {

/// Whether a source of a recipe is shared with others who open the same, or made for its caller alone.
enum class Sharing
{
    process,
    none
};

/// Open an image by name: a recipe is read and described, any other image is opened by OIIO. Nothing is computed.
/// What is open already, unchanged, is shared.
///
/// @param chain    the recipes that led here
/// @returns nullptr, with the place and reason in `error`, if it cannot be read, an input is missing or not what it
///          should be, or it reads itself
PixelSourcePointer open_source(const std::string& name, std::string& error, const RecipeChain& chain = {});

/// The same for a recipe in memory, the last of `chain` if it has a file.
PixelSourcePointer open_source(const VismapRecipe& recipe, std::string& error, const RecipeChain& chain = {},
                               Sharing sharing = Sharing::process);
PixelSourcePointer open_source(const CfemRecipe& recipe, std::string& error, const RecipeChain& chain = {},
                               Sharing sharing = Sharing::process);
PixelSourcePointer open_source(const LightmapRecipe& recipe, std::string& error, const RecipeChain& chain = {},
                               Sharing sharing = Sharing::process);

// ---- For the sources of the stages ------------------------------------------------------------------------------

/// Open the image `name`, which `recipe`, the last of `chain`, gives as `key`. nullptr, with the place and reason in
/// `error`, if it cannot be opened or is not `wanted`.
template <class Recipe>
PixelSourcePointer open_input(const Recipe& recipe, const char* key, const std::string& name, Input wanted,
                              std::string& error, const RecipeChain& chain);
extern template PixelSourcePointer open_input(const CfemRecipe&, const char*, const std::string&, Input, std::string&,
                                              const RecipeChain&);
extern template PixelSourcePointer open_input(const LightmapRecipe&, const char*, const std::string&, Input,
                                              std::string&, const RecipeChain&);

/// Make images of `input` whole, which open_input() opened: PixelSource::make() with the chain and the place of errors
/// that belong to it.
template <class Recipe>
bool make_input(std::vector<OIIO::ImageBuf>& dst, PixelSource& input, ImageRange range, const Recipe& recipe,
                const char* key, const std::string& name, const MakeOptions& options, std::string& error)
{
    MakeOptions inner = options;
    if (is_recipe_name(name))
        inner.chain.push_back(name);
    if (input.make(dst, range, inner, error))
        return true;
    error = placed(recipe, key, options.chain, error);
    return false;
}

/// stamp_file() of an OCIO config, "" being $OCIO.
bool stamp_config(std::string& stamp, const std::string& colorconfig, std::string& error);

/// Every parameter of a recipe as text.
template <class Recipe> std::string recipe_key(Recipe recipe)
{
    std::string key = std::string(Recipe::kStage) + "\n";
    recipe.visit([&](const char* name, auto& value, const auto& allowed, const char*) {
        key += std::string(name) + "=" + value_text(value, allowed) + "\n";
    });
    return key;
}

} // namespace vmlight
