// SPDX-License-Identifier: Apache-2.0
#include <vmlight/pixel_source.h>

#include <vmlight/channels.h>
#include <vmlight/color.h>
#include <vmlight/lightmap_shader.h>
#include <vmlight/once_cache.h>
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

    bool describe(const RecipeChain& chain, std::string& error)
    {
        std::array<int, 3> channels;
        if (!find_vismap_channels(m_inputs.vismap->spec(), m_index, error))
            error = placed(m_recipe, "vismap", chain, format("\"{}\": {}", m_recipe.vismap, error));
        else if (m_inputs.albedo && !find_color_channels(m_inputs.albedo->spec(), channels, error))
            error = placed(m_recipe, "albedo", chain, format("\"{}\": {}", m_recipe.albedo, error));
        Rotation rotation;
        if (!error.empty())
            return false;
        if (!lightmap_rotation(rotation, m_recipe.lightmap_params, error)) {
            error = chain.empty() ? error : format("\"{}\": {}", chain.back(), error);
            return false;
        }
        m_spec = describe_lightmap(m_inputs.vismap->spec(), m_inputs.cfem->spec(), m_recipe.lightmap_params);
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

PixelSourcePointer open_light(const LightmapRecipe& recipe, std::string& error, const RecipeChain& chain)
{
    if (!recipe.cfem.empty())
        return open_input(recipe, "cfem", recipe.cfem, Input::Cfem, error, chain);
    if (!open_input(recipe, "environment", recipe.environment, Input::Environment, error, chain))
        return nullptr;
    CfemRecipe filter;
    filter.environment = recipe.environment;
    filter.colorspace = recipe.colorspace;
    filter.colorconfig = recipe.colorconfig;
    filter.cfem_params = recipe.cfem_params;
    return open_source(filter, error);
}

} // namespace

PixelSourcePointer open_source(const LightmapRecipe& recipe, std::string& error, const RecipeChain& chain)
{
    error = recipe_fault(recipe, chain);
    if (!error.empty() || !check_params(recipe.lightmap_params, error) || !check_params(recipe.cfem_params, error))
        return nullptr;
    Inputs inputs;
    inputs.vismap = open_input(recipe, "vismap", recipe.vismap, Input::Vismap, error, chain);
    if (inputs.vismap)
        inputs.cfem = open_light(recipe, error, chain);
    if (inputs.cfem && !recipe.albedo.empty())
        inputs.albedo = open_input(recipe, "albedo", recipe.albedo, Input::Albedo, error, chain);
    if (!error.empty())
        return nullptr;
    std::string config;
    if (!stamp_config(config, recipe.colorconfig, error)) {
        error = placed(recipe, "colorconfig", chain, error);
        return nullptr;
    }
    std::string key = recipe_key(recipe) + config + inputs.vismap->key() + inputs.cfem->key();
    if (inputs.albedo)
        key += inputs.albedo->key();
    if (PixelSourcePointer known = find_source(key))
        return known;
    auto source = std::make_shared<LightmapSource>(key, recipe, std::move(inputs));
    return source->describe(chain, error) ? keep_source(source) : nullptr;
}

} // namespace vmlight
