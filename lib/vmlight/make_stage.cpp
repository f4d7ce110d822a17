// SPDX-License-Identifier: Apache-2.0
#include <vmlight/make_stage.h>

#include <vmlight/channels.h>
#include <vmlight/color.h>
#include <vmlight/fail.h>
#include <vmlight/image_file.h>
#include <vmlight/recipe_chain.h>
#include <vmlight/words.h>

#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>
#include <OpenImageIO/timer.h>

#include <algorithm>
#include <array>

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

// An image, or what its recipe makes.
bool read_image_or_recipe(OIIO::ImageBuf& dst, const std::string& name, Input wanted, const MakeOptions& options,
                          std::string& error)
{
    const std::string found = recipe_stage(name);
    if (found.empty()) {
        if (read_image(dst, name, error))
            error = input_fault(name, dst.spec().get_string_attribute("vmlight:stage"), wanted);
        return error.empty();
    }
    MakeOptions inner = options;
    if (!link_recipe(inner.chain, name, error))
        return false;
    error = input_fault(name, found, wanted);
    if (!error.empty())
        return false;
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
                const MakeOptions& options, std::string& error)
{
    if (read_image_or_recipe(dst, name, wanted, options, error))
        return true;
    error = placed(recipe, key, options.chain, error);
    return false;
}

// "1 texel"
std::string counted(int64_t count, const char* one, const char* many)
{
    return format("{} {}", count, plural(count, one, many));
}

double percent(int64_t part, int64_t whole)
{
    return whole ? 100.0 * double(part) / double(whole) : 0.0;
}

void report_bake(const MakeOptions& options, const VismapReport& report, const OIIO::ImageSpec& spec)
{
    const UvReport& uv = report.uv;
    tell(options.say,
         format("uv: {} {} {:.1f} % of {}x{} texels; {} {}; triangles: {} reach out of "
                "[0,1], {} mirrored, {} without area in uv, {} in space, {} without uv",
                uv.triangles, plural(uv.triangles, "triangle covers", "triangles cover"),
                percent(report.covered, report.texels), spec.width, spec.height, report.overlapping,
                plural(report.overlapping, "texel overlaps", "texels overlap"), uv.outside, uv.mirrored,
                uv.degenerate_uv, uv.degenerate_3d, uv.without_uv));
    tell(options.say,
         format("bake: {:.2f} M rays in {:.2f} s, {:.2f} M rays/s; build {:.2f} s, margin {:.2f} s",
                double(report.rays) * 1e-6, report.bake_seconds,
                double(report.rays) * 1e-6 / std::max(report.bake_seconds, 1e-9), report.build_seconds,
                report.margin_seconds));
    if (report.overlapping > 0)
        tell(
            options.warn,
            format("{} ({:.2f} % of those covered) {} to more than one triangle: the first triangle of the file has {}",
                   counted(report.overlapping, "texel", "texels"), percent(report.overlapping, report.covered),
                   plural(report.overlapping, "belongs", "belong"), plural(report.overlapping, "it", "them")));
    if (uv.outside > 0)
        tell(options.warn,
             format("{} of {} {} out of [0,1] in uv: what lies outside is not baked", uv.outside,
                    counted(uv.triangles, "triangle", "triangles"), plural(uv.outside, "reaches", "reach")));
    if (uv.without_uv > 0)
        tell(options.warn,
             format("{} of {} {}", uv.without_uv, counted(uv.triangles, "triangle", "triangles"),
                    plural(uv.without_uv, "has no uv: it casts, and is not baked",
                           "have no uv: they cast, and are not baked")));
    if (report.covered == 0)
        tell(options.warn, "no texel centre is covered: the map is empty");
    else if (report.dark > report.covered / 2)
        tell(options.warn,
             format("{:.0f} % of the covered texels see nothing: do the normals point inwards?",
                    percent(report.dark, report.covered)));
}

