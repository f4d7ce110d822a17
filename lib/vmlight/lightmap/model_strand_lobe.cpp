// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/model_strand_lobe.h>

#include <vmlight/lightmap/lookup_kernel.h>
#include <vmlight/lightmap/model_lobe.h>
#include <vmlight/lightmap/model_paper.h>

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace vmlight {
namespace {

constexpr size_t kBlock = 256; // texels that are parted before they are shaded

// As the lookups measure it: without overflow on the way.
float length_of(const float* b)
{
    const float m = std::max({ std::abs(b[0]), std::abs(b[1]), std::abs(b[2]) }), scale = 1 / std::max(m, FLT_MIN);
    const float x = b[0] * scale, y = b[1] * scale, z = b[2] * scale;
    return m * std::sqrt(x * x + y * y + z * z);
}

struct StrandLobeShader : ModelShader
{
    StrandLobeLight light;
    ShadeSetup setup;

    bool shade(TexelLayout, const float* vismap, size_t texels, float* rgb) const override
    {
        return shade_strand_lobe(light, setup, vismap, texels, rgb);
    }
};

} // namespace

bool shade_strand_lobe(const StrandLobeLight& light, const ShadeSetup& setup, const float* vismap, size_t texels,
                       float* rgb)
{
    float narrow[4 * kBlock], around[4 * kBlock], rest[3 * kBlock], brightest[3];
    for (int c = 0; c < 3; ++c)
        brightest[c] = brightest_light(light.sine, setup.gain, c);
    bool sound = true;
    for (size_t done = 0; done < texels; done += kBlock) {
        const size_t count = std::min(kBlock, texels - done);
        for (size_t i = 0; i < count; ++i) {
            const float* texel = vismap + size_t(kStrandLobeFloats) * (done + i);
            sound &= std::abs(texel[0]) <= kLargestVisibility;
            const float part = std::min(texel[0], 2 * length_of(texel + 1));
            narrow[4 * i] = part;
            std::copy_n(texel + 1, 3, narrow + 4 * i + 1);
            around[4 * i] = texel[0] - part;
            std::copy_n(texel + 4, 3, around + 4 * i + 1);
        }
        float* out = rgb + 3 * done;
        sound &= shade_lobe(light.lobes, setup, TexelLayout::visibility_first, narrow, count, out);
        sound &= shade_paper(light.sine, setup, TexelLayout::visibility_first, around, count, rest);
        for (size_t i = 0; i < 3 * count; ++i)
            out[i] = std::min(out[i] + rest[i], brightest[i % 3]);
    }
    return sound;
}

std::unique_ptr<ModelShader> prepare_strand_lobe(const ModelInput& input, std::string& error)
{
    auto shader = std::make_unique<StrandLobeShader>();
    shader->setup = input.setup;
    if (!prepare_lobes(shader->light.lobes, input.light, error)
        || !prepare_cfem(shader->light.sine, input.light[0], error))
        return nullptr;
    return shader;
}

} // namespace vmlight
