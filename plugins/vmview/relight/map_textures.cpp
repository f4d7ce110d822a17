// SPDX-License-Identifier: Apache-2.0
#include "map_textures.h"

#include <vmlight/base/format.h>
#include <vmlight/image/channels.h>
#include <vmlight/lightmap/model_sh.h>

#include <array>

namespace vmlight::view {
namespace {

// Four channels of all texels, by their indices; -1 is 0.
std::vector<float> pick(const OIIO::ImageBuf& image, const std::array<int, 4>& index)
{
    const size_t texels = size_t(image.spec().image_pixels()), stride = size_t(image.nchannels());
    const auto* src = static_cast<const float*>(image.localpixels());
    std::vector<float> dst(4 * texels, 0.0f);
    for (size_t c = 0; c < 4; ++c)
        for (size_t i = 0; index[c] >= 0 && i < texels; ++i)
            dst[4 * i + c] = src[stride * i + size_t(index[c])];
    return dst;
}

} // namespace

std::string texture_size_fault(const char* what, int width, int height)
{
    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    if (width <= most && height <= most)
        return "";
    return format("{} of {}x{} texels is too large for this graphics driver; the limit is {}", what, width, height,
                  most);
}

bool MapTextures::load(const OIIO::ImageBuf& vismap, const std::vector<float>& coverage, std::string& error)
{
    const OIIO::ImageSpec& spec = vismap.spec();
    std::array<int, 4> seen;
    if (!find_vismap_channels(spec, seen, error))
        return false;
    error = texture_size_fault("a visibility map", spec.width, spec.height);
    if (!error.empty())
        return false;
    width = spec.width;
    height = spec.height;
    std::array<int, 4> axis { -1, -1, -1, -1 };
    is_of_strands = kernel_of(spec) == kStrandKernel;
    const auto& axis_channels = is_of_strands ? kTangentChannels : kNormalChannels;
    for (size_t c = 0; c < axis_channels.size(); ++c)
        axis[c] = spec.channelindex(axis_channels[c]);
    const std::vector<std::string> names = has_sh(spec) ? sh_model_channels(spec) : std::vector<std::string>();
    harmonics = names.empty() ? 4 : int(names.size());

    layers = Texture::layers(width, height, 2 + (harmonics - 1) / 4, GL_RGBA32F);
    layers.fill_layer(0, GL_RGBA, pick(vismap, seen).data());
    std::vector<float> second = pick(vismap, axis);
    for (size_t i = 0; i < coverage.size(); ++i)
        second[4 * i + 3] = coverage[i];
    layers.fill_layer(1, GL_RGBA, second.data());
    for (int k = 4; k < harmonics; k += 4) {
        std::array<int, 4> index { -1, -1, -1, -1 };
        for (int c = 0; c < 4 && k + c < harmonics; ++c)
            index[size_t(c)] = spec.channelindex(names[size_t(k + c)]);
        layers.fill_layer(1 + k / 4, GL_RGBA, pick(vismap, index).data());
    }
    return true;
}

} // namespace vmlight::view
