// SPDX-License-Identifier: Apache-2.0
#include "light_textures.h"

#include "map_textures.h"

#include <vmlight/cfem/stack.h>
#include <vmlight/lightmap/cfem_lookup.h>
#include <vmlight/lightmap/lobe_lookup.h>

#include <algorithm>

namespace vmlight::view {
namespace {

Texture load_lobes(const LobeLookup& lookup)
{
    const int rows = lookup.height + 2;
    const size_t texels = size_t(lookup.pitch) * size_t(rows);
    Texture texture = Texture::layers(lookup.pitch, rows, kLobeKnots, GL_RGB32F);
    std::vector<float> layer(3 * texels);
    for (int knot = 0; knot < kLobeKnots; ++knot) {
        // The wider of a pair, but of the last the narrower.
        const int pair = std::min(knot, kLobeKnots - 2);
        const float* src = &lookup.texels[kLobeFloats * size_t(pair) * texels + (knot > pair ? 3 : 0)];
        for (size_t i = 0; i < texels; ++i)
            std::copy_n(src + kLobeFloats * i, 3, &layer[3 * i]);
        texture.fill_layer(knot, GL_RGB, layer.data());
    }
    return texture;
}

} // namespace

bool LightTextures::load(const std::vector<OIIO::ImageBuf>& images, std::string& error)
{
    CfemLookup lookup;
    if (!prepare_cfem(lookup, images[0], error))
        return false;
    error = texture_size_fault("a light", lookup.pitch, lookup.height + 4);
    if (!error.empty())
        return false;
    width = lookup.width;
    height = lookup.height;
    std::copy_n(lookup.brightest, 3, brightest);
    cfem = Texture::image(lookup.pitch, lookup.height + 4, GL_RGBA32F, GL_RGBA, lookup.texels.data());
    lobes = Texture();
    if (!is_stack(images))
        return true;
    LobeLookup stack;
    if (!prepare_lobes(
            stack,
            OIIO::cspan<OIIO::ImageBuf>(images).subspan(0, std::min<ptrdiff_t>(kStackLevels, ptrdiff_t(images.size()))),
            error))
        return false;
    lobes = load_lobes(stack);
    return true;
}

} // namespace vmlight::view
