// SPDX-License-Identifier: Apache-2.0
#include <vmlight/export/lightmap_encoding.h>

#include <vmlight/base/format.h>
#include <vmlight/image/channels.h>
#include <vmlight/image/color_conversion.h>
#include <vmlight/image/color_labels.h>

#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vmlight {
namespace {

constexpr const char* kEngineSpace = "lin_rec709_scene";

// nullptr: it says nothing. False if it says something that is not known.
bool space_of(const LinearSpace*& space, const OIIO::ImageSpec& spec, std::string& error)
{
    const ColorLabels labels = read_color_labels(spec, OIIO::TypeFloat);
    space = labels.interop_id.empty() ? labels.primaries : linear_space_named(labels.interop_id);
    if (space || (labels.interop_id.empty() && labels.unknown_primaries.empty()))
        return true;
    error = format("its colour space is \"{}\"; make it with --output-colorspace {}",
                   labels.interop_id.empty() ? labels.unknown_primaries : labels.interop_id, kEngineSpace);
    return false;
}

bool as_rgbe(std::vector<LightmapFile>& dst, const OIIO::ImageBuf& light, double, TextureDepth, std::string& error)
{
    TextureFile& file = dst.emplace_back().texture;
    file.extension = "hdr";
    file.decode = "linear Rec.709";
    return encode_rgbe(file.bytes, light, error);
}

bool as_rgbm(std::vector<LightmapFile>& dst, const OIIO::ImageBuf& light, double range, TextureDepth depth,
             std::string& error)
{
    return encode_rgbm(dst.emplace_back().texture, light, range, depth, error);
}

bool as_gain_map(std::vector<LightmapFile>& dst, const OIIO::ImageBuf& light, double, TextureDepth depth,
                 std::string& error)
{
    return encode_gain_map(dst, light, depth, error);
}

struct Encoding
{
    const char *name, *help;
    bool (*encode)(std::vector<LightmapFile>&, const OIIO::ImageBuf&, double range, TextureDepth, std::string& error);
};

const Encoding kEncodings[] = {
    { "half", "EXR of half floats", nullptr },
    { "rgbe", "Radiance .hdr", as_rgbe },
    { "rgbm", "PNG: light = range * alpha * rgb", as_rgbm },
    { "gain_map", "PNG in sRGB, a PNG of gains and JSON, as three.js' GainMapLoader reads them", as_gain_map },
};

} // namespace

Choices lightmap_encoding_choices()
{
    Choices choices;
    for (const Encoding& encoding : kEncodings)
        choices.choices.push_back({ encoding.name, encoding.help });
    return choices;
}

bool encode_lightmap(std::vector<LightmapFile>& dst, const OIIO::ImageBuf& light, const std::string& encoding,
                     double range, TextureDepth depth, std::string& error)
{
    const auto* found = std::find_if(std::begin(kEncodings), std::end(kEncodings),
                                     [&](const Encoding& each) { return encoding == each.name; });
    return found->encode(dst, light, range, depth, error);
}

bool engine_light(OIIO::ImageBuf& dst, const OIIO::ImageBuf& lightmap, std::string& error)
{
    std::array<int, 3> index;
    const LinearSpace* space = nullptr;
    if (!find_color_channels(lightmap.spec(), index, error) || !space_of(space, lightmap.spec(), error))
        return false;
    OIIO::ImageBuf rgb = OIIO::ImageBufAlgo::channels(lightmap, 3, index).copy(OIIO::TypeFloat);
    const LinearSpace* engine = linear_space_named(kEngineSpace);
    auto* pixels = static_cast<float*>(rgb.localpixels());
    const int count = int(rgb.spec().image_pixels());
    for (int i = 0; i < 3 * count; ++i)
        if (!std::isfinite(pixels[i])) {
            error = format("pixel ({}, {}) is {}", i / 3 % rgb.spec().width, i / 3 / rgb.spec().width, pixels[i]);
            return false;
        }
    if (space && space != engine)
        matrix_conversion(*space, *engine)(pixels, count);
    for (int i = 0; i < 3 * count; ++i)
        pixels[i] = std::max(pixels[i], 0.0f);
    dst = OIIO::ImageBuf(OIIO::ImageSpec(rgb.spec().width, rgb.spec().height, 3, OIIO::TypeFloat));
    std::copy_n(pixels, size_t(3 * count), static_cast<float*>(dst.localpixels()));
    tag_scene_linear(dst.specmod(), kEngineSpace);
    return true;
}

float greatest_value(const OIIO::ImageBuf& image)
{
    const auto* values = static_cast<const float*>(image.localpixels());
    return *std::max_element(values, values + image.spec().image_pixels() * size_t(image.nchannels()));
}

bool encode_rgbm(TextureFile& dst, const OIIO::ImageBuf& light, double& range, TextureDepth depth, std::string& error)
{
    const double greatest = double(greatest_value(light)), steps = largest_of(depth);
    if (range > 0 && greatest > range) {
        error = format("its greatest value is {:.6g}, and RGBM holds no more than its range, {:.6g}", greatest, range);
        return false;
    }
    if (!(range > 0))
        range = greatest > 0 ? greatest : 1;
    OIIO::ImageBuf image(OIIO::ImageSpec(light.spec().width, light.spec().height, 4, OIIO::TypeFloat));
    const auto* from = static_cast<const float*>(light.localpixels());
    auto* to = static_cast<float*>(image.localpixels());
    for (size_t i = 0; i < light.spec().image_pixels(); ++i, from += 3, to += 4) {
        const double most = double(std::max({ from[0], from[1], from[2] }));
        const double alpha = std::clamp(std::ceil(most / range * steps), 1.0, steps) / steps;
        for (int c = 0; c < 3; ++c)
            to[c] = float(double(from[c]) / (range * alpha));
        to[3] = float(alpha);
    }
    dst.extension = "png";
    dst.decode = format("light = {:.9g} * alpha * rgb", range);
    return encode_png(dst.bytes, image, depth, error);
}

} // namespace vmlight
