// SPDX-License-Identifier: Apache-2.0
#include <vmlight/image/color.h>

#include <vmlight/base/oiio.h>
#include <vmlight/image/channels.h>
#include <vmlight/image/color_decision.h>
#include <vmlight/image/color_space.h>

#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imagebufalgo_util.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace vmlight {

using OIIO::Strutil::fmt::format;

namespace {

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
    ColorDecision decision;
    if (!decide_color(decision, image.spec(), path, known, error))
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
    ColorDecision decision;
    if (!decide_color(decision, spec, path, known, error))
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
