// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/base/once_cache.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/base/text_format.h>
#include <vmlight/base/tile_size.h>
#include <vmlight/base/work_counts.h>
#include <vmlight/cfem/one_color.h>
#include <vmlight/cfem/radiance.h>
#include <vmlight/cfem/rows.h>
#include <vmlight/cfem/stack.h>
#include <vmlight/cfem/suns.h>
#include <vmlight/effects/facts.h>
#include <vmlight/image/color.h>
#include <vmlight/stage/environment_file.h>
#include <vmlight/stage/open_source.h>
#include <vmlight/stage/output_color.h>
#include <vmlight/stage/recipe/udim.h>
#include <vmlight/stage/source_cache.h>
#include <vmlight/stage/stored_image.h>
#include <vmlight/stage/streamed_environment.h>
#include <vmlight/stage/sun_source.h>

#include <algorithm>
#include <optional>

namespace vmlight {
namespace {

class CfemSource : public PixelSource, public SunSource
{
public:
    CfemSource(const std::string& key, const CfemRecipe& recipe, PixelSourcePointer environment)
        : PixelSource(key)
        , m_recipe(recipe)
        , m_environment(std::move(environment))
        , m_color { recipe.colorconfig, recipe.colorspace, m_environment->spec().format }
    {
    }

    bool describe(std::string& error)
    {
        OIIO::ImageSpec spec = m_environment->spec();
        if (!check_environment(spec, m_recipe, error)
            || !describe_scene_linear(spec, m_recipe.environment, m_color, error)
            || !m_output.open(m_recipe.output_colorspace, m_recipe.colorconfig, spec, error))
            return false;
        for (int level = 0; level < (m_recipe.stack ? kStackImages : 1); ++level) {
            OIIO::ImageSpec& own
                = m_specs.emplace_back(m_recipe.stack ? describe_cfem_level(spec, m_recipe.cfem_params, level)
                                                      : describe_cfem(spec, m_recipe.cfem_params));
            tag_udim(own, m_recipe.udim);
            record_environment(own, m_recipe.environment);
            m_output.tag(own);
            if (splits()) // which they are is known only once the pixels are read
                own.attribute(kSunsAttribute, kUnknownSuns);
            own.tile_width = own.tile_height = kTileSize;
            own.tile_depth = 1;
        }
        m_spec = m_specs[0];
        return true;
    }

    int subimages() const override { return int(m_specs.size()); }
    const OIIO::ImageSpec& spec_of(int subimage) const override { return m_specs[size_t(subimage)]; }
    bool read(OIIO::ROI roi, float* dst, std::string& error) override { return read_of(0, roi, dst, error); }
    bool read_of(int subimage, OIIO::ROI roi, float* dst, std::string& error) override
    {
        const bool radiance = subimage == kStackLevels;
        const ImageRange range = radiance ? ImageRange { kStackLevels, 1 } : ImageRange { 0, kStackLevels };
        auto& images = radiance ? m_radiance : m_cfem;
        if (!(radiance ? m_reduce : m_make)
                 .run([&](std::string& reason) { return filter(images, range, {}, true, reason); }, error))
            return false;
        // Not get_pixels(): it waits for OIIO's thread pool, and the caller may hold a lock.
        const auto* pixels = static_cast<const float*>(images[radiance ? 0 : size_t(subimage)].localpixels());
        const size_t row = 3 * size_t(roi.width());
        for (int y = roi.ybegin; y < roi.yend; ++y, dst += row)
            std::copy_n(pixels + 3 * (size_t(y) * m_spec.width + size_t(roi.xbegin)), row, dst);
        return true;
    }

    bool make(std::vector<OIIO::ImageBuf>& dst, ImageRange range, const MakeOptions& options,
              std::string& error) override
    {
        return filter(dst, range, options, false, error);
    }

