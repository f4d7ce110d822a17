// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/make_stage.h>

#include <vmlight/base/fail_with.h>
#include <vmlight/image/image_file.h>
#include <vmlight/stage/open_source.h>

#include <utility>

namespace vmlight {
namespace {

// All images that the recipe makes. Its source is not kept: what it makes goes to the caller.
template <class Recipe>
bool make(std::vector<OIIO::ImageBuf>& dst, const Recipe& recipe, const MakeOptions& options, std::string& error)
{
    const PixelSourcePointer source = open_source(recipe, error, options.chain, Sharing::none);
    return source && source->make(dst, { 0, source->subimages() }, options, error);
}

template <class Recipe> bool make_first(OIIO::ImageBuf& dst, const Recipe& recipe, const MakeOptions& options)
{
    std::vector<OIIO::ImageBuf> images;
    std::string error;
    if (!make(images, recipe, options, error))
        return fail_with(dst, error);
    dst = std::move(images[0]);
    return true;
}

} // namespace

bool make_image(OIIO::ImageBuf& dst, const VismapRecipe& recipe, const MakeOptions& options)
{
    return make_first(dst, recipe, options);
}

bool make_image(OIIO::ImageBuf& dst, const CfemRecipe& recipe, const MakeOptions& options)
{
    return make_first(dst, recipe, options);
}

bool make_image(OIIO::ImageBuf& dst, const LightmapRecipe& recipe, const MakeOptions& options)
{
    return make_first(dst, recipe, options);
}

bool make_images(std::vector<OIIO::ImageBuf>& dst, const CfemRecipe& recipe, const MakeOptions& options,
                 std::string& error)
{
    return make(dst, recipe, options, error);
}

std::string image_stage(const std::string& name)
{
    const std::string stage = recipe_stage(name);
    if (!stage.empty())
        return stage;
    if (!may_be_image(name))
        return "";
    std::string ignored; // whoever reads the pixels reports it
    const auto in = open_image(name, ignored);
    return in ? in->spec().get_string_attribute("vmlight:stage") : "";
}

} // namespace vmlight
