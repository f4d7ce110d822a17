// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/format.h>
#include <vmlight/base/once_cache.h>
#include <vmlight/base/work_counts.h>
#include <vmlight/lightmap/shader.h>
#include <vmlight/lightmap/vismap_check.h>
#include <vmlight/stage/bake_switches.h>
#include <vmlight/stage/bounce_shading.h>
#include <vmlight/stage/light_effects.h>
#include <vmlight/stage/lightmap_making.h>
#include <vmlight/stage/open_source.h>
#include <vmlight/stage/recipe/udim.h>
#include <vmlight/stage/source_cache.h>
#include <vmlight/stage/stored_image.h>
#include <vmlight/stage/sun_shading.h>
#include <vmlight/stage/whole_light.h>

#include <atomic>
#include <vector>

namespace vmlight {
namespace {

class LightmapSource : public PixelSource
{
public:
    LightmapSource(const std::string& key, const LightmapRecipe& given, LightmapImages images)
        : PixelSource(key)
        , m_plan(given, std::move(images))
    {
    }

    const LightmapPlan& plan() const { return m_plan; }

    bool describe(const RecipeChain& chain, std::string& error)
    {
        const bool good = m_plan.settle(chain, error);
        m_spec = m_plan.spec();
        return good;
    }

    bool read(OIIO::ROI roi, float* dst, std::string& error) override
    {
        if (!m_prepare.run([&](std::string& reason) { return prepare(reason); }, error))
            return false;
        const LightmapRecipe& recipe = m_plan.recipe();
        const LightmapImages& images = m_plan.images();
        const std::vector<int>& channels_of_model = m_plan.channels();
        const size_t texels = size_t(roi.width()) * roi.height(), channels = images.vismap->spec().nchannels;
        std::vector<float> read(texels * channels), vismap(channels_of_model.size() * texels), scratch;
        if (!images.vismap->read(roi, read.data(), error))
            return false;
        VismapDoubts doubts;
        count_doubts(doubts, roi, read.data(), int(channels), m_plan.vismap_channels());
        if (const std::string fault = impossible_fault(doubts, images.vismap->spec()); !fault.empty()) {
            error = format("\"{}\": {}", recipe.vismap, fault);
            return false;
        }
        for (size_t i = 0; i < texels; ++i)
            for (size_t c = 0; c < channels_of_model.size(); ++c)
                vismap[channels_of_model.size() * i + c] = read[i * channels + size_t(channels_of_model[c])];
        ShadeFaults faults;
        m_shader.shade(roi, TexelLayout::visibility_first, vismap.data(), dst, scratch, faults);
        if (faults.any())
            error = m_shader.fault_text(faults, recipe.vismap, recipe.albedo);
        m_plan.output().apply(dst, texels);
        ++work_counts().tiles_shaded;
        return error.empty();
    }

    bool make(std::vector<OIIO::ImageBuf>& dst, ImageRange, const MakeOptions& options, std::string& error) override
    {
        dst.clear();
        return make_lightmap_image(dst.emplace_back(), m_plan, options, error);
    }

    bool failed() const override
    {
        const LightmapImages& images = m_plan.images();
        return m_prepare.failed() || images.vismap->failed() || images.cfem->failed()
            || (images.albedo && images.albedo->failed()) || (images.suns && images.suns->failed())
            || (images.bounce && images.bounce->failed());
    }
    size_t bytes() const override { return m_bytes; }

private:
    bool prepare(std::string& error)
    {
        const LightmapRecipe& recipe = m_plan.recipe();
        const LightmapImages& images = m_plan.images();
        const ImageRange range = m_plan.images_of_use();
        std::vector<OIIO::ImageBuf> cfem;
        for (int image = range.first; image < range.first + range.count; ++image)
            if (!read_all(cfem.emplace_back(), *images.cfem, error, image)) {
                error = recipe.cfem.empty() ? with_filter_prefix(error) : error;
                return false;
            }
        images.light.convert(cfem, 1);
        const auto read_map
            = [&](OIIO::ImageBuf& map, std::string& reason) { return read_all(map, *images.vismap, reason); };
        if (m_plan.given().effects != "auto"
            && !check_switches(m_plan.given(), cfem, !conversions_of(recipe, images, m_plan.output()).empty(), read_map,
                               error))
            return false;
        WholeLight whole(recipe, images);
        if (!whole.add_suns(m_shader, error))
            return false;
        if (!m_shader.prepare(cfem, recipe.lightmap_params, m_plan.model(), error)) {
            error = format("\"{}\": {}", recipe.cfem.empty() ? recipe.environment : recipe.cfem, error);
            return false;
        }
        const AlbedoReader* albedo = images.albedo ? images.albedo->reader(error) : nullptr;
        if (albedo)
            m_shader.use_albedo({ images.albedo, albedo }, recipe.lightmap_params.skip_one_albedo);
        if (!error.empty() || !whole.add_bounce(m_shader, cfem, albedo, error))
            return false;
        m_bytes = 3 * cfem.size() * size_t(cfem[0].spec().image_bytes()) + whole.bytes();
        return true;
    }

    LightmapPlan m_plan;
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
    return source && make_lightmap_inputs(dst, source->plan(), options, error);
}

} // namespace vmlight
