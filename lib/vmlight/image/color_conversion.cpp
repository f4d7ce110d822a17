// SPDX-License-Identifier: Apache-2.0
#include <vmlight/image/color_conversion.h>

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/base/work_counts.h>
#include <vmlight/image/color_space.h>

#include <OpenImageIO/filesystem.h>

#include <utility>

namespace vmlight {

using OIIO::ColorConfig;

namespace {

// Empty if nothing changes.
bool config_conversion(ColorConversion& dst, ColorConfig& config, const std::string& config_name,
                       const std::string& from, const std::string& to, std::string& error)
{
    dst = {};
    if (from == to)
        return true;
    // A processor outlives its config.
    OIIO::ColorProcessorHandle processor = config.createColorProcessor(from, to);
    if (!processor) {
        error
            = format("OCIO config \"{}\" cannot convert {} to {}: {}", config_name, from, to, oiio::error_line(config));
        return false;
    }
    if (!processor->isNoOp())
        dst = [processor](float* rgb, int count) {
            const OIIO::stride_t channel = sizeof(float), pixel = 3 * channel;
            work_counts().pixels_converted += count;
            processor->apply(rgb, count, 1, 3, channel, pixel, pixel * count);
        };
    return true;
}

// A known space that the config has: the way into it from one that it has not.
const LinearSpace* listed_space(const ColorConfig& config, const std::string& preferred)
{
    if (const LinearSpace* same = linear_space_named(interop_id_of(config, preferred)))
        return same;
    for (const LinearSpace& space : linear_spaces())
        if (!first_space_named(config, space.names).empty())
            return &space;
    return nullptr;
}

} // namespace

const std::vector<const char*> kSrgbNames { kSrgb,     "sRGB - Texture",           "srgb_texture",
                                            "srgb_tx", "Utility - sRGB - Texture", "sRGB" };

std::string id_of(const ColorConfig& config, const SourceSpace& source)
{
    return source.unlisted ? source.unlisted->interop_id : interop_id_of(config, source.name);
}

SourceSpace linear_source(const ColorConfig& config, const LinearSpace& space)
{
    const std::string name = first_space_named(config, space.names);
    return name.empty() ? SourceSpace { space.interop_id, &space } : SourceSpace { name };
}

SourceSpace source_named(const ColorConfig& config, const std::string& name)
{
    if (const std::string space = space_named(config, name); !space.empty())
        return { space, nullptr, is_data_space(config, space) };
    if (const LinearSpace* space = linear_space_named(name))
        return linear_source(config, *space);
    if (is_any_of(name, { "data" }))
        return { "data", nullptr, true };
    return is_any_of(name, { kSrgbNames.begin(), kSrgbNames.end() })
        ? SourceSpace { first_space_named(config, kSrgbNames) }
        : SourceSpace {};
}

ColorConversion matrix_conversion(const LinearSpace& from, const LinearSpace& to)
{
    return [m = matrix_between(from, to)](float* rgb, int count) {
        work_counts().pixels_converted += count;
        for (float* end = rgb + 3 * size_t(count); rgb != end; rgb += 3) {
            const double r = rgb[0], g = rgb[1], b = rgb[2];
            for (size_t c = 0; c < 3; ++c)
                rgb[c] = float(m[3 * c] * r + m[3 * c + 1] * g + m[3 * c + 2] * b);
        }
    };
}

ColorConversion one_after_the_other(ColorConversion first, ColorConversion second)
{
    if (!first || !second)
        return first ? first : second;
    return [first = std::move(first), second = std::move(second)](float* rgb, int count) {
        first(rgb, count);
        second(rgb, count);
    };
}

std::unique_ptr<ColorConfig> open_color_config(const std::string& name, std::string& error)
{
    // A pipe would block OCIO. Names such as ocio://default are not files.
    if (OIIO::Filesystem::exists(name) && !OIIO::Filesystem::is_regular(name)) {
        error = format("OCIO config \"{}\": not a file", name);
        return nullptr;
    }
    auto config = std::make_unique<ColorConfig>(name);
    if (config->has_error())
        error = format("OCIO config \"{}\": {}", name, oiio::error_line(*config));
    else if (!is_any_of("scene_linear", config->getRoles()))
        error = format("OCIO config \"{}\" has no role scene_linear", name);
    else
        return config;
    return nullptr;
}

bool conversion_between(ColorConversion& dst, ColorConfig& config, const std::string& config_name,
                        const SourceSpace& from, const SourceSpace& to, std::string& error)
{
    const LinearSpace* there = listed_space(config, from.unlisted ? to.name : from.name);
    if ((from.unlisted || to.unlisted) && !there) {
        error = format("OCIO config \"{}\" has neither {} nor another space of known primaries", config_name,
                       from.unlisted ? from.name : to.name);
        return false;
    }
    const auto listed = [&](const SourceSpace& space) {
        return space.unlisted ? first_space_named(config, there->names) : space.name;
    };
    ColorConversion inside;
    if (!config_conversion(inside, config, config_name, listed(from), listed(to), error))
        return false;
    dst = from.unlisted ? one_after_the_other(matrix_conversion(*from.unlisted, *there), inside) : inside;
    if (to.unlisted)
        dst = one_after_the_other(dst, matrix_conversion(*there, *to.unlisted));
    return true;
}

} // namespace vmlight
