// SPDX-License-Identifier: Apache-2.0
#include <vmlight/image/color_transform.h>

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/base/params.h>
#include <vmlight/image/color_space.h>

#include <OpenImageIO/color.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>
#include <OpenImageIO/sysutil.h>

#include <algorithm>
#include <vector>

namespace vmlight {

using OIIO::ColorConfig;

namespace {

// 8 or 16 bit integers in the file, as in PNG.
bool is_integer(OIIO::TypeDesc stored)
{
    const OIIO::TypeDesc::BASETYPE type = static_cast<OIIO::TypeDesc::BASETYPE>(stored.basetype);
    return type == OIIO::TypeDesc::UINT8 || type == OIIO::TypeDesc::INT8 || type == OIIO::TypeDesc::UINT16
        || type == OIIO::TypeDesc::INT16;
}

bool find_with_config(ColorTransform& transform, const OIIO::ImageSpec& spec, const std::string& path,
                      const std::string& config_name, const ColorSettings& settings, std::string& error)
{
    // A pipe would block OCIO. Names such as ocio://default are not files.
    if (OIIO::Filesystem::exists(config_name) && !OIIO::Filesystem::is_regular(config_name)) {
        error = format("OCIO config \"{}\": not a file", config_name);
        return false;
    }
    ColorConfig config(config_name);
    if (config.has_error()) {
        error = format("OCIO config \"{}\": {}", config_name, oiio::error_line(config));
        return false;
    }
    if (!is_any_of("scene_linear", config.getRoles())) {
        error = format("OCIO config \"{}\" has no role scene_linear", config_name);
        return false;
    }
    const std::string working = config.getColorSpaceNameByRole("scene_linear");

    std::string from;
    const std::string& asked = settings.from;
    const std::string id = spec.get_string_attribute("colorInteropID");
    if (!asked.empty()) {
        from = space_named(config, asked);
        if (from.empty()) {
            const std::string near = nearest_name(asked, all_space_names(config));
            error = format("OCIO config \"{}\" has no colour space \"{}\"", config_name, asked);
            error += near.empty() ? "; it has " + OIIO::Strutil::join(config.getColorSpaceNames(), ", ")
                                  : "; did you mean \"" + near + "\"?";
            return false;
        }
    }
    if (from.empty())
        from = space_of_path(config, path);
    if (from.empty())
        from = space_named(config, id);
    if (from.empty() && is_integer(settings.stored)) {
        from = first_space_named(
            config, { kSrgb, "sRGB - Texture", "srgb_texture", "srgb_tx", "Utility - sRGB - Texture", "sRGB" });
        if (from.empty()) {
            error = format("\"{}\": integer pixels are taken as sRGB, but OCIO config \"{}\" has no colour space {}; "
                           "specify the image's colour space",
                           path, config_name, kSrgb);
            return false;
        }
    }
    if (from.empty())
        from = working;

    transform.space = interop_id_of(config, working);
    if (from == working) {
        transform.note = working + ", unchanged";
        return true;
    }
    if (is_data_space(config, from)) {
        transform.note = format("{} is data, used as {} unchanged", from, working);
        return true;
    }
    // A processor outlives its config.
    OIIO::ColorProcessorHandle processor = config.createColorProcessor(from, working);
    if (!processor) {
        error = format("OCIO config \"{}\" cannot convert {} to {}: {}", config_name, from, working,
                       oiio::error_line(config));
        return false;
    }
    transform.note = from + " -> " + working;
    if (!processor->isNoOp())
        transform.convert = [processor](float* rgb, int count) {
            const OIIO::stride_t channel = sizeof(float), pixel = 3 * channel;
            processor->apply(rgb, count, 1, 3, channel, pixel, pixel * count);
        };
    return true;
}

bool find_without_config(ColorTransform& transform, const OIIO::ImageSpec& spec, const ColorSettings& settings,
                         std::string& error)
{
    const std::string& asked = settings.from;
    // OIIO's built-in config differs between versions: do not use it.
    const std::vector<std::string> srgb { kSrgb, "sRGB", "sRGB - Texture", "srgb_texture", "srgb_tx" };
    const std::vector<std::string> linear { kLinearRec709, "lin_rec709", "lin_srgb", "linear",
                                            "Linear Rec.709 (sRGB)" };
    const std::vector<std::string> data { "data", "raw" };
    const std::string id = spec.get_string_attribute("colorInteropID");
    const auto is_known
        = [&](const std::string& n) { return is_any_of(n, srgb) || is_any_of(n, linear) || is_any_of(n, data); };

    std::string from = asked;
    if (!asked.empty() && !is_known(asked)) {
        error = format("colour space \"{}\" needs an OCIO config: set --colorconfig or $OCIO; without one only {}, {} "
                       "and data are known",
                       asked, kSrgb, kLinearRec709);
        return false;
    }
    if (from.empty() && !id.empty() && !is_integer(settings.stored))
        from = id;
    if (from.empty())
        from = is_any_of(id, data) || is_any_of(id, linear) ? id : is_integer(settings.stored) ? kSrgb : kLinearRec709;

    transform.space = kLinearRec709;
    if (is_any_of(from, srgb)) {
        transform.convert = [](float* rgb, int count) {
            std::transform(rgb, rgb + 3 * size_t(count), rgb, [](float x) { return OIIO::sRGB_to_linear(x); });
        };
        transform.note = format("{} -> {} (no OCIO config)", kSrgb, kLinearRec709);
    } else if (is_any_of(from, data)) {
        transform.note = format("data, used as {} unchanged (no OCIO config)", kLinearRec709);
    } else if (is_any_of(from, linear)) {
        transform.note = format("{}, unchanged (no OCIO config)", kLinearRec709);
    } else {
        // Tagged with another space: keep pixels and tag.
        transform.space = from;
        transform.note = format("{}, unchanged (no OCIO config)", from);
    }
    return true;
}

} // namespace

bool find_color_transform(ColorTransform& transform, const OIIO::ImageSpec& spec, const std::string& path,
                          const ColorSettings& settings, std::string& error)
{
    const std::string config = settings.config.empty() ? std::string(OIIO::Sysutil::getenv("OCIO")) : settings.config;
    return config.empty() ? find_without_config(transform, spec, settings, error)
                          : find_with_config(transform, spec, path, config, settings, error);
}

} // namespace vmlight