// Read `recipe.environment` in scene-linear light and filter it.
template <class Recipe>
bool filter_environment(OIIO::ImageBuf& dst, const Recipe& recipe, const MakeOptions& options, std::string& error)
{
    constexpr Input kWanted = std::is_same_v<Recipe, LightmapRecipe> ? Input::Environment : Input::Panorama;
    const std::string& name = recipe.environment;
    OIIO::ImageBuf environment;
    std::string note;
    if (!read_input(environment, recipe, "environment", name, kWanted, options, error))
        return false;
    const int width = environment.spec().width, height = environment.spec().height;
    if (!to_scene_linear(environment, name, { recipe.colorconfig, recipe.colorspace }, note, error))
        return false;
    const OIIO::Timer timer;
    const Size size = recipe.cfem_params.resolution;
    if (!make_cfem(dst, environment, recipe.cfem_params, options.threads,
                   step(options, "filter", size.width, size.height))) {
        error = format("\"{}\": {}", name, dst.geterror());
        return false;
    }
    record_environment(dst.specmod(), name);
    tell(options.say, "colour: " + note);
    tell(options.say,
         format("filter: {}x{} to {}x{} in {:.3f} s", width, height, dst.spec().width, dst.spec().height, timer()));
    if (const int mended = dst.spec().get_int_attribute("vmlight:sanitized"))
        tell(options.warn,
             format("{} of the environment {} mended", counted(mended, "bad value", "bad values"),
                    plural(mended, "was", "were")));
    return true;
}

bool read_vismap(OIIO::ImageBuf& dst, const LightmapRecipe& recipe, const MakeOptions& options, std::string& error)
{
    std::array<int, 4> channels;
    if (!read_input(dst, recipe, "vismap", recipe.vismap, Input::Vismap, options, error))
        return false;
    if (find_vismap_channels(dst.spec(), channels, error))
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

bool make_image(OIIO::ImageBuf& dst, const VismapRecipe& recipe, const MakeOptions& options)
{
    std::string error = recipe_fault(recipe, options.chain);
    if (!error.empty())
        return fail(dst, error);
    Mesh mesh;
    std::vector<Mesh> occluders(recipe.occluder.size());
    if (!read_mesh(mesh, recipe.mesh, recipe.mesh_params, error))
        return fail(dst, placed(recipe, "mesh", options.chain, error));
    for (size_t i = 0; i < occluders.size(); ++i)
        if (!read_mesh(occluders[i], recipe.occluder[i], recipe.mesh_params, error))
            return fail(dst, placed(recipe, "occluder", options.chain, error));
    VismapReport report;
    const Size size = recipe.vismap_params.size();
    if (!make_vismap(dst, mesh, occluders, recipe.vismap_params, &report, options.threads,
                     step(options, "bake", size.width, size.height)))
        return false;
    append_params(dst.specmod(), recipe.mesh_params);
    report_bake(options, report, dst.spec());
    return true;
}

bool make_image(OIIO::ImageBuf& dst, const CfemRecipe& recipe, const MakeOptions& options)
{
    std::string error = recipe_fault(recipe, options.chain);
    if (!error.empty() || !filter_environment(dst, recipe, options, error))
        return fail(dst, error);
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
    tell(options.say, format("light: 1 map of {}x{} in {:.3f} s", dst.spec().width, dst.spec().height, timer()));
    return true;
}

bool read_lightmap_inputs(LightmapInputs& dst, const LightmapRecipe& recipe, const MakeOptions& options,
                          std::string& error)
{
    error = recipe_fault(recipe, options.chain);
    // The visibility map first, before an environment is filtered in vain.
    return error.empty() && read_vismap(dst.vismap, recipe, options, error)
        && (recipe.cfem.empty() ? filter_environment(dst.cfem, recipe, options, error)
                                : read_input(dst.cfem, recipe, "cfem", recipe.cfem, Input::Cfem, options, error))
        && (recipe.albedo.empty() || read_albedo(dst.albedo, recipe, options, error));
}

std::string image_stage(const std::string& name)
{
    const std::string stage = recipe_stage(name);
    if (!stage.empty())
        return stage;
    const auto in = OIIO::ImageInput::open(name);
    if (!in)
        OIIO::geterror(); // the reader of the pixels will tell
    return in ? in->spec().get_string_attribute("vmlight:stage") : "";
}

} // namespace vmlight
