// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/format.h>
#include <vmlight/base/once_cache.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/base/tile_size.h>
#include <vmlight/base/work_counts.h>
#include <vmlight/cfem/stack.h>
#include <vmlight/image/channels.h>
#include <vmlight/image/color.h>
#include <vmlight/lightmap/model.h>
#include <vmlight/lightmap/shader.h>
#include <vmlight/lightmap/vismap_check.h>
#include <vmlight/stage/albedo_source.h>
#include <vmlight/stage/light_color.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/stage/open_source.h>
#include <vmlight/stage/output_color.h>
#include <vmlight/stage/recipe/udim.h>
#include <vmlight/stage/source_cache.h>
#include <vmlight/stage/stored_image.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <vector>

namespace vmlight {
namespace {

/// The images that a lightmap reads. The albedo may be nullptr.
struct Inputs
{
    PixelSourcePointer vismap, cfem;
    std::shared_ptr<AlbedoSource> albedo;
    LightColor light;
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
        // A stack, or its last image stored on its own.
        const bool has_all
            = m_inputs.cfem->subimages() > 1 || m_inputs.cfem->spec().get_float_attribute("vmlight:lobe") == 1;
        if (!choose_model(m_model, m_recipe.lightmap_params, vismap, has_all, error)
            || !find_vismap_channels(vismap, m_vismap_channels, error))
            error = with_location(m_recipe, "vismap", chain, format("\"{}\": {}", m_recipe.vismap, error));
        Rotation rotation;
        if (!error.empty())
            return false;
        if (!lightmap_rotation(rotation, m_recipe.lightmap_params, error)) {
            error = chain.empty() ? error : format("\"{}\": {}", chain.back(), error);
            return false;
        }
        for (const std::string& channel : m_model.channels)
            m_index.push_back(vismap.channelindex(channel));
        m_spec = describe_lightmap(vismap, m_inputs.light.spec, m_recipe.lightmap_params, m_model.name);
        if (!m_output.open(m_recipe.output_colorspace, m_recipe.colorconfig, m_spec, error)) {
            error = with_location(m_recipe, "output_colorspace", chain, error);
            return false;
        }
        m_output.tag(m_spec);
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
        VismapDoubts doubts;
        count_doubts(doubts, roi, read.data(), int(channels), m_vismap_channels);
        if (const std::string fault = impossible_fault(doubts, m_inputs.vismap->spec()); !fault.empty()) {
            error = format("\"{}\": {}", m_recipe.vismap, fault);
            return false;
        }
        for (size_t i = 0; i < texels; ++i)
            for (size_t c = 0; c < m_index.size(); ++c)
                vismap[m_index.size() * i + c] = read[i * channels + size_t(m_index[c])];
        ShadeFaults faults;
        m_shader.shade(roi, TexelLayout::visibility_first, vismap.data(), dst, scratch, faults);
        if (faults.any())
            error = m_shader.fault_text(faults, m_recipe.vismap, m_recipe.albedo);
        m_output.apply(dst, texels);
        ++work_counts().tiles_shaded;
        return error.empty();
    }

    bool make(std::vector<OIIO::ImageBuf>& dst, ImageRange, const MakeOptions& options, std::string& error) override
    {
        LightmapInputs inputs;
        if (!make_inputs(inputs, options, error))
            return false;
        const Stopwatch timer;
        dst.clear();
        OIIO::ImageBuf& lightmap = dst.emplace_back();
        if (!make_lightmap(lightmap, inputs.vismap, inputs.cfem, m_recipe.lightmap_params, inputs.albedo_or_none(),
                           options.threads, options.step("light", m_spec.width, m_spec.height))) {
            error = lightmap.geterror();
            return false;
        }
        m_output.apply(lightmap, options.threads);
        tag_udim(lightmap.specmod(), m_recipe.udim);
        options.report(format("light: 1 map of {}x{} in {:.3f} s", m_spec.width, m_spec.height, timer()));
        return true;
    }

