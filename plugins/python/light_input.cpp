// SPDX-License-Identifier: Apache-2.0
#include "light_input.h"

#include "mesh_input.h"
#include "recipe_input.h"

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/cfem/stack.h>
#include <vmlight/image/channels.h>
#include <vmlight/image/color.h>
#include <vmlight/lightmap/model.h>
#include <vmlight/lightmap/vismap_check.h>
#include <vmlight/stage/light_color.h>
#include <vmlight/stage/light_effects.h>
#include <vmlight/stage/open_source.h>
#include <vmlight/stage/recipe/udim.h>

#include <OpenImageIO/strutil.h>

namespace vmlight::python {
namespace {

constexpr const char* kImageOrPath = "StrPath | Image | NDArray | ImageBuf";

// All images of a file or a recipe.
bool read_images(std::vector<OIIO::ImageBuf>& dst, const std::string& path, const MakeOptions& given,
                 OIIO::ImageSpec& stored, std::string& error)
{
    MakeOptions options = given;
    if (is_recipe_name(path))
        options.chain.push_back(path);
    const PixelSourcePointer source = open_source(path, error);
    if (!source)
        return false;
    stored = source->spec();
    return source->make(dst, { 0, source->subimages() }, options, error);
}

bool is_filtered(const Image& light)
{
    return light.parts.size() > 1 || light.first().spec().get_string_attribute("vmlight:stage") == kCfemStage;
}

// What applies to images in memory, and to the files among them.
std::vector<std::string> usable_names(bool light_is_file, bool albedo_is_file)
{
    std::vector<std::string> names = param_names(LightmapParams());
    for (const std::string& name : param_names(CfemParams()))
        names.push_back("cfem_" + name);
    names.push_back("is_cfem");
    if (light_is_file)
        names.insert(names.end(), { "colorspace", "layer", "layout" });
    if (albedo_is_file)
        names.push_back("albedo_colorspace");
    if (light_is_file || albedo_is_file)
        names.push_back("colorconfig");
    return names;
}

} // namespace

std::vector<Operand> lightmap_operands()
{
    return { { "vismap", kImageOrPath, "The visibility map; an array of 4 channels has V and B in this order" },
             { "light", kImageOrPath,
               "A lat-long environment, which is filtered first, or a cosine-filtered one or a stack of make_cfem()" },
             { "albedo", "StrPath | Image | NDArray | ImageBuf | None", "A texture to multiply by; linear if in memory",
               "None" } };
}

std::vector<std::string> lightmap_operand_params()
{
    return { "vismap", "environment", "cfem", "albedo" };
}

void check_rotation(const LightmapParams& params)
{
    Rotation ignored;
    if (std::string error; !lightmap_rotation(ignored, params, error))
        throw py::value_error(error);
}

LightInput::LightInput(const Call& call, const LightmapArguments& given, bool is_kept)
    : m_recipe(given.recipe)
{
    const auto take
        = [&](size_t at, std::string& path, std::optional<Image>& image, const std::vector<std::string>& channels) {
              const char* const name = lightmap_operands()[at].name;
              const py::object& value = call.operands[at];
              if (value.is_none() && at == 2)
                  return;
              if (is_path(value))
                  m_paths.push_back(path = path_text(name, value));
              else
                  image = input_image(name, value, channels, is_kept);
          };
    std::string light;
    take(0, m_recipe.vismap, m_vismap, { kVismapChannels.begin(), kVismapChannels.end() });
    take(1, light, m_light, {});
    take(2, m_recipe.albedo, m_albedo, {});
    const bool filtered = given.is_cfem || (m_light ? is_filtered(*m_light) : image_stage(light) == kCfemStage);
    (filtered ? m_recipe.cfem : m_recipe.environment) = m_light ? "light in memory" : light;
    check_rotation(params());
    if (is_all_files()) {
        check_recipe(m_recipe, call);
    } else {
        allow_only(call, usable_names(!light.empty(), !m_recipe.albedo.empty()),
                   "a visibility map, light and albedo that are files");
        check_unused(m_recipe, call);
    }
}

bool LightInput::read(const MakeOptions& options, std::string& error)
{
    if (is_all_files())
        return read_files(options, error);
    m_inputs.finish = [](OIIO::ImageBuf&) {};
    return read_map(options, error) && read_light(options, error) && read_albedo(options, error);
}

bool LightInput::light(OIIO::ImageBuf& dst, const LightmapParams& params, const MakeOptions& options,
                       std::string& error) const
{
    if (!make_lightmap(dst, m_inputs, params, options, error))
        return false;
    tag_udim(dst.specmod(), m_recipe.udim);
    return true;
}

bool LightInput::read_files(const MakeOptions& options, std::string& error)
{
    const LightmapRecipe switched = with_switches(m_recipe);
    return read_lightmap_inputs(m_inputs, switched, options, error)
        && (m_recipe.effects == "auto"
            || explain_light(m_inputs, { m_recipe, params(), switched.lightmap_params }, options, error));
}

bool LightInput::read_map(const MakeOptions& options, std::string& error)
{
    if (m_vismap) {
        m_inputs.vismap = view_of(m_vismap->first());
        return true;
    }
    std::vector<OIIO::ImageBuf> images;
    std::vector<std::string> warnings;
    OIIO::ImageSpec stored;
    if (!read_images(images, m_recipe.vismap, options, stored, error))
        return false;
    if (!check_vismap(images[0], stored, options.threads, warnings, error)) {
        error = format("\"{}\": {}", m_recipe.vismap, error);
        return false;
    }
    for (const std::string& line : warnings)
        options.report_warning(format("\"{}\": {}", m_recipe.vismap, line));
    m_inputs.vismap = std::move(images[0]);
    return true;
}

bool LightInput::read_light(const MakeOptions& options, std::string& error)
{
    if (!m_recipe.cfem.empty()) {
        if (m_light) {
            m_inputs.cfem = views_of(*m_light);
            return true;
        }
        LightColor color;
        OIIO::ImageSpec stored;
        if (!read_images(m_inputs.cfem, m_recipe.cfem, options, stored, error)
            || !describe_light(color, m_recipe, stored, error))
            return false;
        color.convert(m_inputs.cfem, options.threads);
        return true;
    }
    ShadingModel model;
    if (!choose_model(model, params(), m_inputs.vismap.spec(), true, error))
        return false;
    const bool stack = model.light != ModelLight::cfem;
    if (m_light)
        return filter(m_light->first(), stack, options, error);
    CfemRecipe recipe;
    recipe.environment = m_recipe.environment;
    recipe.colorspace = m_recipe.colorspace;
    recipe.colorconfig = m_recipe.colorconfig;
    recipe.layer = m_recipe.layer;
    recipe.layout = m_recipe.layout;
    recipe.cfem_params = m_recipe.cfem_params;
    recipe.cfem_params.kernel = kernel_of(m_inputs.vismap.spec());
    recipe.stack = stack;
    if (make_images(m_inputs.cfem, recipe, options, error))
        return true;
    error = with_filter_prefix(error);
    return false;
}

bool LightInput::filter(const OIIO::ImageBuf& environment, bool stack, const MakeOptions& options, std::string& error)
{
    CfemParams filter = m_recipe.cfem_params;
    filter.kernel = kernel_of(m_inputs.vismap.spec());
    const Progress progress = options.step("filter", filter.resolution.width, filter.resolution.height);
    bool made = false;
    if (stack) {
        made = make_cfem_stack(m_inputs.cfem, environment, filter, error, options.threads, progress);
    } else {
        m_inputs.cfem.resize(1);
        made = make_cfem(m_inputs.cfem[0], environment, filter, options.threads, progress);
        if (!made)
            error = oiio::error_line(m_inputs.cfem[0]);
    }
    if (!made)
        error = with_filter_prefix(error);
    return made;
}

bool LightInput::read_albedo(const MakeOptions& options, std::string& error)
{
    if (m_albedo)
        m_inputs.albedo = view_of(m_albedo->first());
    if (m_albedo || m_recipe.albedo.empty())
        return true;
    std::vector<OIIO::ImageBuf> images;
    OIIO::ImageSpec stored;
    std::string note;
    if (!read_images(images, m_recipe.albedo, options, stored, error)
        || !to_scene_linear(images[0], m_recipe.albedo,
                            { m_recipe.colorconfig, m_recipe.albedo_colorspace, stored.format,
                              m_inputs.cfem[0].spec().get_string_attribute("colorInteropID") },
                            note, error, options.threads))
        return false;
    m_inputs.albedo = std::move(images[0]);
    return true;
}

} // namespace vmlight::python
