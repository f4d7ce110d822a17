// SPDX-License-Identifier: Apache-2.0
/// Sources by name or by recipe. A recipe's inputs are opened here and not through OIIO, so that stages share what they
/// make and never wait for themselves.
#pragma once

#include <vmlight/stage/pixel_source.h>
#include <vmlight/stage/recipe/chain.h>

#include <string>
#include <vector>

namespace vmlight {

/// Whether everything in the process that opens the same recipe shares one source, or the caller gets its own.
enum class Sharing
{
    process,
    none
};

/// Open an image by name: a recipe is read and described, OIIO opens any other image. Computes nothing. Shares what is
/// already open and unchanged.
///
/// @param chain    the recipes that led here
/// @returns nullptr, with the location and reason in `error`, if it cannot be read, an input is missing or of the wrong
///          kind, or a recipe reads itself.
PixelSourcePointer open_source(const std::string& name, std::string& error, const RecipeChain& chain = {});

/// The same for a recipe in memory, the last of `chain` if it has a file.
#define VMLIGHT_DECLARE(Recipe)                                                                                        \
    PixelSourcePointer open_source(const Recipe& recipe, std::string& error, const RecipeChain& chain = {},            \
                                   Sharing sharing = Sharing::process);
VMLIGHT_RECIPES(VMLIGHT_DECLARE)
#undef VMLIGHT_DECLARE

// ---- For the sources of the stages ------------------------------------------------------------------------------

/// Open the image `name`, the value of `key` in `recipe`, which is the last of `chain`; only its `layer`, unless
/// that is "". nullptr, with the location and reason in `error`, if it cannot be opened or is not of the kind `wanted`.
template <class Recipe>
PixelSourcePointer open_input(const Recipe& recipe, const char* key, const std::string& name, InputKind wanted,
                              std::string& error, const RecipeChain& chain, const std::string& layer = "");

/// Make images of `input`, which open_input() opened, whole: PixelSource::make() with the chain extended by `name`, and
/// the location of `key` in errors.
template <class Recipe>
bool make_input(std::vector<OIIO::ImageBuf>& dst, PixelSource& input, ImageRange range, const Recipe& recipe,
                const char* key, const std::string& name, const MakeOptions& options, std::string& error)
{
    MakeOptions inner = options;
    if (is_recipe_name(name))
        inner.chain.push_back(name);
    if (input.make(dst, range, inner, error))
        return true;
    error = with_location(recipe, key, options.chain, error);
    return false;
}

/// stamp_file() of an OCIO config; "" means $OCIO.
bool stamp_config(std::string& stamp, const std::string& colorconfig, std::string& error);

/// All parameters of a recipe as text, for the key of its source.
template <class Recipe> std::string recipe_key(Recipe recipe)
{
    std::string key = std::string(Recipe::kStage) + "\n";
    recipe.visit([&](const char* name, auto& value, const auto& allowed, const char*) {
        key += std::string(name) + "=" + value_text(value, allowed) + "\n";
    });
    return key;
}

} // namespace vmlight
