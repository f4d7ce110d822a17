// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/open_source.h>

#include <vmlight/base/file_stamp.h>
#include <vmlight/stage/stored_image.h>

#include <OpenImageIO/strutil.h>
#include <OpenImageIO/sysutil.h>

#include <utility>

namespace vmlight {
namespace {

template <class Recipe> PixelSourcePointer open_recipe(const std::string& name, std::string& error, RecipeChain chain)
{
    Recipe recipe;
    return link_recipe(chain, name, error) && read_recipe(recipe, name, error) ? open_source(recipe, error, chain)
                                                                               : nullptr;
}

} // namespace

PixelSourcePointer open_source(const std::string& name, std::string& error, const RecipeChain& chain)
{
    const std::string stage = recipe_stage(name);
    return stage == VismapRecipe::kStage  ? open_recipe<VismapRecipe>(name, error, chain)
        : stage == CfemRecipe::kStage     ? open_recipe<CfemRecipe>(name, error, chain)
        : stage == LightmapRecipe::kStage ? open_recipe<LightmapRecipe>(name, error, chain)
                                          : open_stored_image(name, error);
}

template <class Recipe>
PixelSourcePointer open_input(const Recipe& recipe, const char* key, const std::string& name, Input wanted,
                              std::string& error, const RecipeChain& chain)
{
    const std::string stage = recipe_stage(name);
    RecipeChain longer = chain;
    PixelSourcePointer source;
    // A recipe of the wrong stage is refused before what it reads is opened, but as what it is if it reads itself.
    if (stage.empty() || link_recipe(longer, name, error))
        error = stage.empty() ? "" : input_fault(name, stage, wanted);
    if (error.empty())
        source = open_source(name, error, chain);
    if (source)
        error = input_fault(name, source->spec().get_string_attribute("vmlight:stage"), wanted);
    if (error.empty())
        return source;
    error = placed(recipe, key, chain, error);
    return nullptr;
}

template PixelSourcePointer open_input(const CfemRecipe&, const char*, const std::string&, Input, std::string&,
                                       const RecipeChain&);
template PixelSourcePointer open_input(const LightmapRecipe&, const char*, const std::string&, Input, std::string&,
                                       const RecipeChain&);

bool stamp_config(std::string& stamp, const std::string& colorconfig, std::string& error)
{
    const std::string config = colorconfig.empty() ? std::string(OIIO::Sysutil::getenv("OCIO")) : colorconfig;
    stamp = config + "\n"; // none, or one that is built into OpenColorIO
    return config.empty() || OIIO::Strutil::starts_with(config, "ocio://") || stamp_file(stamp, config, error);
}

} // namespace vmlight
