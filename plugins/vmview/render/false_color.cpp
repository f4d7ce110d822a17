// SPDX-License-Identifier: Apache-2.0
#include "false_color.h"

#include <vmlight/image/channels.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vmlight::view {
namespace {

void gray(float value, float* rgb)
{
    std::fill_n(rgb, 3, value);
}

// Black, over red and yellow, to white.
void heat(float x, float* rgb)
{
    for (int c = 0; c < 3; ++c)
        rgb[c] = std::clamp(3 * x - float(c), 0.0f, 1.0f);
}

} // namespace

const std::vector<FalseColor>& false_colors()
{
    static const std::vector<FalseColor> colors {
        { "visibility", "Visibility V", "0 is black, 1 white", "",
          [](const float* seen, float, float* rgb) { gray(seen[0], rgb); } },
        { "direction", "Direction B", "x, y, z as red, green, blue: -1 is 0, 1 is 1", "",
          [](const float* seen, float, float* rgb) {
              for (int c = 0; c < 3; ++c)
                  rgb[c] = 0.5f + 0.5f * seen[1 + c];
          } },
        { "ratio", "Narrowness |B| / V", "0 is black; 2/3, an open hemisphere, grey; 1, a needle, white", "",
          [](const float* seen, float, float* rgb) {
              const float length = std::sqrt(seen[1] * seen[1] + seen[2] * seen[2] + seen[3] * seen[3]);
              gray(seen[0] > 0 ? length / seen[0] : 0, rgb);
          } },
        { "error", "Error of V", "0 is black, 0.1 and more white", kErrorChannel,
          [](const float*, float value, float* rgb) { heat(10 * value, rgb); } },
    };
    return colors;
}

const FalseColor* find_false_color(const std::string& word)
{
    for (const FalseColor& color : false_colors())
        if (word == color.word)
            return &color;
    return nullptr;
}

std::vector<float> false_color_image(const OIIO::ImageBuf& map, const FalseColor& color)
{
    const OIIO::ImageSpec& spec = map.spec();
    std::array<int, 4> index;
    std::string ignored;
    const int channel = *color.channel ? spec.channelindex(color.channel) : 0;
    if (!find_vismap_channels(spec, index, ignored) || channel < 0)
        return {};
    std::vector<float> rgb(3 * spec.image_pixels());
    const auto* texel = static_cast<const float*>(map.localpixels());
    for (size_t i = 0; i < rgb.size(); i += 3, texel += spec.nchannels) {
        const float seen[4] = { texel[index[0]], texel[index[1]], texel[index[2]], texel[index[3]] };
        color.color(seen, texel[channel], &rgb[i]);
    }
    return rgb;
}

} // namespace vmlight::view
