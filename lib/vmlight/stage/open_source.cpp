// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/open_source.h>

#include <vmlight/base/file_stamp.h>
#include <vmlight/base/format.h>
#include <vmlight/mesh/import/importer.h>
#include <vmlight/stage/layer_source.h>
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
#define VMLIGHT_OPEN(Recipe)                                                                                           \
    if (stage == Recipe::kStage)                                                                                       \
        return open_recipe<Recipe>(name, error, chain);
    VMLIGHT_RECIPES(VMLIGHT_OPEN)
#undef VMLIGHT_OPEN
    return open_stored_image(name, error);
}

template <class Recipe>
PixelSourcePointer open_input(const Recipe& recipe, const char* key, const std::string& name, InputKind wanted,
                              std::string& error, const RecipeChain& chain, const std::string& layer)
{
    const std::string stage = recipe_stage(name);
    RecipeChain longer = chain;
    PixelSourcePointer source;
    // Refuse a recipe of the wrong stage before opening its inputs; a recipe that reads itself gets its own error.
    if (stage.empty() || link_recipe(longer, name, error))
        error = stage.empty() ? "" : input_fault(name, stage, wanted);
    if (error.empty() && is_mesh_name(name))
        error
            = format("\"{}\": a mesh, not an image{}", name,
                     wanted == InputKind::Vismap ? "; bake it with makevismap first, and use its visibility map" : "");
    if (error.empty() && !layer.empty() && !stage.empty())
        error = format("\"{}\": a recipe has no layers", name);
    if (error.empty())
        source = layer.empty() ? open_source(name, error, chain) : open_layer(name, layer, error);
    if (source)
        error = input_fault(name, source->spec().get_string_attribute("vmlight:stage"), wanted);
    if (error.empty())
        return source;
    error = with_location(recipe, key, chain, error);
    return nullptr;
}

#define VMLIGHT_DEFINE(Recipe)                                                                                         \
    template PixelSourcePointer open_input(const Recipe&, const char*, const std::string&, InputKind, std::string&,    \
                                           const RecipeChain&, const std::string&);
VMLIGHT_RECIPES(VMLIGHT_DEFINE)
#undef VMLIGHT_DEFINE

bool stamp_config(std::string& stamp, const std::string& colorconfig, std::string& error)
{
    const std::string config = colorconfig.empty() ? std::string(OIIO::Sysutil::getenv("OCIO")) : colorconfig;
    stamp = config + "\n"; // no config, or one built into OpenColorIO
    return config.empty() || OIIO::Strutil::starts_with(config, "ocio://") || stamp_file(stamp, config, error);
}

} // namespace vmlight
