// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/model_paper.h>

#include <vmlight/image/channels.h>
#include <vmlight/lightmap/lookup_kernel.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vmlight/lightmap/model_paper.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for each instruction set.
#include <hwy/highway.h>

#include <vmlight/lightmap/lookup_vectors-inl.h>

#include <algorithm>
#include <cfloat>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace vmlight {
namespace HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR

// A processor without vectors, as Highway sees it: SSE2 alone is one.
bool ShadePaper(const CfemLookup& cfem, const ShadeSetup& setup, TexelLayout layout, const float* vismap, size_t texels,
                float* rgb)
{
    return shade_paper_scalar(cfem, setup, layout, vismap, texels, rgb);
}

#else

struct PaperModel
{
    static constexpr bool kLobe = false;

    // Four neighbours, each by one 128-bit load: faster than gathers, which fetch a float at a time.
    static HWY_INLINE void LookUp(const Light& sky, const Lookups& lookups, size_t i, float* rgbx)
    {
        const hn::FixedTag<float, 4> d;
        const float* p = sky.texels + 4 * size_t(lookups.place[i]);
        const float* q = p + 4 * size_t(sky.pitch);
        const auto up = hn::Add(hn::Mul(hn::Set(d, lookups.weights[0][i]), hn::LoadU(d, p)),
                                hn::Mul(hn::Set(d, lookups.weights[1][i]), hn::LoadU(d, p + 4)));
        const auto down = hn::Add(hn::Mul(hn::Set(d, lookups.weights[2][i]), hn::LoadU(d, q)),
                                  hn::Mul(hn::Set(d, lookups.weights[3][i]), hn::LoadU(d, q + 4)));
        hn::StoreU(hn::Add(up, down), d, rgbx);
    }
};

bool ShadePaper(const CfemLookup& cfem, const ShadeSetup& setup, TexelLayout layout, const float* vismap, size_t texels,
                float* rgb)
{
    return Shade<PaperModel>(Light(cfem, setup), layout, vismap, texels, rgb);
}

#endif

} // namespace HWY_NAMESPACE
} // namespace vmlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vmlight {

HWY_EXPORT(ShadePaper);

bool shade_paper(const CfemLookup& cfem, const ShadeSetup& setup, TexelLayout layout, const float* vismap,
                 size_t texels, float* rgb)
{
    return HWY_DYNAMIC_DISPATCH(ShadePaper)(cfem, setup, layout, vismap, texels, rgb);
}

bool shade_paper_scalar(const CfemLookup& cfem, const ShadeSetup& setup, TexelLayout layout, const float* vismap,
                        size_t texels, float* rgb)
{
    const float* r = setup.rotation;
    const float w = float(cfem.width), h = float(cfem.height);
    const float limit = largest_light(cfem, setup.gain);
    bool sound = true;
    for (size_t i = 0; i < texels; ++i, vismap += 4, rgb += 3) {
        const bool first = layout == TexelLayout::visibility_first;
        const float v = first ? vismap[0] : vismap[3];
        const float* b = first ? vismap + 1 : vismap;
        const float light = v * setup.gain;
        sound &= std::isfinite(b[0] + b[1] + b[2]) && std::abs(light) <= limit;

        const float m = std::max({ std::abs(b[0]), std::abs(b[1]), std::abs(b[2]) });
        const float scale = 1 / std::max(m, FLT_MIN);
        const float x = b[0] * scale, y = b[1] * scale, z = b[2] * scale;
        const float ex = r[0] * x + r[1] * y + r[2] * z;
        const float ey = r[3] * x + r[4] * y + r[5] * z;
        const float ez = r[6] * x + r[7] * y + r[8] * z;
        const float across = std::sqrt(ex * ex + ez * ez);

        float u = 0.5f * w + 0.5f - atan2_turns(ex, ez) * w;
        float t = 0.5f * h + 0.5f - atan2_turns(ey, across) * (2 * h);
        // Written so that NaN, too, ends inside.
        u = u > 0 ? std::min(u, w + 0.5f) : 0.0f;
        t = t > 0.5f ? std::min(t, h + 0.5f) : 0.5f;
        const int iu = int(u), it = int(t);
        const float fu = u - float(iu), ft = t - float(it);
        const int at = m < v * kNoDirection ? cfem.mean_texel() : it * cfem.pitch + iu;

        const float total = std::max(light, 0.0f), lower = total * ft, upper = total - lower;
        const float w01 = upper * fu, w00 = upper - w01, w11 = lower * fu, w10 = lower - w11;
        const float* p = cfem.texels.data() + 4 * size_t(at);
        const float* q = p + 4 * size_t(cfem.pitch);
        for (int c = 0; c < 3; ++c)
            rgb[c] = (w00 * p[c] + w01 * p[c + 4]) + (w10 * q[c] + w11 * q[c + 4]);
    }
    return sound;
}

namespace {

struct PaperShader : ModelShader
{
    CfemLookup cfem;
    ShadeSetup setup;

    bool shade(TexelLayout layout, const float* vismap, size_t texels, float* rgb) const override
    {
        return shade_paper(cfem, setup, layout, vismap, texels, rgb);
    }
};

} // namespace

std::vector<std::string> paper_model_channels(const OIIO::ImageSpec&)
{
    return { kVismapChannels.begin(), kVismapChannels.end() };
}

std::vector<std::string> ao_model_channels(const OIIO::ImageSpec& vismap)
{
    const auto& axis = kernel_of(vismap) == kStrandKernel ? kTangentChannels : kNormalChannels;
    return { kVismapChannels[0], axis[0], axis[1], axis[2] };
}

std::unique_ptr<ModelShader> prepare_paper(const ModelInput& input, std::string& error)
{
    auto shader = std::make_unique<PaperShader>();
    shader->setup = input.setup;
    if (!prepare_cfem(shader->cfem, input.light[0], error))
        return nullptr;
    return shader;
}

} // namespace vmlight
#endif
