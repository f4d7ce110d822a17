// SPDX-License-Identifier: Apache-2.0
#include <vmlight/color.h>

#include <vmlight/channels.h>
#include <vmlight/color_space.h>
#include <vmlight/oiio.h>
#include <vmlight/params.h>

#include <OpenImageIO/color.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imagebufalgo_util.h>
#include <OpenImageIO/strutil.h>
#include <OpenImageIO/sysutil.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace vmlight {

using OIIO::ColorConfig;
using OIIO::Strutil::fmt::format;

namespace {

// What to do with an image, decided before a pixel is touched.
struct Decision
{
    ColorConversion convert; // of finite triples
    std::string space; // to tag the image with
    std::string note;
};

// PNG and its like: whole numbers of 8 or 16 bits, in the file, whatever they were turned into in memory.
bool is_whole_number(OIIO::TypeDesc stored)
{
    const OIIO::TypeDesc::BASETYPE type = static_cast<OIIO::TypeDesc::BASETYPE>(stored.basetype);
    return type == OIIO::TypeDesc::UINT8 || type == OIIO::TypeDesc::INT8 || type == OIIO::TypeDesc::UINT16
        || type == OIIO::TypeDesc::INT16;
}

bool decide_by_config(Decision& decision, const OIIO::ImageSpec& spec, const std::string& path,
                      const std::string& config_name, const ColorSettings& settings, std::string& error)
{
    // A pipe would hold its reader up; names such as ocio://default are no files.
    if (OIIO::Filesystem::exists(config_name) && !OIIO::Filesystem::is_regular(config_name)) {
        error = format("the OCIO config \"{}\" is not a file", config_name);
        return false;
    }
    ColorConfig config(config_name);
    if (config.has_error()) {
        error = format("cannot read the OCIO config \"{}\": {}", config_name, oiio::reason(config));
        return false;
    }
    if (!is_any_of("scene_linear", config.getRoles())) {
        error = format("the OCIO config \"{}\" has no role scene_linear", config_name);
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
            error = format("the OCIO config \"{}\" has no colour space \"{}\"", config_name, asked);
            error += near.empty() ? "; it has " + OIIO::Strutil::join(config.getColorSpaceNames(), ", ")
                                  : "; did you mean \"" + near + "\"?";
            return false;
        }
    }
    if (from.empty())
        from = space_of_path(config, path);
    if (from.empty())
        from = space_named(config, id);
    if (from.empty() && is_whole_number(settings.stored)) {
        from = first_space_named(
            config, { kSrgb, "sRGB - Texture", "srgb_texture", "srgb_tx", "Utility - sRGB - Texture", "sRGB" });
        if (from.empty()) {
            error = format("\"{}\": whole-number pixels are sRGB, and the OCIO config \"{}\" has no space {}; "
                           "name the image's colour space",
                           path, config_name, kSrgb);
            return false;
        }
    }
    if (from.empty())
        from = working;

    decision.space = interop_id_of(config, working);
    if (from == working) {
        decision.note = working + ", unchanged";
        return true;
    }
    if (is_data_space(config, from)) {
        decision.note = format("{} is data, used as {} unchanged", from, working);
        return true;
    }
    // A processor outlives its config.
    OIIO::ColorProcessorHandle processor = config.createColorProcessor(from, working);
    if (!processor) {
        error = format("the OCIO config \"{}\" cannot convert {} to {}: {}", config_name, from, working,
                       oiio::reason(config));
        return false;
    }
    decision.note = from + " -> " + working;
    if (!processor->isNoOp())
        decision.convert = [processor](float* rgb, int count) {
            const OIIO::stride_t channel = sizeof(float), pixel = 3 * channel;
            processor->apply(rgb, count, 1, 3, channel, pixel, pixel * count);
        };
    return true;
}

