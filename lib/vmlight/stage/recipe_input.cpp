// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/recipe_input.h>

#include <vmlight/base/fail.h>
#include <vmlight/image/image_file.h>

#include <utility>

namespace vmlight {
namespace {

// The recipe that `options.chain` ends with.
template <class Recipe> bool make_named(OIIO::ImageBuf& dst, const MakeOptions& options)
{
    Recipe recipe;
    std::string error;
    return read_recipe(recipe, options.chain.back(), error) ? make_image(dst, recipe, options) : fail(dst, error);
}

// What the name of a cfem's recipe, which `options.chain` ends with, asks for.
bool make_named_levels(std::vector<OIIO::ImageBuf>& dst, const MakeOptions& options, std::string& error)
{
    CfemRecipe recipe;
    return read_recipe(recipe, options.chain.back(), error) && make_images(dst, recipe, options, error);
}

// `first` and the levels that follow it in the file `name`, if it is a stack's.
bool read_levels(std::vector<OIIO::ImageBuf>& dst, OIIO::ImageBuf&& first, const std::string& name, std::string& error)
{
    const bool stack = first.spec().get_string_attribute("vmlight:stack") == "true";
    const int count = stack ? first.nsubimages() : 1;
    dst.clear();
    dst.push_back(std::move(first));
    for (int level = 1; level < count; ++level)
        if (!read_image(dst.emplace_back(), name, error, level))
            return false;
    return true;
}

// An image, or what its recipe makes. With `levels`, all images of a stack go there, and not to `dst`.
bool read_image_or_recipe(OIIO::ImageBuf& dst, const std::string& name, Input wanted, const MakeOptions& options,
                          std::string& error, std::vector<OIIO::ImageBuf>* levels)
{
    const std::string found = recipe_stage(name);
    if (found.empty()) {
        if (read_image(dst, name, error))
            error = input_fault(name, dst.spec().get_string_attribute("vmlight:stage"), wanted);
        if (!error.empty() || !levels)
            return error.empty();
        return read_levels(*levels, std::move(dst), name, error);
    }
    MakeOptions inner = options;
    if (!link_recipe(inner.chain, name, error))
        return false;
    error = input_fault(name, found, wanted);
    if (!error.empty())
        return false;
    if (levels)
        return make_named_levels(*levels, inner, error);
    const bool good = found == VismapRecipe::kStage ? make_named<VismapRecipe>(dst, inner)
        : found == CfemRecipe::kStage               ? make_named<CfemRecipe>(dst, inner)
                                                    : make_named<LightmapRecipe>(dst, inner);
    if (!good)
        error = dst.geterror();
    return good;
}

} // namespace

template <class Recipe>
bool read_input(OIIO::ImageBuf& dst, const Recipe& recipe, const char* key, const std::string& name, Input wanted,
                const MakeOptions& options, std::string& error, std::vector<OIIO::ImageBuf>* levels)
{
    if (read_image_or_recipe(dst, name, wanted, options, error, levels))
        return true;
    error = placed(recipe, key, options.chain, error);
    return false;
}

template bool read_input(OIIO::ImageBuf&, const CfemRecipe&, const char*, const std::string&, Input, const MakeOptions&,
                         std::string&, std::vector<OIIO::ImageBuf>*);
template bool read_input(OIIO::ImageBuf&, const LightmapRecipe&, const char*, const std::string&, Input,
                         const MakeOptions&, std::string&, std::vector<OIIO::ImageBuf>*);

} // namespace vmlight
