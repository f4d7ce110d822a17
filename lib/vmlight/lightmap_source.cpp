// SPDX-License-Identifier: Apache-2.0
#include <vmlight/pixel_source.h>

#include <vmlight/albedo_source.h>
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
    PixelSourcePointer vismap, cfem;
    std::shared_ptr<AlbedoSource> albedo;
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
        if (!find_model_channels(m_inputs.vismap->spec(), m_recipe.lightmap_params, m_index, error))
            error = placed(m_recipe, "vismap", chain, format("\"{}\": {}", m_recipe.vismap, error));
        Rotation rotation;
        if (!error.empty())
            return false;
        if (!lightmap_rotation(rotation, m_recipe.lightmap_params, error)) {
            error = chain.empty() ? error : format("\"{}\": {}", chain.back(), error);
            return false;
        }
        m_spec = describe_lightmap(m_inputs.vismap->spec(), m_inputs.cfem->spec(), m_recipe.lightmap_params,
                                   m_inputs.cfem->subimages() > 1);
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

    bool failed() const override
    {
        return m_prepare.failed() || m_inputs.vismap->failed() || m_inputs.cfem->failed()
            || (m_inputs.albedo && m_inputs.albedo->failed());
    }
    size_t bytes() const override { return m_bytes; }

private:
    bool prepare(std::string& error)
    {
        // All levels of a stack, if they are of use.
        const bool lobe = lightmap_model(m_recipe.lightmap_params, m_inputs.cfem->subimages() > 1) == "lobe";
        std::vector<OIIO::ImageBuf> cfem(lobe ? size_t(m_inputs.cfem->subimages()) : 1);
        for (size_t level = 0; level < cfem.size(); ++level)
            if (!read_all(cfem[level], *m_inputs.cfem, error, int(level)))
                return false;
        if (!m_shader.prepare(cfem, m_recipe.lightmap_params, error)) {
            error = format("\"{}\": {}", m_recipe.cfem.empty() ? m_recipe.environment : m_recipe.cfem, error);
            return false;
        }
        m_bytes = 3 * cfem.size() * size_t(cfem[0].spec().image_bytes());
        const AlbedoReader* albedo = m_inputs.albedo ? m_inputs.albedo->reader(error) : nullptr;
        if (albedo)
            m_shader.use_albedo({ m_inputs.albedo, albedo });
        return error.empty();
    }

    const LightmapRecipe m_recipe;
    const Inputs m_inputs;
    std::array<int, 4> m_index {};
    Once m_prepare;
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
    filter.stack = lightmap_model(recipe.lightmap_params, true) == "lobe";
    return open_source(filter, error);
}

} // namespace

PixelSourcePointer open_source(const LightmapRecipe& given, std::string& error, const RecipeChain& chain)
{
    const LightmapRecipe recipe = resolve_udim(given);
    error = recipe_fault(recipe, chain);
    if (!error.empty() || !check_params(recipe.lightmap_params, error) || !check_params(recipe.cfem_params, error))
        return nullptr;
    Inputs inputs;
    inputs.vismap = open_input(recipe, "vismap", recipe.vismap, Input::Vismap, error, chain);
    if (inputs.vismap)
        inputs.cfem = open_light(recipe, error, chain);
    if (!error.empty())
        return nullptr;
    std::string key = recipe_key(recipe) + inputs.vismap->key() + inputs.cfem->key();
    if (!recipe.albedo.empty()) {
        const PixelSourcePointer image = open_input(recipe, "albedo", recipe.albedo, Input::Albedo, error, chain);
        std::string config; // which only this needs: the light's is the CFEM's matter
        if (image && !stamp_config(config, recipe.colorconfig, error))
            error = placed(recipe, "colorconfig", chain, error);
        else if (image) {
            inputs.albedo = AlbedoSource::open(recipe, image, config, OIIO::get_roi(inputs.vismap->spec()), error);
            if (!inputs.albedo)
                error = placed(recipe, "albedo", chain, error);
        }
        if (!inputs.albedo)
            return nullptr;
        key += inputs.albedo->key();
    }
    if (PixelSourcePointer known = find_source(key))
        return known;
    auto source = std::make_shared<LightmapSource>(key, recipe, std::move(inputs));
    return source->describe(chain, error) ? keep_source(source) : nullptr;
}

} // namespace vmlight
