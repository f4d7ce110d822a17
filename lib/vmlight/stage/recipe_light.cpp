// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/recipe_light.h>

#include <vmlight/base/words.h>
#include <vmlight/base/work_counts.h>
#include <vmlight/cfem/radiance.h>
#include <vmlight/cfem/stack.h>
#include <vmlight/image/color.h>
#include <vmlight/lightmap/lobe_lookup.h>
#include <vmlight/stage/make_listener.h>
#include <vmlight/stage/recipe_input.h>
#include <vmlight/stage/stored_environment.h>

#include <OpenImageIO/strutil.h>
#include <OpenImageIO/timer.h>

#include <cstdlib>
#include <optional>
#include <type_traits>
#include <utility>

namespace vmlight {
namespace {

using OIIO::Strutil::fmt::format;

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

} // namespace

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
    ++work_counts().cfems_made;
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

template bool filter_environment(std::vector<OIIO::ImageBuf>&, const CfemRecipe&, ModelLight, const MakeOptions&,
                                 std::string&);
template bool filter_environment(std::vector<OIIO::ImageBuf>&, const LightmapRecipe&, ModelLight, const MakeOptions&,
                                 std::string&);

bool read_light(LightmapInputs& dst, const LightmapRecipe& recipe, const ShadingModel& model,
                const MakeOptions& options, std::string& error)
{
    const std::string wanted = light_of(recipe, model);
    if (dst.light == wanted)
        return true;
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
    dst.light = wanted;
    return true;
}

} // namespace vmlight
