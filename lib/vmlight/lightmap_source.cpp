// SPDX-License-Identifier: Apache-2.0
#include <vmlight/pixel_source.h>

#include <vmlight/channels.h>
#include <vmlight/color.h>
#include <vmlight/lightmap_shader.h>
#include <vmlight/once_cache.h>
#include <vmlight/recipe_udim.h>
#include <vmlight/stage_counts.h>
#include <vmlight/stored_image.h>
#include <vmlight/uvraster.h>

#include <OpenImageIO/strutil.h>

#include <array>

namespace vmlight {
namespace {

using OIIO::Strutil::fmt::format;

/// What a lightmap reads; the albedo may be none.
struct Inputs
{
    PixelSourcePointer vismap, cfem, albedo;
};

class LightmapSource : public PixelSource
{
public:
    LightmapSource(const std::string& key, const LightmapRecipe& recipe, Inputs inputs)
        : PixelSource(key)
        , m_recipe(recipe)
        , m_inputs(std::move(inputs))
    {
    }

    bool describe(std::string& error)
    {
        std::array<int, 3> channels;
        if (!find_vismap_channels(m_inputs.vismap->spec(), m_index, error))
            error = format("\"{}\": {}", m_recipe.vismap, error);
        else if (m_inputs.albedo && !find_color_channels(m_inputs.albedo->spec(), channels, error))
            error = format("\"{}\": {}", m_recipe.albedo, error);
        Rotation rotation;
        if (!error.empty() || !lightmap_rotation(rotation, m_recipe.lightmap_params, error))
            return false;
        m_spec = describe_lightmap(m_inputs.vismap->spec(), m_inputs.cfem->spec(), m_recipe.lightmap_params);
        tag_udim(m_spec, m_recipe.udim);
        m_spec.tile_width = m_spec.tile_height = kTileSize;
        m_spec.tile_depth = 1;
        return true;
    }

    bool read(OIIO::ROI roi, float* dst, std::string& error) override
    {
        if (!m_prepare.run([&](std::string& reason) { return prepare(reason); }, error))
            return false;
        const size_t texels = size_t(roi.width()) * roi.height(), channels = m_inputs.vismap->spec().nchannels;
        std::vector<float> read(texels * channels), vismap(4 * texels), scratch;
        if (!m_inputs.vismap->read(roi, read.data(), error))
            return false;
        for (size_t i = 0; i < texels; ++i)
            for (size_t c = 0; c < 4; ++c)
                vismap[4 * i + c] = read[i * channels + size_t(m_index[c])];
        ShadeFaults faults;
        m_shader.shade(roi, VismapOrder::visibility_first, vismap.data(), dst, scratch, faults);
        if (faults.any())
            error = m_shader.fault_text(faults, m_recipe.vismap, m_recipe.albedo);
        ++stage_counts().tiles_shaded;
        return error.empty();
    }

    bool failed() const override { return m_prepare.failed() || m_inputs.vismap->failed(); }
    size_t bytes() const override { return m_bytes; }

private:
    bool prepare(std::string& error)
    {
        OIIO::ImageBuf cfem;
        if (!read_all(cfem, *m_inputs.cfem, error))
            return false;
        if (!m_shader.prepare(cfem, m_recipe.lightmap_params, error)) {
            error = format("\"{}\": {}", m_recipe.cfem.empty() ? m_recipe.environment : m_recipe.cfem, error);
            return false;
        }
        m_bytes = 3 * size_t(cfem.spec().image_bytes());
        return !m_inputs.albedo || prepare_albedo(error);
    }

    // On this thread alone: resizing would wait for OIIO's pool.
    bool prepare_albedo(std::string& error)
    {
        const ColorSettings color { m_recipe.colorconfig, m_recipe.albedo_colorspace, m_inputs.albedo->spec().format };
        std::string note;
        if (!read_all(m_albedo, *m_inputs.albedo, error)
            || !to_scene_linear(m_albedo, m_recipe.albedo, color, note, error, 1))
            return false;
        if (!m_shader.use_albedo(m_albedo, OIIO::get_roi(m_spec), 1, error)) {
            error = format("\"{}\": {}", m_recipe.albedo, error);
            return false;
        }
        m_bytes += size_t(m_albedo.spec().image_bytes()) + size_t(m_spec.image_bytes());
        return true;
    }

    const LightmapRecipe m_recipe;
    const Inputs m_inputs;
    std::array<int, 4> m_index {};
    Once m_prepare;
    OIIO::ImageBuf m_albedo;
    LightmapShader m_shader;
    std::atomic<size_t> m_bytes { 0 };
};

bool check_recipe(const LightmapRecipe& recipe, std::string& error)
{
    if (recipe.vismap.empty())
        error = "vismap: not given";
    else if (recipe.environment.empty() == recipe.cfem.empty())
        error = recipe.cfem.empty() ? "neither environment nor cfem is given"
                                    : "both environment and cfem are given; one of them is the light";
    return error.empty() && check_params(recipe.lightmap_params, error) && check_params(recipe.cfem_params, error);
}

// An environment that is filtered already is taken as it is, as makelightmap does.
PixelSourcePointer open_light(const LightmapRecipe& recipe, std::string& error, const RecipeChain& chain)
{
    const bool given = !recipe.cfem.empty();
    PixelSourcePointer light = open_source(given ? recipe.cfem : recipe.environment, error, chain);
    if (!light) {
        error = (given ? "cfem: " : "environment: ") + error;
        return nullptr;
    }
    const std::string stage = light->spec().get_string_attribute("vmlight:stage");
    if (stage == kVismapStage || stage == kLightmapStage) {
        error = format("{}: \"{}\": neither an environment nor a CFEM: its vmlight:stage is \"{}\"",
                       given ? "cfem" : "environment", given ? recipe.cfem : recipe.environment, stage);
        return nullptr;
    }
    if (given || stage == kCfemStage)
        return light;
    CfemRecipe filter;
    filter.environment = recipe.environment;
    filter.colorspace = recipe.colorspace;
    filter.colorconfig = recipe.colorconfig;
    filter.cfem_params = recipe.cfem_params;
    return open_source(filter, error, chain);
}

} // namespace

PixelSourcePointer open_source(const LightmapRecipe& given, std::string& error, const RecipeChain& chain)
{
    const LightmapRecipe recipe = resolve_udim(given);
    if (!check_recipe(recipe, error))
        return nullptr;
    Inputs inputs;
    inputs.vismap = open_source(recipe.vismap, error, chain);
    if (!inputs.vismap) {
        error = "vismap: " + error;
        return nullptr;
    }
    inputs.cfem = open_light(recipe, error, chain);
    if (!inputs.cfem)
        return nullptr;
    if (!recipe.albedo.empty()) {
        inputs.albedo = open_source(recipe.albedo, error, chain);
        if (!inputs.albedo) {
            error = "albedo: " + error;
            return nullptr;
        }
    }
    std::string config;
    if (!stamp_config(config, recipe.colorconfig, error)) {
        error = "colorconfig: " + error;
        return nullptr;
    }
    std::string key = recipe_key(recipe) + config + inputs.vismap->key() + inputs.cfem->key();
    if (inputs.albedo)
        key += inputs.albedo->key();
    if (PixelSourcePointer known = find_source(key))
        return known;
    auto source = std::make_shared<LightmapSource>(key, recipe, std::move(inputs));
    return source->describe(error) ? keep_source(source) : nullptr;
}

} // namespace vmlight
