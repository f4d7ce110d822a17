// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/pixel_source.h>

#include <vmlight/base/cache.h>
#include <vmlight/base/tile_size.h>
#include <vmlight/base/work_counts.h>
#include <vmlight/cfem/radiance.h>
#include <vmlight/cfem/stack.h>
#include <vmlight/image/channels.h>
#include <vmlight/image/color.h>
#include <vmlight/stage/recipe/udim.h>
#include <vmlight/stage/stored_environment.h>
#include <vmlight/stage/stored_image.h>

#include <OpenImageIO/strutil.h>
#include <OpenImageIO/sysutil.h>

#include <algorithm>
#include <array>
#include <optional>

namespace vmlight {
namespace {

using OIIO::Strutil::fmt::format;

class CfemSource : public PixelSource
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
        std::array<int, 3> channels;
        if (!find_color_channels(spec, channels, error)) {
            error = format("\"{}\": {}", m_recipe.environment, error);
            return false;
        }
        if (!describe_scene_linear(spec, m_recipe.environment, m_color, error))
            return false;
        for (int level = 0; level < (m_recipe.stack ? kStackImages : 1); ++level) {
            OIIO::ImageSpec& own
                = m_specs.emplace_back(m_recipe.stack ? describe_cfem_level(spec, m_recipe.cfem_params, level)
                                                      : describe_cfem(spec, m_recipe.cfem_params));
            tag_udim(own, m_recipe.udim);
            record_environment(own, m_recipe.environment);
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
        // The environment itself takes no filter: who reads it alone pays for it alone.
        const bool radiance = subimage == kStackLevels;
        Once& once = radiance ? m_reduce : m_make;
        if (!once.run([&](std::string& reason) { return radiance ? reduce(reason) : make(reason); }, error))
            return false;
        // By hand: get_pixels() waits for OIIO's pool, and the caller may hold a lock.
        const auto* pixels
            = static_cast<const float*>((radiance ? m_radiance : m_cfem[size_t(subimage)]).localpixels());
        const size_t row = 3 * size_t(roi.width());
        for (int y = roi.ybegin; y < roi.yend; ++y, dst += row)
            std::copy_n(pixels + 3 * (size_t(y) * m_spec.width + size_t(roi.xbegin)), row, dst);
        return true;
    }

    bool failed() const override { return m_make.failed() || m_reduce.failed(); }
    size_t bytes() const override { return m_specs.size() * size_t(m_spec.image_bytes()); }

private:
    // `held` is what `dst` reads, unless that is too large.
    bool open(std::optional<Environment>& dst, OIIO::ImageBuf& held, std::string& error)
    {
        std::string note;
        if (is_large(m_environment->spec()))
            return read_as_it_goes(dst, m_environment, m_recipe.environment, m_color, note, error);
        dst.emplace(held);
        return read_all(held, *m_environment, error)
            && to_scene_linear(held, m_recipe.environment, m_color, note, error, 1);
    }

    bool reduce(std::string& error)
    {
        OIIO::ImageBuf held;
        std::optional<Environment> environment;
        if (!open(environment, held, error))
            return false;
        if (make_radiance(m_radiance, *environment, m_recipe.cfem_params, error))
            return true;
        error = format("\"{}\": {}", m_recipe.environment, error);
        return false;
    }

    bool make(std::string& error)
    {
        OIIO::ImageBuf held;
        std::optional<Environment> environment;
        if (!open(environment, held, error))
            return false;
        m_cfem.resize(1);
        const bool made = m_recipe.stack ? make_lobes(m_cfem, *environment, m_recipe.cfem_params, error)
                                         : make_cfem(m_cfem[0], *environment, m_recipe.cfem_params);
        if (!made) {
            error = format("\"{}\": {}", m_recipe.environment, m_recipe.stack ? error : m_cfem[0].geterror());
            return false;
        }
        ++work_counts().cfems_made;
        return true;
    }

    const CfemRecipe m_recipe;
    const PixelSourcePointer m_environment;
    const ColorSettings m_color;
    Once m_make, m_reduce;
    std::vector<OIIO::ImageSpec> m_specs; // one, or one a level of the stack
    std::vector<OIIO::ImageBuf> m_cfem;
    OIIO::ImageBuf m_radiance;
};

} // namespace

bool stamp_config(std::string& stamp, const std::string& colorconfig, std::string& error)
{
    const std::string config = colorconfig.empty() ? std::string(OIIO::Sysutil::getenv("OCIO")) : colorconfig;
    stamp = config + "\n"; // none, or one that is built into OpenColorIO
    return config.empty() || OIIO::Strutil::starts_with(config, "ocio://") || stamp_file(stamp, config, error);
}

PixelSourcePointer open_source(const CfemRecipe& given, std::string& error, const RecipeChain& chain)
{
    const CfemRecipe recipe = resolve_udim(given);
    error = recipe_fault(recipe, chain);
    if (!error.empty() || !check_params(recipe.cfem_params, error))
        return nullptr;
    PixelSourcePointer environment
        = open_input(recipe, "environment", recipe.environment, Input::Panorama, error, chain);
    if (!environment)
        return nullptr;
    std::string config;
    if (!stamp_config(config, recipe.colorconfig, error)) {
        error = placed(recipe, "colorconfig", chain, error);
        return nullptr;
    }
    const std::string key = recipe_key(recipe) + config + environment->key();
    if (PixelSourcePointer known = find_source(key))
        return known;
    auto source = std::make_shared<CfemSource>(key, recipe, std::move(environment));
    if (source->describe(error))
        return keep_source(source);
    error = placed(recipe, "environment", chain, error);
    return nullptr;
}

} // namespace vmlight
