// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/streamed_environment.h>

#include <vmlight/base/format.h>
#include <vmlight/image/channels.h>

#include <array>
#include <utility>
#include <vector>

namespace vmlight {
namespace {

constexpr OIIO::imagesize_t kMostHeld = OIIO::imagesize_t(256) << 20; // bytes

void convert_row(float* pixels, const OIIO::ImageSpec& spec, const std::array<int, 3>& channels,
                 const ColorConversion& conversion)
{
    std::vector<float> rgb(3 * size_t(spec.width));
    for (int x = 0; x < spec.width; ++x)
        for (int c = 0; c < 3; ++c)
            rgb[3 * size_t(x) + c] = pixels[size_t(x) * spec.nchannels + channels[c]];
    conversion(rgb.data(), spec.width);
    for (int x = 0; x < spec.width; ++x)
        for (int c = 0; c < 3; ++c)
            pixels[size_t(x) * spec.nchannels + channels[c]] = rgb[3 * size_t(x) + c];
}

} // namespace

bool is_too_large_to_hold(const OIIO::ImageSpec& spec)
{
    return spec.image_pixels() * OIIO::imagesize_t(spec.nchannels) * sizeof(float) > kMostHeld;
}

bool stream_environment(std::optional<Environment>& dst, const PixelSourcePointer& image, const std::string& path,
                        const ColorSettings& settings, std::string& note, std::string& error,
                        std::vector<std::string>* warnings)
{
    OIIO::ImageSpec spec = image->spec();
    std::array<int, 3> channels;
    ColorConversion conversion;
    if (!find_color_channels(spec, channels, error)) {
        error = format("\"{}\": {}", path, error);
        return false;
    }
    if (!describe_scene_linear(spec, conversion, path, settings, note, error, warnings))
        return false;
    dst.emplace(spec, [=](int y, float* pixels, std::string& reason) {
        if (!image->read(OIIO::ROI(spec.x, spec.x + spec.width, y, y + 1), pixels, reason))
            return false;
        if (conversion)
            convert_row(pixels, spec, channels, conversion);
        return true;
    });
    return true;
}

} // namespace vmlight
