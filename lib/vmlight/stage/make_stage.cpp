// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/make_stage.h>

#include <vmlight/base/fail_with.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/image/image_file.h>
#include <vmlight/stage/bounce_shading.h>
#include <vmlight/stage/open_source.h>
#include <vmlight/stage/sun_shading.h>

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

bool make_lightmap(OIIO::ImageBuf& dst, const LightmapInputs& inputs, const LightmapParams& params,
                   const MakeOptions& options, std::string& error)
{
    SunLight suns;
    const auto read = [&](int channel, std::vector<float>& dst, std::string& reason) {
        OIIO::ROI roi = inputs.vismap.roi();
        roi.chbegin = channel;
        roi.chend = channel + 1;
        dst.resize(size_t(roi.npixels()));
        reason = inputs.vismap.get_pixels(roi, OIIO::TypeFloat, dst.data()) ? "" : oiio::error_line(inputs.vismap);
        return reason.empty();
    };
    if (inputs.suns && !inputs.suns->shading->light(suns, inputs.suns->list, params, read, options, error))
        return false;
    const OIIO::ImageSpec& map = inputs.vismap.spec();
    const SunLight* lit_suns = suns.suns.empty() ? nullptr : &suns;
    BounceLight bounce;
    if (inputs.bounce) {
        AlbedoReader albedo;
        if (!albedo.open(inputs.albedo, inputs.vismap.roi(), options.threads, error)
            || !inputs.bounce->light(bounce, inputs.vismap, inputs.cfem, lit_suns, params, albedo, options, error))
            return false;
    }
    if (!make_lightmap(dst, inputs.vismap, inputs.cfem, lit_suns, bounce.light.empty() ? nullptr : &bounce, params,
                       inputs.albedo_or_none(), options.threads, options.step("light", map.width, map.height))) {
        error = oiio::error_line(dst);
        return false;
    }
    if (inputs.bounce)
        inputs.bounce->tag(dst.specmod());
    inputs.finish(dst);
    return true;
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
