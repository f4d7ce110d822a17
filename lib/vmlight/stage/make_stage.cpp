// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/make_stage.h>

#include <vmlight/base/fail.h>
#include <vmlight/base/work_counts.h>
#include <vmlight/image/color.h>
#include <vmlight/image/image_file.h>
#include <vmlight/lightmap/model.h>
#include <vmlight/stage/bake_report.h>
#include <vmlight/stage/make_listener.h>
#include <vmlight/stage/recipe/chain.h>
#include <vmlight/stage/recipe/udim.h>
#include <vmlight/stage/recipe_input.h>
#include <vmlight/stage/recipe_light.h>
#include <vmlight/stage/scene_cache.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/vismap/baker.h>

#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>
#include <OpenImageIO/timer.h>

#include <utility>

namespace vmlight {
namespace {

using OIIO::Strutil::fmt::format;

// Made, or that of another tile, map or reader of the same mesh.
bool make_scene(BakeScenePointer& dst, const VismapRecipe& recipe, const MakeOptions& options, double& build_seconds,
                std::string& error)
{
    SceneStamps stamps;
    std::string at;
    if (!stamp_scene(stamps, recipe, at, error)
        || !share_scene(dst, recipe, stamps, options.threads, &build_seconds, at, error)) {
        error = placed(recipe, at, options.chain, error);
        return false;
    }
    if (options.scene)
        *options.scene = dst;
    return true;
}

// `model` is the one for the best of light.
bool read_vismap(OIIO::ImageBuf& dst, ShadingModel& model, const LightmapRecipe& recipe, const MakeOptions& options,
                 std::string& error)
{
    if (!read_input(dst, recipe, "vismap", recipe.vismap, Input::Vismap, options, error))
        return false;
    if (find_model(model, recipe.lightmap_params, dst.spec(), true, error))
        return true;
    error = placed(recipe, "vismap", options.chain, format("\"{}\": {}", recipe.vismap, error));
    return false;
}

bool read_albedo(OIIO::ImageBuf& dst, const LightmapRecipe& recipe, const MakeOptions& options, std::string& error)
{
    std::string note;
    if (!read_input(dst, recipe, "albedo", recipe.albedo, Input::Albedo, options, error)
        || !to_scene_linear(dst, recipe.albedo, { recipe.colorconfig, recipe.albedo_colorspace }, note, error))
        return false;
    tell(options.say, "albedo: " + note);
    return true;
}

} // namespace

bool make_image(OIIO::ImageBuf& dst, const VismapRecipe& given, const MakeOptions& options)
{
    const VismapRecipe recipe = resolve_udim(given);
    std::string error = recipe_fault(recipe, options.chain);
    BakeScenePointer scene;
    double build_seconds = 0;
    if (!error.empty() || !make_scene(scene, recipe, options, build_seconds, error))
        return fail(dst, error);
    VismapReport report;
    const Size size = recipe.vismap_params.size();
    if (!make_vismap(dst, scene, recipe.vismap_params, &report, options.threads,
                     step(options, "bake", size.width, size.height), recipe.time_budget))
        return false;
    report.build_seconds += build_seconds;
    append_params(dst.specmod(), recipe.mesh_params);
    report_bake(options, report, dst.spec(), recipe);
    return true;
}

bool make_images(std::vector<OIIO::ImageBuf>& dst, const CfemRecipe& given, const MakeOptions& options,
                 std::string& error)
{
    const CfemRecipe recipe = resolve_udim(given);
    error = recipe_fault(recipe, options.chain);
    if (!error.empty()
        || !filter_environment(dst, recipe, recipe.stack ? ModelLight::lobes : ModelLight::cfem, options, error))
        return false;
    for (OIIO::ImageBuf& level : dst)
        tag_udim(level.specmod(), recipe.udim);
    return true;
}

bool make_image(OIIO::ImageBuf& dst, const CfemRecipe& recipe, const MakeOptions& options)
{
    std::vector<OIIO::ImageBuf> images;
    std::string error;
    if (!make_images(images, recipe, options, error))
        return fail(dst, error);
    dst = std::move(images[0]);
    return true;
}

bool make_image(OIIO::ImageBuf& dst, const LightmapRecipe& recipe, const MakeOptions& options)
{
    LightmapInputs inputs;
    std::string error;
    if (!read_lightmap_inputs(inputs, recipe, options, error))
        return fail(dst, error);
    const OIIO::Timer timer;
    if (!make_lightmap(dst, inputs.vismap, inputs.cfem, recipe.lightmap_params, inputs.albedo_or_none(),
                       options.threads,
                       step(options, "light", inputs.vismap.spec().width, inputs.vismap.spec().height)))
        return false;
    tag_udim(dst.specmod(), recipe.udim);
    tell(options.say, format("light: 1 map of {}x{} in {:.3f} s", dst.spec().width, dst.spec().height, timer()));
    return true;
}

bool vismap_udims(std::vector<int>& dst, const VismapRecipe& given, const MakeOptions& options, std::string& error)
{
    const VismapRecipe recipe = resolve_udim(given);
    error = recipe_fault(recipe, options.chain);
    BakeScenePointer scene;
    double ignored = 0;
    if (!error.empty() || !make_scene(scene, recipe, options, ignored, error))
        return false;
    dst = mesh_udims(scene->mesh());
    if (dst.empty())
        error = placed(recipe, "mesh", options.chain,
                       format("\"{}\": its texture coordinates lie in no UDIM tile", recipe.mesh));
    return !dst.empty();
}

bool read_lightmap_inputs(LightmapInputs& dst, const LightmapRecipe& given, const MakeOptions& options,
                          std::string& error)
{
    const LightmapRecipe recipe = resolve_udim(given);
    error = recipe_fault(recipe, options.chain);
    // One tile's images at a time.
    dst.vismap.reset();
    dst.albedo.reset();
    // The visibility map first, before an environment is filtered in vain.
    ShadingModel model;
    return error.empty() && read_vismap(dst.vismap, model, recipe, options, error)
        && read_light(dst, recipe, model, options, error)
        && (recipe.albedo.empty() || read_albedo(dst.albedo, recipe, options, error));
}

std::string image_stage(const std::string& name)
{
    const std::string stage = recipe_stage(name);
    if (!stage.empty())
        return stage;
    if (!may_be_image(name))
        return "";
    const auto in = OIIO::ImageInput::open(name);
    if (!in)
        OIIO::geterror(); // the reader of the pixels will tell
    return in ? in->spec().get_string_attribute("vmlight:stage") : "";
}

} // namespace vmlight
