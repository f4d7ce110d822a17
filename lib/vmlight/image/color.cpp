// SPDX-License-Identifier: Apache-2.0
#include <vmlight/image/color.h>

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/image/channels.h>
#include <vmlight/image/color_transform.h>
#include <vmlight/image/primaries.h>

#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imagebufalgo_util.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace vmlight {

namespace {

// Make the image's pixels float, in memory that it owns.
bool make_float(OIIO::ImageBuf& image, std::string& error)
{
    const bool stored = image.storage() == OIIO::ImageBuf::LOCALBUFFER || image.storage() == OIIO::ImageBuf::APPBUFFER;
    if (!stored && !image.read(image.subimage(), image.miplevel(), true, OIIO::TypeFloat)) {
        error = oiio::error_line(image);
        return false;
    }
    if (image.spec().format != OIIO::TypeFloat) {
        OIIO::ImageBuf floats;
        if (!floats.copy(image, OIIO::TypeFloat)) {
            error = oiio::error_line(floats);
            return false;
        }
        image = std::move(floats);
    }
    return true;
}

// Skip pixels that are not finite: a matrix would spread them to other channels, a curve might hide them.
ColorConversion skip_not_finite(ColorConversion convert)
{
    if (!convert)
        return {};
    return [convert = std::move(convert)](float* rgb, int count) {
        std::vector<std::pair<int, std::array<float, 3>>> skipped;
        for (int i = 0; i < count; ++i) {
            float* p = rgb + 3 * size_t(i);
            if (std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]))
                continue;
            skipped.push_back({ i, { p[0], p[1], p[2] } });
            std::fill_n(p, 3, 0.0f);
        }
        convert(rgb, count);
        for (const auto& [i, pixel] : skipped)
            std::copy_n(pixel.data(), 3, rgb + 3 * size_t(i));
    };
}

// Converts the colour channels only, wherever they are: alpha and data are not colour.
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

const char* alpha_note(const OIIO::ImageSpec& spec)
{
    return spec.alpha_channel >= 0 ? "; alpha is ignored" : "";
}

void erase_color_metadata(OIIO::ImageSpec& spec)
{
    for (const char* name : { "oiio:ColorSpace", "oiio:Gamma", "colorInteropID", "chromaticities", "ICCProfile",
                              "acesImageContainerFlag" })
        spec.erase_attribute(name);
    spec.erase_attribute("ICCProfile:.*");
}

} // namespace

bool to_scene_linear(OIIO::ImageBuf& image, const std::string& path, const ColorSettings& settings, std::string& note,
                     std::string& error, int nthreads, std::vector<std::string>* warnings)
{
    std::array<int, 3> index;
    image.spec(); // opens the file of a lazy ImageBuf
    if (!image.initialized()) {
        error = image.has_error() ? oiio::error_line(image) : format("\"{}\": no image", path);
        return false;
    }
    if (image.deep()) {
        error = format("\"{}\": deep images are not supported", path);
        return false;
    }
    if (!find_color_channels(image.spec(), index, error)) {
        error = format("\"{}\": {}", path, error);
        return false;
    }
    ColorSettings known = settings;
    if (known.stored == OIIO::TypeUnknown)
        known.stored = image.nativespec().format;
    ColorTransform transform;
    if (!find_color_transform(transform, image.spec(), path, known, error))
        return false;
    if (transform.convert) {
        if (!make_float(image, error))
            return false;
        convert_pixels(image, index, skip_not_finite(std::move(transform.convert)), nthreads);
    }
    note = transform.note + alpha_note(image.spec());
    tag_scene_linear(image.specmod(), transform.space);
    if (warnings)
        warnings->insert(warnings->end(), transform.warnings.begin(), transform.warnings.end());
    return true;
}

bool describe_scene_linear(OIIO::ImageSpec& spec, ColorConversion& conversion, const std::string& path,
                           const ColorSettings& settings, std::string& note, std::string& error,
                           std::vector<std::string>* warnings)
{
    ColorSettings known = settings;
    if (known.stored == OIIO::TypeUnknown)
        known.stored = spec.format;
    ColorTransform transform;
    if (!find_color_transform(transform, spec, path, known, error))
        return false;
    note = transform.note + alpha_note(spec);
    tag_scene_linear(spec, transform.space);
    conversion = skip_not_finite(std::move(transform.convert));
    if (warnings)
        warnings->insert(warnings->end(), transform.warnings.begin(), transform.warnings.end());
    return true;
}

bool describe_scene_linear(OIIO::ImageSpec& spec, const std::string& path, const ColorSettings& settings,
                           std::string& error)
{
    ColorConversion unused;
    std::string note;
    return describe_scene_linear(spec, unused, path, settings, note, error);
}

std::string conversion_note(const OIIO::ImageSpec& spec, const std::string& path, const ColorSettings& settings)
{
    OIIO::ImageSpec described = spec;
    ColorConversion conversion;
    std::string note, ignored;
    return describe_scene_linear(described, conversion, path, settings, note, ignored) && conversion ? note : "";
}

void convert_color(OIIO::ImageBuf& image, const ColorConversion& conversion, const std::string& interop_id,
                   int nthreads)
{
    std::array<int, 3> index;
    std::string ignored; // without colour all inputs are in the space of the result
    if (conversion && find_color_channels(image.spec(), index, ignored))
        convert_pixels(image, index, conversion, nthreads);
    tag_scene_linear(image.specmod(), interop_id);
}

void tag_scene_linear(OIIO::ImageSpec& spec, const std::string& interop_id)
{
    erase_color_metadata(spec);
    spec.attribute("colorInteropID", interop_id);
    for (const LinearSpace& space : linear_spaces())
        if (space.interop_id == interop_id)
            spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), space.chromaticities.data());
}

void tag_data(OIIO::ImageSpec& spec)
{
    erase_color_metadata(spec);
    spec.attribute("colorInteropID", "data");
}

} // namespace vmlight
