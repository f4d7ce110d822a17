// SPDX-License-Identifier: Apache-2.0
#include <vmlight/make_stage.h>

#include <vmlight/bake_report.h>
#include <vmlight/bake_scene.h>
#include <vmlight/cfem_stack.h>
#include <vmlight/channels.h>
#include <vmlight/color.h>
#include <vmlight/fail.h>
#include <vmlight/image_file.h>
#include <vmlight/lobe_lookup.h>
#include <vmlight/radiance.h>
#include <vmlight/recipe_chain.h>
#include <vmlight/recipe_udim.h>
#include <vmlight/scene_cache.h>
#include <vmlight/shading_model.h>
#include <vmlight/stage_counts.h>
#include <vmlight/stored_environment.h>
#include <vmlight/vismap_baker.h>
#include <vmlight/words.h>

#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>
#include <OpenImageIO/timer.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>

namespace vmlight {
namespace {

using OIIO::Strutil::fmt::format;

void tell(const std::function<void(const std::string&)>& listener, const std::string& line)
{
    if (listener)
        listener(line);
}

Progress step(const MakeOptions& options, const char* name, int64_t width, int64_t height)
{
    return options.progress ? options.progress(name, width * height) : Progress {};
}

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

// What `recipe` gives as `key`.
template <class Recipe>
bool read_input(OIIO::ImageBuf& dst, const Recipe& recipe, const char* key, const std::string& name, Input wanted,
                const MakeOptions& options, std::string& error, std::vector<OIIO::ImageBuf>* levels = nullptr)
{
    if (read_image_or_recipe(dst, name, wanted, options, error, levels))
        return true;
    error = placed(recipe, key, options.chain, error);
    return false;
}

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

// What `light` says of an environment.
bool filter(std::vector<OIIO::ImageBuf>& dst, const Environment& environment, const CfemParams& params,
            ModelLight light, int threads, const Progress& progress, std::string& error)
{
    if (light == ModelLight::lobes)
        return make_cfem_stack(dst, environment, params, error, threads, progress);
    if (light == ModelLight::radiance)
        return make_radiance(dst[0], environment, params, error, progress);
    if (make_cfem(dst[0], environment, params, threads, progress))
        return true;
    error = dst[0].geterror();
    return false;
}

// `recipe.environment` in scene-linear light: `held`, or a file that is too large for that.
template <class Recipe>
bool open_environment(std::optional<Environment>& dst, OIIO::ImageBuf& held, const Recipe& recipe,
                      const MakeOptions& options, std::string& note, std::string& error)
{
    constexpr Input kWanted = std::is_same_v<Recipe, LightmapRecipe> ? Input::Environment : Input::Panorama;
    const std::string& name = recipe.environment;
    const ColorSettings color { recipe.colorconfig, recipe.colorspace };
    const PixelSourcePointer file = recipe_stage(name).empty() ? open_large_image(name) : nullptr;
    if (!file) {
        dst.emplace(held);
        return read_input(held, recipe, "environment", name, kWanted, options, error)
            && to_scene_linear(held, name, color, note, error);
    }
    error = input_fault(name, file->spec().get_string_attribute("vmlight:stage"), kWanted);
    if (!error.empty())
        error = placed(recipe, "environment", options.chain, error);
    return error.empty() && read_as_it_goes(dst, file, name, color, note, error);
}

// Read `recipe.environment` in scene-linear light and filter it.
template <class Recipe>
bool filter_environment(std::vector<OIIO::ImageBuf>& dst, const Recipe& recipe, ModelLight light,
                        const MakeOptions& options, std::string& error)
{
    const std::string& name = recipe.environment;
    OIIO::ImageBuf held;
    std::optional<Environment> environment;
    std::string note;
    if (!open_environment(environment, held, recipe, options, note, error))
        return false;
    const OIIO::ImageSpec& spec = environment->spec();
    const int width = spec.width, height = spec.height;
    if (std::abs(spec.full_width - 2 * spec.full_height) > 2) // border samples are one more each way
        tell(options.warn,
             format("\"{}\" is {}x{}, not twice as wide as high; it is taken as a lat-long map all the same", name,
                    spec.full_width, spec.full_height));
    const OIIO::Timer timer;
    dst.resize(1);
    const Size size = recipe.cfem_params.resolution;
    const Progress progress = step(options, "filter", size.width, size.height);
    if (!filter(dst, *environment, recipe.cfem_params, light, options.threads, progress, error)) {
        error = format("\"{}\": {}", name, error);
        return false;
    }
    ++stage_counts().cfems_made;
    for (OIIO::ImageBuf& level : dst)
        record_environment(level.specmod(), name);
    tell(options.say, "colour: " + note);
    tell(options.say,
         format("{}: {}x{} to {}{}x{} in {:.3f} s", light == ModelLight::radiance ? "reduce" : "filter", width, height,
                dst.size() > 1 ? format("{} of ", dst.size()) : "", size.width, size.height, timer()));
    if (const int mended = dst[0].spec().get_int_attribute("vmlight:sanitized"))
        tell(options.warn,
             format("{} of the environment {} mended", counted(mended, "bad value", "bad values"),
                    plural(mended, "was", "were")));
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

// All that a lightmap's light is made from.
std::string light_of(const LightmapRecipe& recipe, const ShadingModel& model)
{
    std::string text = format("{}\n", int(model.light));
    LightmapRecipe copy = recipe;
    copy.visit([&](const char* name, auto& value, const auto& allowed, const char*) {
        const std::string key = name;
        if (key == "environment" || key == "colorspace" || key == "colorconfig" || key.compare(0, 4, "cfem") == 0)
            text += key + "=" + value_text(value, allowed) + "\n";
    });
    return text;
}

// What `model` reads: an environment is filtered for it, a stored CFEM is a stack or not.
bool read_light(LightmapInputs& dst, const LightmapRecipe& recipe, const ShadingModel& model,
                const MakeOptions& options, std::string& error)
{
    dst.light.clear();
    dst.cfem.clear();
    const bool wants_stack = model.light != ModelLight::cfem, filtered = !recipe.cfem.empty();
    OIIO::ImageBuf first;
    if (!filtered && !filter_environment(dst.cfem, recipe, model.light, options, error))
        return false;
    if (filtered
        && !read_input(first, recipe, "cfem", recipe.cfem, Input::Cfem, options, error,
                       wants_stack ? &dst.cfem : nullptr))
        return false;
    if (filtered && !wants_stack)
        dst.cfem.push_back(std::move(first));
    if (recipe.lightmap_params.model == "auto")
        tell(options.say,
             filtered && !is_stack(dst.cfem)
                 ? "model: paper, since the CFEM is no stack (makecfem --stack)"
                 : format("model: {}, the best that the visibility map is fit for", model.name));
    dst.light = light_of(recipe, model);
    return true;
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
        && (dst.light == light_of(recipe, model) || read_light(dst, recipe, model, options, error))
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