    bool find_suns(std::string& text, std::string& error) override
    {
        text.clear();
        if (!splits())
            return true;
        // Whoever asks for the pixels has found them already.
        const auto find = [&](std::string& reason) {
            OIIO::ImageBuf held;
            std::optional<Environment> environment;
            std::string note;
            return open(environment, held, {}, true, note, reason) && split(*environment, {}, reason);
        };
        if (!m_find.run(find, error))
            return false;
        text = m_suns;
        return true;
    }

    bool failed() const override { return m_make.failed() || m_reduce.failed() || m_find.failed(); }
    size_t bytes() const override { return m_specs.size() * size_t(m_spec.image_bytes()); }

private:
    // The last image of a stack, the environment itself, needs no filter: reading only that one does only that work.
    bool filter(std::vector<OIIO::ImageBuf>& dst, ImageRange range, const MakeOptions& options, bool under_lock,
                std::string& error)
    {
        OIIO::ImageBuf held; // the pixels of `environment`, unless they are streamed
        std::optional<Environment> environment;
        std::string note;
        if (!open(environment, held, options, under_lock, note, error))
            return false;
        const OIIO::ImageSpec& spec = environment->spec();
        const int width = spec.width, height = spec.height;
        report_doubts(m_recipe.environment, spec, m_color.stored, options);
        const Stopwatch timer;
        const auto find = [&](std::string& reason) { return split(*environment, options, reason); };
        if ((splits() && !m_find.run(find, error)) || !filter(dst, range, m_split.rest(*environment), options, error)) {
            error = format("\"{}\": {}", m_recipe.environment, error);
            return false;
        }
        if (range.first < kStackLevels)
            ++work_counts().cfems_made;
        for (OIIO::ImageBuf& image : dst) {
            tag_udim(image.specmod(), m_recipe.udim);
            record_environment(image.specmod(), m_recipe.environment);
            m_output.apply(image, under_lock ? 1 : options.threads);
            if (!m_suns.empty()) {
                image.specmod().attribute(kSunsAttribute, m_suns);
                record_sanitized(image.specmod(), m_split.bad_values());
            }
        }
        if (splits())
            options.report(suns_line());
        options.report("colour: " + note + m_output.note());
        options.report(format("{}: {}x{} to {}{}x{} in {:.3f} s{}", range.first == kStackLevels ? "reduce" : "filter",
                              width, height, dst.size() > 1 ? format("{} of ", dst.size()) : "", m_spec.width,
                              m_spec.height, timer(),
                              find_one_color(dst) ? ": of one colour, which stays as it is" : ""));
        if (const int repaired = dst[0].spec().get_int_attribute("vmlight:sanitized"))
            options.report_warning(format("{} of the environment {} repaired",
                                          count_text(repaired, "bad value", "bad values"),
                                          plural(repaired, "was", "were")));
        return true;
    }

    bool filter(std::vector<OIIO::ImageBuf>& dst, ImageRange range, const Environment& environment,
                const MakeOptions& options, std::string& error)
    {
        const CfemParams& params = m_recipe.cfem_params;
        const Progress progress = options.step("filter", m_spec.width, m_spec.height);
        if (m_recipe.stack && range.first < kStackLevels) {
            const bool all = range.first + range.count > kStackLevels;
            const auto make = all ? make_cfem_stack : make_lobes;
            if (!make(dst, environment, params, error, options.threads, progress))
                return false;
            dst.resize(std::min(dst.size(), size_t(range.count)));
            return true;
        }
        dst.resize(1);
        if (m_recipe.stack)
            return make_radiance(dst[0], environment, params, error, progress);
        if (make_cfem(dst[0], environment, params, options.threads, progress))
            return true;
        error = oiio::error_line(dst[0]);
        return false;
    }

    bool splits() const { return m_recipe.suns != "off"; }

