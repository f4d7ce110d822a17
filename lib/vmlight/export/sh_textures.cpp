// SPDX-License-Identifier: Apache-2.0
#include <vmlight/export/sh_textures.h>

#include <vmlight/image/channels.h>
#include <vmlight/lightmap/model_sh.h>

#include <string>

namespace vmlight {

std::vector<OIIO::ImageBuf> sh_textures(const OIIO::ImageBuf& map)
{
    std::vector<std::string> names(kVismapChannels.begin(), kVismapChannels.end());
    if (has_sh(map.spec()))
        names = sh_model_channels(map.spec());
    const OIIO::ImageSpec& spec = map.spec();
    const auto* pixels = static_cast<const float*>(map.localpixels());
    const size_t count = size_t(spec.width) * size_t(spec.height);
    std::vector<OIIO::ImageBuf> textures;
    for (size_t first = 0; first < names.size(); first += 4) {
        OIIO::ImageBuf& texture = textures.emplace_back(OIIO::ImageSpec(spec.width, spec.height, 4, OIIO::TypeFloat));
        auto* dst = static_cast<float*>(texture.localpixels());
        for (size_t c = 0; c < 4; ++c) {
            const int index = first + c < names.size() ? spec.channelindex(names[first + c]) : -1;
            for (size_t i = 0; i < count; ++i)
                dst[4 * i + c] = index < 0 ? 0 : pixels[i * size_t(spec.nchannels) + size_t(index)];
        }
    }
    return textures;
}

void fold_sh(OIIO::ImageBuf& texture, int number)
{
    auto* value = static_cast<float*>(texture.localpixels());
    for (size_t i = 0; i < 4 * texture.spec().image_pixels(); ++i) {
        const bool is_v = number == 0 && i % 4 == 0, is_b = number == 0 && i % 4 > 0;
        value[i] = is_v ? value[i] : is_b ? (value[i] + 1) / 2 : value[i] + kShBound;
    }
}

} // namespace vmlight