bool decide_without_config(Decision& decision, const OIIO::ImageSpec& spec, const ColorSettings& settings,
                           std::string& error)
{
    const std::string& asked = settings.from;
    // OIIO's own idea of no config differs from version to version, and so is not asked.
    const std::vector<std::string> srgb { kSrgb, "sRGB", "sRGB - Texture", "srgb_texture", "srgb_tx" };
    const std::vector<std::string> linear { kLinearRec709, "lin_rec709", "lin_srgb", "linear",
                                            "Linear Rec.709 (sRGB)" };
    const std::vector<std::string> data { "data", "raw" };
    const std::string id = spec.get_string_attribute("colorInteropID");
    const auto is_known
        = [&](const std::string& n) { return is_any_of(n, srgb) || is_any_of(n, linear) || is_any_of(n, data); };

    std::string from = asked;
    if (!asked.empty() && !is_known(asked)) {
        error = format("colour space \"{}\" needs an OCIO config, and none is set (--colorconfig or $OCIO); without "
                       "one there are {}, {} and data",
                       asked, kSrgb, kLinearRec709);
        return false;
    }
    if (from.empty() && !id.empty() && !is_whole_number(settings.stored))
        from = id;
    if (from.empty())
        from = is_any_of(id, data) || is_any_of(id, linear) ? id
            : is_whole_number(settings.stored)              ? kSrgb
                                                            : kLinearRec709;

    decision.space = kLinearRec709;
    if (is_any_of(from, srgb)) {
        decision.convert = [](float* rgb, int count) {
            std::transform(rgb, rgb + 3 * size_t(count), rgb, [](float x) { return OIIO::sRGB_to_linear(x); });
        };
        decision.note = format("{} -> {} (no OCIO config)", kSrgb, kLinearRec709);
    } else if (is_any_of(from, data)) {
        decision.note = format("data, used as {} unchanged (no OCIO config)", kLinearRec709);
    } else if (is_any_of(from, linear)) {
        decision.note = format("{}, unchanged (no OCIO config)", kLinearRec709);
    } else {
        // The file says another space. Its pixels stay, and so does the truth about them.
        decision.space = from;
        decision.note = format("{}, unchanged (no OCIO config)", from);
    }
    return true;
}

// Pixels of `image` as floats in its own memory.
bool make_float(OIIO::ImageBuf& image, std::string& error)
{
    const bool stored = image.storage() == OIIO::ImageBuf::LOCALBUFFER || image.storage() == OIIO::ImageBuf::APPBUFFER;
    if (!stored && !image.read(image.subimage(), image.miplevel(), true, OIIO::TypeFloat)) {
        error = oiio::reason(image);
        return false;
    }
    if (image.spec().format != OIIO::TypeFloat) {
        OIIO::ImageBuf floats;
        if (!floats.copy(image, OIIO::TypeFloat)) {
            error = oiio::reason(floats);
            return false;
        }
        image = std::move(floats);
    }
    return true;
}

// A pixel that is not finite stays as it is: a matrix would spread it to the other channels, and a curve might hide it.
ColorConversion among_finite(ColorConversion convert)
{
    if (!convert)
        return {};
    return [convert = std::move(convert)](float* rgb, int count) {
        std::vector<std::pair<int, std::array<float, 3>>> odd;
        for (int i = 0; i < count; ++i) {
            float* p = rgb + 3 * size_t(i);
            if (std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]))
                continue;
            odd.push_back({ i, { p[0], p[1], p[2] } });
            std::fill_n(p, 3, 0.0f);
        }
        convert(rgb, count);
        for (const auto& [i, pixel] : odd)
            std::copy_n(pixel.data(), 3, rgb + 3 * size_t(i));
    };
}

