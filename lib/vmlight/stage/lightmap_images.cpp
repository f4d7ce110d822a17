// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/lightmap_images.h>

#include <vmlight/base/format.h>
#include <vmlight/image/channels.h>
#include <vmlight/lightmap/model.h>
#include <vmlight/stage/open_source.h>
#include <vmlight/stage/output_color.h>
#include <vmlight/stage/sun_choice.h>

#include <OpenImageIO/strutil.h>

namespace vmlight {
namespace {

PixelSourcePointer open_light(PixelSourcePointer& environment, const LightmapRecipe& recipe,
                              const OIIO::ImageSpec& vismap, std::string& error, const RecipeChain& chain)
{
    if (!recipe.cfem.empty())
        return open_input(recipe, "cfem", recipe.cfem, InputKind::Cfem, error, chain);
    environment
        = open_input(recipe, "environment", recipe.environment, InputKind::Environment, error, chain, recipe.layer);
    if (!environment)
        return nullptr;
    // Errors of the visibility map are reported by describe().
    ShadingModel model;
    std::string ignored;
    choose_model(model, recipe.lightmap_params, vismap, true, ignored);
    CfemRecipe filter;
    filter.environment = recipe.environment;
    filter.colorspace = recipe.colorspace;
    filter.colorconfig = recipe.colorconfig;
    filter.layer = recipe.layer;
    filter.layout = recipe.layout;
    filter.cfem_params = recipe.cfem_params;
    filter.stack = model.light != ModelLight::cfem;
    if (model.light != ModelLight::radiance) // which is not filtered
        filter.cfem_params.kernel = kernel_of(vismap);
    filter.suns = recipe.suns == "off" ? "off" : "auto";
    return open_source(filter, error);
}

// The bounce is traced from the mesh of a map.
std::string bounce_fault(const LightmapRecipe& recipe, const OIIO::ImageSpec& vismap, const RecipeChain& chain)
{
    const std::string key = "bounce";
    return recipe.bounce_params.bounce == "off" || kernel_of(vismap) != kStrandKernel
        ? ""
        : with_location(
            recipe, key, chain,
            format("{}not with \"{}\", a visibility map of strands", chain.empty() ? key + ": " : "", recipe.vismap));
}

std::shared_ptr<AlbedoSource> open_albedo(const LightmapRecipe& recipe, OIIO::ROI size, const std::string& working,
                                          std::string& error, const RecipeChain& chain)
{
    const PixelSourcePointer image
        = open_input(recipe, "albedo", recipe.albedo, InputKind::Albedo, error, chain, recipe.albedo_layer);
    if (!image)
        return nullptr;
    std::string config;
    if (!stamp_config(config, recipe.colorconfig, error)) {
        error = with_location(recipe, "colorconfig", chain, error);
        return nullptr;
    }
    auto albedo = AlbedoSource::open(recipe, image, config, working, size, error);
    if (!albedo)
        error = with_location(recipe, "albedo", chain, error);
    return albedo;
}

} // namespace

std::string conversions_of(const LightmapRecipe& recipe, const LightmapImages& images, const OutputColor& output)
{
    std::vector<std::string> notes;
    const auto add = [&](const char* input, const std::string& note) {
        if (!note.empty())
            notes.push_back(std::string(input) + note);
    };
    if (images.environment)
        add("environment: ",
            conversion_note(images.environment->spec(), recipe.environment,
                            { recipe.colorconfig, recipe.colorspace, images.environment->spec().format }));
    add("light: ", images.light.conversion ? images.light.note : "");
    add("albedo: ", images.albedo ? images.albedo->conversion_note() : "");
    add("result: ", output.converts() ? output.space() : "");
    return OIIO::Strutil::join(notes, "; ");
}

bool open_images(LightmapImages& dst, const LightmapRecipe& given, std::string& error, const RecipeChain& chain)
{
    LightmapRecipe recipe = given;
    dst.vismap = open_input(recipe, "vismap", recipe.vismap, InputKind::Vismap, error, chain);
    if (dst.vismap)
        error = bounce_fault(recipe, dst.vismap->spec(), chain);
    if (!error.empty())
        return false;
    if (dst.vismap && recipe.suns == "auto" && recipe.cfem.empty()) { // without its suns, a CFEM is too dark
        dst.no_suns = why_no_suns(recipe, dst.vismap->spec(), recipe.vismap);
        recipe.suns = dst.no_suns.empty() ? "auto" : "off";
    }
    if (dst.vismap && recipe.bounce_params.bounce == "auto") {
        dst.no_bounce = why_no_bounce(recipe, dst.vismap->spec(), recipe.vismap);
        recipe.bounce_params.bounce = dst.no_bounce.empty() ? "auto" : "off";
    }
    if (dst.vismap)
        dst.cfem = open_light(dst.environment, recipe, dst.vismap->spec(), error, chain);
    if (!error.empty())
        return false;
    if (recipe.suns == "auto" && !recipe.cfem.empty() && !dst.cfem->spec().find_attribute(kSunsAttribute))
        recipe.suns = "off";
    std::string config;
    if ((may_convert_light(recipe, dst.cfem->spec()) || !recipe.output_colorspace.empty())
        && !stamp_config(config, recipe.colorconfig, error)) {
        error = with_location(recipe, "colorconfig", chain, error);
        return false;
    }
    if (!describe_light(dst.light, recipe, dst.cfem->spec(), error)) {
        error = with_location(recipe, "cfem", chain, error);
        return false;
    }
    dst.key = config + dst.vismap->key() + dst.cfem->key();
    std::shared_ptr<MapScene> scene;
    const bool has_bounce = recipe.bounce_params.bounce != "off";
    if (recipe.suns != "off" || has_bounce) {
        scene = MapScene::open(recipe, dst.vismap->spec(), has_bounce, error, chain);
        if (!scene)
            return false;
    }
    if (recipe.suns != "off") {
        dst.suns = SunShading::open(recipe, dst.vismap->spec(), scene, error, chain);
        if (!dst.suns)
            return false;
        dst.key += dst.suns->key();
    } else if (!recipe.cfem.empty() && dst.cfem->spec().find_attribute(kSunsAttribute)) {
        error = with_location(recipe, "cfem", chain,
                              format("\"{}\": its suns were split off (makecfem --suns auto), and without them it is "
                                     "too dark; set --suns auto",
                                     recipe.cfem));
        return false;
    }
    if (!recipe.albedo.empty()) {
        dst.albedo = open_albedo(recipe, OIIO::get_roi(dst.vismap->spec()),
                                 dst.light.spec.get_string_attribute("colorInteropID"), error, chain);
        if (!dst.albedo)
            return false;
        dst.key += dst.albedo->key();
    }
    if (has_bounce) {
        dst.bounce = BounceShading::open(recipe, *dst.vismap, dst.light.spec, scene, error, chain);
        if (!dst.bounce)
            return false;
        dst.key += dst.bounce->key();
    }
    return true;
}

} // namespace vmlight
