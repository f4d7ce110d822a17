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
#include <vmlight/stage/bake_switches.h>
#include <vmlight/stage/bounce_shading.h>
#include <vmlight/stage/light_effects.h>
#include <vmlight/stage/lightmap_images.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/stage/open_source.h>
#include <vmlight/stage/output_color.h>
#include <vmlight/stage/recipe/udim.h>
#include <vmlight/stage/source_cache.h>
#include <vmlight/stage/stored_image.h>
#include <vmlight/stage/sun_choice.h>
#include <vmlight/stage/sun_shading.h>
#include <vmlight/stage/whole_light.h>

#include <OpenImageIO/filesystem.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <vector>

namespace vmlight {
namespace {

void tag_effects(OIIO::ImageSpec& spec, const std::string& off)
{
    if (!off.empty())
        spec.attribute(metadata_name("effects"), off);
}

class LightmapSource : public PixelSource
{
public:
    LightmapSource(const std::string& key, const LightmapRecipe& given, LightmapImages images)
        : PixelSource(key)
        , m_given(given)
        , m_recipe(with_switches(given))
        , m_images(std::move(images))
    {
    }

    bool describe(const RecipeChain& chain, std::string& error)
    {
        const OIIO::ImageSpec& vismap = m_images.vismap->spec();
        // A stack, or its last image stored on its own.
        const bool has_all
            = m_images.cfem->subimages() > 1 || m_images.cfem->spec().get_float_attribute("vmlight:lobe") == 1;
        if (!choose_model(m_model, m_recipe.lightmap_params, vismap, has_all, error)
            || !find_vismap_channels(vismap, m_vismap_channels, error))
            error = with_location(m_recipe, "vismap", chain, format("\"{}\": {}", m_recipe.vismap, error));
        else if (const std::string fault = kernel_fault(m_model, vismap, m_images.cfem->spec()); !fault.empty())
            error = with_location(m_recipe, "cfem", chain, format("\"{}\": {}", m_recipe.cfem, fault));
        Rotation rotation;
        if (!error.empty())
            return false;
        if (!lightmap_rotation(rotation, m_recipe.lightmap_params, error)) {
            error = chain.empty() ? error : format("\"{}\": {}", chain.back(), error);
            return false;
        }
        for (const std::string& channel : m_model.channels)
            m_index.push_back(vismap.channelindex(channel));
        m_spec = describe_lightmap(vismap, m_images.light.spec, m_recipe.lightmap_params, m_model.name);
        if (!m_output.open(m_recipe.output_colorspace, m_recipe.colorconfig, m_spec, error)) {
            error = with_location(m_recipe, "output_colorspace", chain, error);
            return false;
        }
        if (m_images.suns) // which the light has, as far as a header can know
            m_spec.attribute("vmlight:model", with_suns(m_model.name));
        if (m_images.bounce)
            m_images.bounce->tag(m_spec);
        tag_no_suns(m_spec, no_suns_text());
        m_output.tag(m_spec);
        tag_effects(m_spec, switched_off(m_given.effects, LightmapRecipe::kStage));
        tag_udim(m_spec, m_recipe.udim);
        m_spec.tile_width = m_spec.tile_height = kTileSize;
        m_spec.tile_depth = 1;
        return true;
    }