    // All inputs, whole, for make_lightmap(). Keeps what `dst` already has if it is the same.
    bool make_inputs(LightmapInputs& dst, const MakeOptions& options, std::string& error)
    {
        std::vector<OIIO::ImageBuf> images;
        const std::string map = m_inputs.vismap->key(), texture = m_inputs.albedo ? m_inputs.albedo->key() : "";
        // Hold the images of one UDIM tile at a time.
        if (dst.map != map)
            dst.vismap.reset();
        if (dst.texture != texture)
            dst.albedo.reset();
        // The visibility map first: if it fails, no environment is filtered for nothing.
        if (!dst.vismap.initialized()) {
            dst.map.clear();
            if (!make_input(images, *m_inputs.vismap, {}, m_recipe, "vismap", m_recipe.vismap, options, error)
                || !check(images[0], options, error))
                return false;
            dst.vismap = std::move(images[0]);
            dst.map = map;
        }
        dst.finish = [output = m_output, threads = options.threads](OIIO::ImageBuf& lightmap) {
            output.apply(lightmap, threads);
        };
        if (!make_light(dst, options, error))
            return false;
        if (!m_inputs.albedo || dst.albedo.initialized())
            return true;
        dst.texture = texture;
        if (!make_input(images, *m_inputs.albedo, {}, m_recipe, "albedo", m_recipe.albedo, options, error))
            return false;
        dst.albedo = std::move(images[0]);
        return true;
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
        const ImageRange range = images_of_use();
        std::vector<OIIO::ImageBuf> cfem;
        for (int image = range.first; image < range.first + range.count; ++image)
            if (!read_all(cfem.emplace_back(), *m_inputs.cfem, error, image)) {
                error = m_recipe.cfem.empty() ? with_own_keys(error) : error;
                return false;
            }
        m_inputs.light.convert(cfem, 1);
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

    // An error of the implicit CFEM, whose keys have a prefix here.
    static std::string with_own_keys(const std::string& error)
    {
        const std::string hint = "; set ";
        const size_t at = error.rfind(hint); // the last: a file's name may hold the same words
        return at == std::string::npos ? error : std::string(error).insert(at + hint.size(), "cfem_");
    }

    // Here and not where a map is lit: once for all frames.
    bool check(const OIIO::ImageBuf& vismap, const MakeOptions& options, std::string& error) const
    {
        std::vector<std::string> warnings;
        if (!check_vismap(vismap, m_inputs.vismap->spec(), options.threads, warnings, error)) {
            error = with_location(m_recipe, "vismap", options.chain, format("\"{}\": {}", m_recipe.vismap, error));
            return false;
        }
        for (const std::string& line : warnings)
            options.report_warning(format("\"{}\": {}", m_recipe.vismap, line));
        return true;
    }

    // The images of a stack that the model reads.
    ImageRange images_of_use() const
    {
        const int images = m_inputs.cfem->subimages();
        return m_model.light == ModelLight::radiance ? ImageRange { images - 1, 1 }
            : m_model.light == ModelLight::lobes     ? ImageRange { 0, std::min(images, kStackLevels) }
                                                     : ImageRange {};
    }

    bool make_light(LightmapInputs& dst, const MakeOptions& options, std::string& error)
    {
        const ImageRange range = images_of_use();
        const std::string light = format("{} {} {}", range.first, range.count, m_inputs.cfem->key());
        if (dst.light == light)
            return true;
        dst.light.clear();
        dst.cfem.clear();
        const bool filtered = !m_recipe.cfem.empty();
        if (filtered) {
            if (!make_input(dst.cfem, *m_inputs.cfem, range, m_recipe, "cfem", m_recipe.cfem, options, error))
                return false;
            m_inputs.light.convert(dst.cfem, options.threads);
            for (const std::string& warning : m_inputs.light.warnings)
                options.report_warning(warning);
            if (m_inputs.light.conversion)
                options.report("colour: " + m_inputs.light.note);
        } else {
            MakeOptions fileless = options; // the implicit CFEM recipe has no file
            fileless.chain.clear();
            if (!m_inputs.cfem->make(dst.cfem, range, fileless, error)) {
                error = with_location(m_recipe, "environment", options.chain, with_own_keys(error));
                return false;
            }
        }
        if (m_recipe.lightmap_params.model == "auto")
            options.report(filtered && m_model.light == ModelLight::cfem
                               ? "model: paper, because the CFEM is not a stack (makecfem --stack makes one)"
                               : format("model: {}, the best that this visibility map supports", m_model.name));
        dst.light = light;
        return true;
    }

    const LightmapRecipe m_recipe;
    const Inputs m_inputs;
    ShadingModel m_model;
    std::vector<int> m_index;
    std::array<int, 4> m_vismap_channels {};
    OutputColor m_output;
    RunOnce m_prepare;
    LightmapShader m_shader;
    std::atomic<size_t> m_bytes { 0 };
};

PixelSourcePointer open_light(const LightmapRecipe& recipe, const OIIO::ImageSpec& vismap, std::string& error,
                              const RecipeChain& chain)
{
    if (!recipe.cfem.empty())
        return open_input(recipe, "cfem", recipe.cfem, InputKind::Cfem, error, chain);
    if (!open_input(recipe, "environment", recipe.environment, InputKind::Environment, error, chain, recipe.layer))
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
    return open_source(filter, error);
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

std::shared_ptr<LightmapSource> open_lightmap(const LightmapRecipe& given, std::string& error, const RecipeChain& chain,
                                              Sharing sharing)
{
    const LightmapRecipe recipe = resolve_udim(given);
    error = recipe_fault(recipe, chain);
    if (!error.empty() || !check_params(recipe.lightmap_params, error) || !check_params(recipe.cfem_params, error))
        return nullptr;
    Inputs inputs;
    inputs.vismap = open_input(recipe, "vismap", recipe.vismap, InputKind::Vismap, error, chain);
    if (inputs.vismap)
        inputs.cfem = open_light(recipe, inputs.vismap->spec(), error, chain);
    if (!error.empty())
        return nullptr;
    std::string config;
    if ((may_convert_light(recipe, inputs.cfem->spec()) || !recipe.output_colorspace.empty())
        && !stamp_config(config, recipe.colorconfig, error)) {
        error = with_location(recipe, "colorconfig", chain, error);
        return nullptr;
    }
    if (!describe_light(inputs.light, recipe, inputs.cfem->spec(), error)) {
        error = with_location(recipe, "cfem", chain, error);
        return nullptr;
    }
    std::string key = recipe_key(recipe) + config + inputs.vismap->key() + inputs.cfem->key();
    if (!recipe.albedo.empty()) {
        inputs.albedo = open_albedo(recipe, OIIO::get_roi(inputs.vismap->spec()),
                                    inputs.light.spec.get_string_attribute("colorInteropID"), error, chain);
        if (!inputs.albedo)
            return nullptr;
        key += inputs.albedo->key();
    }
    const bool shared = sharing == Sharing::process;
    if (PixelSourcePointer known = shared ? find_source(key) : nullptr)
        return std::dynamic_pointer_cast<LightmapSource>(known);
    auto source = std::make_shared<LightmapSource>(key, recipe, std::move(inputs));
    if (!source->describe(chain, error))
        return nullptr;
    return shared ? std::dynamic_pointer_cast<LightmapSource>(keep_source(source)) : source;
}

} // namespace

PixelSourcePointer open_source(const LightmapRecipe& recipe, std::string& error, const RecipeChain& chain,
                               Sharing sharing)
{
    return open_lightmap(recipe, error, chain, sharing);
}

bool read_lightmap_inputs(LightmapInputs& dst, const LightmapRecipe& recipe, const MakeOptions& options,
                          std::string& error)
{
    const auto source = open_lightmap(recipe, error, options.chain, Sharing::none);
    return source && source->make_inputs(dst, options, error);
}

} // namespace vmlight