    bool split(const Environment& environment, const MakeOptions& options, std::string& error)
    {
        if (!m_split.find(environment, m_recipe.cfem_params.sanitize, error,
                          options.step("suns", environment.spec().width, environment.spec().height)))
            return false;
        std::vector<Sun> suns = m_split.suns();
        for (Sun& sun : suns) {
            std::array<float, 3> rgb;
            std::copy(sun.color.begin(), sun.color.end(), rgb.begin());
            m_output.apply(rgb.data(), 1);
            std::copy(rgb.begin(), rgb.end(), sun.color.begin());
        }
        m_suns = suns_text(suns);
        return true;
    }

    std::string suns_line() const
    {
        const std::vector<Sun>& suns = m_split.suns();
        if (suns.empty())
            return "suns: none, the light has no small strong source";
        const Sun& first = suns[0];
        const int wide_discs = int(std::count_if(suns.begin(), suns.end(), is_wide));
        return format("suns: {} with {:.0f} % of the light, {} at {:.3f} {:.3f} {:.3f}, {:.2f} degrees wide",
                      suns_count_text(int(suns.size()) - wide_discs, wide_discs), 100 * m_split.share(),
                      suns.size() > 1 ? "the strongest" : "it is", first.disc.direction.x, first.disc.direction.y,
                      first.disc.direction.z, first.disc.half_angle * 360 / latlong::pi);
    }

    bool open(std::optional<Environment>& dst, OIIO::ImageBuf& held, const MakeOptions& options, bool under_lock,
              std::string& note, std::string& error)
    {
        const std::string& name = m_recipe.environment;
        std::vector<std::string> warnings;
        bool opened = false;
        if (is_too_large_to_hold(m_environment->spec())) {
            opened = stream_environment(dst, m_environment, name, m_color, note, error, &warnings);
        } else if (dst.emplace(held); under_lock) { // OIIO's loops on this thread alone
            opened = read_all(held, *m_environment, error)
                && to_scene_linear(held, name, m_color, note, error, 1, &warnings);
        } else {
            std::vector<OIIO::ImageBuf> images;
            if (!make_input(images, *m_environment, {}, m_recipe, "environment", name, options, error))
                return false;
            held = std::move(images[0]);
            opened = to_scene_linear(held, name, m_color, note, error, options.threads, &warnings);
        }
        for (const std::string& warning : warnings)
            options.report_warning(warning);
        return opened;
    }

    const CfemRecipe m_recipe;
    const PixelSourcePointer m_environment;
    const ColorSettings m_color;
    OutputColor m_output;
    RunOnce m_make, m_reduce, m_find;
    SunSplit m_split;
    std::string m_suns; // suns_text() of them, in the space of the result
    std::vector<OIIO::ImageSpec> m_specs; // one, or one per image of the stack
    std::vector<OIIO::ImageBuf> m_cfem, m_radiance;
};

} // namespace

PixelSourcePointer open_source(const CfemRecipe& given, std::string& error, const RecipeChain& chain, Sharing sharing)
{
    const CfemRecipe recipe = resolve_udim(given);
    error = recipe_fault(recipe, chain);
    if (!error.empty() || !check_params(recipe.cfem_params, error))
        return nullptr;
    PixelSourcePointer environment
        = open_input(recipe, "environment", recipe.environment, InputKind::Panorama, error, chain, recipe.layer);
    if (!environment)
        return nullptr;
    std::string config;
    if (!stamp_config(config, recipe.colorconfig, error)) {
        error = with_location(recipe, "colorconfig", chain, error);
        return nullptr;
    }
    const char* forced = recipe.cfem_params.skip_one_color ? "" : "every filter\n"; // the same pixels, for more work
    const std::string key = recipe_key(recipe) + forced + config + environment->key();
    const bool shared = sharing == Sharing::process;
    if (PixelSourcePointer known = shared ? find_source(key) : nullptr)
        return known;
    auto source = std::make_shared<CfemSource>(key, recipe, std::move(environment));
    if (source->describe(error))
        return shared ? keep_source(source) : source;
    error = with_location(recipe, "environment", chain, error);
    return nullptr;
}

} // namespace vmlight