    bool read(OIIO::ROI roi, float* dst, std::string& error) override
    {
        if (!m_prepare.run([&](std::string& reason) { return prepare(reason); }, error))
            return false;
        const size_t texels = size_t(roi.width()) * roi.height(), channels = m_images.vismap->spec().nchannels;
        std::vector<float> read(texels * channels), vismap(m_index.size() * texels), scratch;
        if (!m_images.vismap->read(roi, read.data(), error))
            return false;
        VismapDoubts doubts;
        count_doubts(doubts, roi, read.data(), int(channels), m_vismap_channels);
        if (const std::string fault = impossible_fault(doubts, m_images.vismap->spec()); !fault.empty()) {
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
        if (!make_inputs(inputs, options, error)
            || ((options.explain || m_given.effects != "auto")
                && !explain_light(inputs, { m_given, m_given.lightmap_params, m_recipe.lightmap_params }, options,
                                  error)))
            return false;
        const Stopwatch timer;
        dst.clear();
        OIIO::ImageBuf& lightmap = dst.emplace_back();
        if (!make_lightmap(lightmap, inputs, m_recipe.lightmap_params, options, error))
            return false;
        tag_udim(lightmap.specmod(), m_recipe.udim);
        options.report(format("light: 1 map of {}x{} in {:.3f} s", m_spec.width, m_spec.height, timer()));
        return true;
    }

    // All inputs, whole, for make_lightmap(). Keeps what `dst` already has if it is the same.
    bool make_inputs(LightmapInputs& dst, const MakeOptions& options, std::string& error)
    {
        std::vector<OIIO::ImageBuf> images;
        const std::string map = m_images.vismap->key(), texture = m_images.albedo ? m_images.albedo->key() : "";
        // Hold the images of one UDIM tile at a time.
        if (dst.map != map)
            dst.vismap.reset();
        if (dst.texture != texture)
            dst.albedo.reset();
        // The visibility map first: if it fails, no environment is filtered for nothing.
        if (!dst.vismap.initialized()) {
            dst.map.clear();
            if (!make_input(images, *m_images.vismap, {}, m_recipe, "vismap", m_recipe.vismap, options, error)
                || !check(images[0], options, error))
                return false;
            dst.vismap = std::move(images[0]);
            dst.map = map;
        }
        dst.color = [recipe = m_recipe, images = m_images, output = m_output] {
            return conversions_of(recipe, images, output);
        };
        dst.finish = [output = m_output, no_suns = no_suns_text(),
                      effects = switched_off(m_given.effects, LightmapRecipe::kStage),
                      threads = options.threads](OIIO::ImageBuf& lightmap) {
            tag_no_suns(lightmap.specmod(), no_suns);
            output.apply(lightmap, threads);
            tag_effects(lightmap.specmod(), effects);
        };
        // Frames share the points of the mesh that rays start from.
        if (!m_images.suns) {
            dst.suns = nullptr;
        } else if (!dst.suns) {
            dst.suns = std::make_shared<LightmapSuns>(LightmapSuns { {}, m_images.suns });
            dst.light.clear();
        } else if (dst.suns->shading->key() != m_images.suns->key() || dst.suns->shading->failed()) {
            dst.suns->shading = m_images.suns;
        }
        // What is traced is kept, unless that failed: the work may have been stopped.
        if (!m_images.bounce || !dst.bounce || dst.bounce->key() != m_images.bounce->key() || dst.bounce->failed())
            dst.bounce = m_images.bounce;
        if (!make_light(dst, options, error))
            return false;
        if (!m_images.albedo || dst.albedo.initialized())
            return true;
        dst.texture = texture;
        if (!make_input(images, *m_images.albedo, {}, m_recipe, "albedo", m_recipe.albedo, options, error))
            return false;
        dst.albedo = std::move(images[0]);
        return true;
    }

    bool failed() const override
    {
        return m_prepare.failed() || m_images.vismap->failed() || m_images.cfem->failed()
            || (m_images.albedo && m_images.albedo->failed()) || (m_images.suns && m_images.suns->failed())
            || (m_images.bounce && m_images.bounce->failed());
    }
    size_t bytes() const override { return m_bytes; }

private:
    bool prepare(std::string& error)
    {
        const ImageRange range = images_of_use();
        std::vector<OIIO::ImageBuf> cfem;
        for (int image = range.first; image < range.first + range.count; ++image)
            if (!read_all(cfem.emplace_back(), *m_images.cfem, error, image)) {
                error = m_recipe.cfem.empty() ? with_filter_prefix(error) : error;
                return false;
            }
        m_images.light.convert(cfem, 1);
        const auto read_map
            = [&](OIIO::ImageBuf& map, std::string& reason) { return read_all(map, *m_images.vismap, reason); };
        if (m_given.effects != "auto"
            && !check_switches(m_given, cfem, !conversions_of(m_recipe, m_images, m_output).empty(), read_map, error))
            return false;
        WholeLight whole(m_recipe, m_images);
        if (!whole.add_suns(m_shader, error))
            return false;
        if (!m_shader.prepare(cfem, m_recipe.lightmap_params, m_model, error)) {
            error = format("\"{}\": {}", m_recipe.cfem.empty() ? m_recipe.environment : m_recipe.cfem, error);
            return false;
        }
        const AlbedoReader* albedo = m_images.albedo ? m_images.albedo->reader(error) : nullptr;
        if (albedo)
            m_shader.use_albedo({ m_images.albedo, albedo }, m_recipe.lightmap_params.skip_one_albedo);
        if (!error.empty() || !whole.add_bounce(m_shader, cfem, albedo, error))
            return false;
        m_bytes = 3 * cfem.size() * size_t(cfem[0].spec().image_bytes()) + whole.bytes();
        return true;
    }

    // Here and not where a map is lit: once for all frames.
    bool check(const OIIO::ImageBuf& vismap, const MakeOptions& options, std::string& error) const
    {
        std::vector<std::string> warnings;
        if (!check_vismap(vismap, m_images.vismap->spec(), options.threads, warnings, error)) {
            error = with_location(m_recipe, "vismap", options.chain, format("\"{}\": {}", m_recipe.vismap, error));
            return false;
        }
        for (const std::string& line : warnings)
            options.report_warning(format("\"{}\": {}", m_recipe.vismap, line));
        return true;
    }

    // Why suns that were asked for stay in the environment, without folders; or "". A reader cannot warn.
    std::string no_suns_text() const
    {
        return m_images.no_suns.empty()
            ? ""
            : why_no_suns(m_recipe, m_images.vismap->spec(), OIIO::Filesystem::filename(m_recipe.vismap));
    }
    static void tag_no_suns(OIIO::ImageSpec& lightmap, const std::string& text)
    {
        if (!text.empty())
            lightmap.attribute("vmlight:no_suns", text);
    }

    // The images of a stack that the model reads.
    ImageRange images_of_use() const
    {
        const int images = m_images.cfem->subimages();
        return m_model.light == ModelLight::radiance ? ImageRange { images - 1, 1 }
            : m_model.light == ModelLight::lobes     ? ImageRange { 0, std::min(images, kStackLevels) }
                                                     : ImageRange {};
    }

    bool make_light(LightmapInputs& dst, const MakeOptions& options, std::string& error)
    {
        const ImageRange range = images_of_use();
        const std::string light = format("{} {} {}", range.first, range.count, m_images.cfem->key());
        if (dst.light == light)
            return true;
        dst.light.clear();
        dst.cfem.clear();
        const bool filtered = !m_recipe.cfem.empty();
        if (filtered) {
            if (!make_input(dst.cfem, *m_images.cfem, range, m_recipe, "cfem", m_recipe.cfem, options, error))
                return false;
            m_images.light.convert(dst.cfem, options.threads);
            for (const std::string& warning : m_images.light.warnings)
                options.report_warning(warning);
            if (m_images.light.conversion)
                options.report("colour: " + m_images.light.note);
        } else {
            MakeOptions fileless = options; // the implicit CFEM recipe has no file
            fileless.chain.clear();
            if (!m_images.cfem->make(dst.cfem, range, fileless, error)) {
                error = with_location(m_recipe, "environment", options.chain, with_filter_prefix(error));
                return false;
            }
        }
        if (dst.suns && !find_suns(dst.suns->list, m_recipe, m_images, error))
            return false;
        if (!m_images.no_suns.empty())
            options.report_warning("suns stay in the environment, with soft shadows: " + m_images.no_suns);
        if (!m_images.no_bounce.empty())
            options.report_warning("no bounced light: " + m_images.no_bounce);
        const bool has_suns = dst.suns && !dst.suns->list.empty();
        const std::string model = has_suns ? with_suns(m_model.name) : m_model.name;
        if (m_recipe.lightmap_params.model == "auto")
            options.report(
                filtered && m_model.light == ModelLight::cfem
                    ? format("model: {}, because the CFEM is not a stack (makecfem --stack makes one)", model)
                    : format("model: {}, the best that this visibility map supports", model));
        dst.light = light;
        return true;
    }

    const LightmapRecipe m_given, m_recipe; // as written; and with its switches applied
    const LightmapImages m_images;
    ShadingModel m_model;
    std::vector<int> m_index;
    std::array<int, 4> m_vismap_channels {};
    OutputColor m_output;
    RunOnce m_prepare;
    LightmapShader m_shader;
    std::atomic<size_t> m_bytes { 0 };
};

std::shared_ptr<LightmapSource> open_lightmap(const LightmapRecipe& given, std::string& error, const RecipeChain& chain,
                                              Sharing sharing)
{
    const LightmapRecipe asked = resolve_udim(given), recipe = with_switches(asked);
    error = recipe_fault(asked, chain);
    if (!error.empty() || !check_params(recipe.lightmap_params, error) || !check_params(recipe.cfem_params, error)
        || !check_params(recipe.bounce_params, error))
        return nullptr;
    LightmapImages images;
    if (!open_images(images, recipe, error, chain))
        return nullptr;
    const std::string key = recipe_key(recipe) + images.key;
    const bool shared = sharing == Sharing::process;
    if (PixelSourcePointer known = shared ? find_source(key) : nullptr)
        return std::dynamic_pointer_cast<LightmapSource>(known);
    auto source = std::make_shared<LightmapSource>(key, asked, std::move(images));
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
