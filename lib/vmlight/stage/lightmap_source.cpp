// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/pixel_source.h>

#include <vmlight/base/cache.h>
#include <vmlight/base/tile_size.h>
#include <vmlight/base/work_counts.h>
#include <vmlight/image/channels.h>
#include <vmlight/image/color.h>
#include <vmlight/lightmap/model.h>
#include <vmlight/lightmap/shader.h>
#include <vmlight/stage/albedo_source.h>
#include <vmlight/stage/recipe/udim.h>
#include <vmlight/stage/stored_image.h>

#include <OpenImageIO/strutil.h>

#include <vector>

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
        const OIIO::ImageSpec& vismap = m_inputs.vismap->spec();
        if (!find_model(m_model, m_recipe.lightmap_params, vismap, m_inputs.cfem->subimages() > 1, error))
            error = placed(m_recipe, "vismap", chain, format("\"{}\": {}", m_recipe.vismap, error));
        Rotation rotation;
        if (!error.empty())
            return false;
        if (!lightmap_rotation(rotation, m_recipe.lightmap_params, error)) {
            error = chain.empty() ? error : format("\"{}\": {}", chain.back(), error);
            return false;
        }
        for (const std::string& channel : m_model.channels)
            m_index.push_back(vismap.channelindex(channel));
        m_spec = describe_lightmap(vismap, m_inputs.cfem->spec(), m_recipe.lightmap_params, m_model.name);
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
        std::vector<float> read(texels * channels), vismap(m_index.size() * texels), scratch;
        if (!m_inputs.vismap->read(roi, read.data(), error))
            return false;
        for (size_t i = 0; i < texels; ++i)
            for (size_t c = 0; c < m_index.size(); ++c)
                vismap[m_index.size() * i + c] = read[i * channels + size_t(m_index[c])];
        ShadeFaults faults;
        m_shader.shade(roi, VismapOrder::visibility_first, vismap.data(), dst, scratch, faults);
        if (faults.any())
            error = m_shader.fault_text(faults, m_recipe.vismap, m_recipe.albedo);
        ++work_counts().tiles_shaded;
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
        // Of a stack the images that are of use.
        const int images = m_inputs.cfem->subimages();
        const int first = m_model.light == ModelLight::radiance ? images - 1 : 0;
        const int count = m_model.light == ModelLight::lobes ? images : 1;
        std::vector<OIIO::ImageBuf> cfem;
        for (int image = first; image < first + count; ++image)
            if (!read_all(cfem.emplace_back(), *m_inputs.cfem, error, image))
                return false;
        if (!m_shader.prepare(cfem, m_recipe.lightmap_params, m_model, error)) {
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
    ShadingModel m_model;
    std::vector<int> m_index;
    Once m_prepare;
    LightmapShader m_shader;
    std::atomic<size_t> m_bytes { 0 };
};

PixelSourcePointer open_light(const LightmapRecipe& recipe, const OIIO::ImageSpec& vismap, std::string& error,
                              const RecipeChain& chain)
{
    if (!recipe.cfem.empty())
        return open_input(recipe, "cfem", recipe.cfem, Input::Cfem, error, chain);
    if (!open_input(recipe, "environment", recipe.environment, Input::Environment, error, chain))
        return nullptr;
    // What is wrong with the visibility map is told where it is described.
    ShadingModel model;
    std::string ignored;
    find_model(model, recipe.lightmap_params, vismap, true, ignored);
    CfemRecipe filter;
    filter.environment = recipe.environment;
    filter.colorspace = recipe.colorspace;
    filter.colorconfig = recipe.colorconfig;
    filter.cfem_params = recipe.cfem_params;
    filter.stack = model.light != ModelLight::cfem;
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
        inputs.cfem = open_light(recipe, inputs.vismap->spec(), error, chain);
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