// Only the colour channels, wherever they are: neither alpha nor data channels are colour.
void convert_pixels(OIIO::ImageBuf& image, const std::array<int, 3>& index, const ColorConversion& convert,
                    int nthreads)
{
    OIIO::ImageBufAlgo::parallel_image(image.roi(), nthreads, [&](OIIO::ROI roi) {
        const int width = roi.width();
        std::vector<float> row(3 * size_t(width));
        for (int z = roi.zbegin; z < roi.zend; ++z) {
            for (int y = roi.ybegin; y < roi.yend; ++y) {
                const OIIO::ROI line(roi.xbegin, roi.xend, y, y + 1, z, z + 1);
                int i = 0;
                for (OIIO::ImageBuf::ConstIterator<float> p(image, line); !p.done(); ++p, ++i)
                    for (int c = 0; c < 3; ++c)
                        row[3 * size_t(i) + c] = p[index[c]];
                convert(row.data(), width);
                i = 0;
                for (OIIO::ImageBuf::Iterator<float> p(image, line); !p.done(); ++p, ++i)
                    for (int c = 0; c < 3; ++c)
                        p[index[c]] = row[3 * size_t(i) + c];
            }
        }
    });
}

// What an earlier space said of itself is no longer true.
void forget_space(OIIO::ImageSpec& spec)
{
    for (const char* name : { "oiio:ColorSpace", "oiio:Gamma", "colorInteropID", "chromaticities", "ICCProfile",
                              "acesImageContainerFlag" })
        spec.erase_attribute(name);
    spec.erase_attribute("ICCProfile:.*");
}

// `settings.stored` must be known.
bool decide(Decision& decision, const OIIO::ImageSpec& spec, const std::string& path, const ColorSettings& settings,
            std::string& error)
{
    const std::string config = settings.config.empty() ? std::string(OIIO::Sysutil::getenv("OCIO")) : settings.config;
    return config.empty() ? decide_without_config(decision, spec, settings, error)
                          : decide_by_config(decision, spec, path, config, settings, error);
}

} // namespace

bool to_scene_linear(OIIO::ImageBuf& image, const std::string& path, const ColorSettings& settings, std::string& note,
                     std::string& error, int nthreads)
{
    std::array<int, 3> index;
    image.spec(); // opens a file that was only named
    if (!image.initialized()) {
        error = image.has_error() ? oiio::reason(image) : format("\"{}\": no image", path);
        return false;
    }
    if (image.deep()) {
        error = format("\"{}\": a deep image has no one colour a pixel", path);
        return false;
    }
    if (!find_color_channels(image.spec(), index, error)) {
        error = format("\"{}\": {}", path, error);
        return false;
    }
    ColorSettings known = settings;
    if (known.stored == OIIO::TypeUnknown)
        known.stored = image.nativespec().format;
    Decision decision;
    if (!decide(decision, image.spec(), path, known, error))
        return false;
    if (decision.convert) {
        if (!make_float(image, error))
            return false;
        convert_pixels(image, index, among_finite(std::move(decision.convert)), nthreads);
    }
    tag_scene_linear(image.specmod(), decision.space);
    note = decision.note;
    return true;
}

bool describe_scene_linear(OIIO::ImageSpec& spec, ColorConversion& conversion, const std::string& path,
                           const ColorSettings& settings, std::string& note, std::string& error)
{
    ColorSettings known = settings;
    if (known.stored == OIIO::TypeUnknown)
        known.stored = spec.format;
    Decision decision;
    if (!decide(decision, spec, path, known, error))
        return false;
    tag_scene_linear(spec, decision.space);
    conversion = among_finite(std::move(decision.convert));
    note = decision.note;
    return true;
}

bool describe_scene_linear(OIIO::ImageSpec& spec, const std::string& path, const ColorSettings& settings,
                           std::string& error)
{
    ColorConversion unused;
    std::string note;
    return describe_scene_linear(spec, unused, path, settings, note, error);
}

void tag_scene_linear(OIIO::ImageSpec& spec, const std::string& interop_id)
{
    forget_space(spec);
    spec.attribute("colorInteropID", interop_id);
    if (const float* chromaticities = chromaticities_of(interop_id))
        spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), chromaticities);
}

void tag_data(OIIO::ImageSpec& spec)
{
    forget_space(spec);
    spec.attribute("colorInteropID", "data");
}

} // namespace vmlight
