// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/model_lobe.h>

#include <vmlight/image/channels.h>
#include <vmlight/lightmap/lookup_kernel.h>
#include <vmlight/lightmap/model_strand_lobe.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vmlight/lightmap/model_lobe.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for each instruction set.
#include <hwy/highway.h>

#include <vmlight/lightmap/lookup_vectors-inl.h>

#include <algorithm>
#include <cfloat>

HWY_BEFORE_NAMESPACE();
namespace vmlight {
namespace HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR

bool ShadeLobe(const LobeLookup& lobes, const ShadeSetup& setup, TexelLayout layout, const float* vismap, size_t texels,
               float* rgb)
{
    return shade_lobe_scalar(lobes, setup, layout, vismap, texels, rgb);
}

#else

template <class D, class V = hn::Vec<D>>
HWY_INLINE V Bilinear(D d, const Lookups& lookups, size_t i, const float* p, const float* q)
{
    constexpr size_t next = kLobeFloats;
    const V up = hn::Add(hn::Mul(hn::Set(d, lookups.weights[0][i]), hn::LoadU(d, p)),
                         hn::Mul(hn::Set(d, lookups.weights[1][i]), hn::LoadU(d, p + next)));
    const V down = hn::Add(hn::Mul(hn::Set(d, lookups.weights[2][i]), hn::LoadU(d, q)),
                           hn::Mul(hn::Set(d, lookups.weights[3][i]), hn::LoadU(d, q + next)));
    return hn::Add(up, down);
}

struct LobeModel
{
    static constexpr bool kLobe = true;

    // Both lobes at once, where a load takes eight floats.
    static HWY_INLINE void LookUp(const Light& sky, const Lookups& lookups, size_t i, float* rgbx)
    {
        const hn::FixedTag<float, 4> d;
        const float* p = sky.texels + lookups.place[i];
        const float* q = p + kLobeFloats * size_t(sky.pitch);
#if HWY_MAX_BYTES >= 32 && !HWY_HAVE_SCALABLE
        const auto lobes = Bilinear(hn::FixedTag<float, 8>(), lookups, i, p, q);
        const auto wide = hn::LowerHalf(d, lobes), rest = hn::UpperHalf(d, lobes);
        const auto narrow = hn::CombineShiftRightBytes<12>(d, rest, wide); // from the fourth float on
#else
        const auto wide = Bilinear(d, lookups, i, p, q), narrow = Bilinear(d, lookups, i, p + 3, q + 3);
#endif
        const auto light = hn::Add(wide, hn::Mul(hn::Set(d, lookups.share[i]), hn::Sub(narrow, wide)));
        hn::StoreU(hn::Min(light, hn::LoadU(d, sky.brightest)), d, rgbx);
    }
};

bool ShadeLobe(const LobeLookup& lobes, const ShadeSetup& setup, TexelLayout layout, const float* vismap, size_t texels,
               float* rgb)
{
    return Shade<LobeModel>(Light(lobes, setup), layout, vismap, texels, rgb);
}

#endif

} // namespace HWY_NAMESPACE
} // namespace vmlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vmlight {

HWY_EXPORT(ShadeLobe);

bool shade_lobe(const LobeLookup& lobes, const ShadeSetup& setup, TexelLayout layout, const float* vismap,
                size_t texels, float* rgb)
{
    return HWY_DYNAMIC_DISPATCH(ShadeLobe)(lobes, setup, layout, vismap, texels, rgb);
}

bool shade_lobe_scalar(const LobeLookup& lobes, const ShadeSetup& setup, TexelLayout layout, const float* vismap,
                       size_t texels, float* rgb)
{
    const float* r = setup.rotation;
    const float w = float(lobes.width), h = float(lobes.height);
    const float limit = largest_light(lobes, setup.gain);
    float brightest[3];
    for (int c = 0; c < 3; ++c)
        brightest[c] = brightest_light(lobes, setup.gain, c);
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
        const float length = m * std::sqrt(x * x + y * y + z * z);
        const float position = lobe_position(length / std::max(v, FLT_MIN));
        const int knot = std::min(int(position), kLobeKnots - 2);
        const float share = position - float(knot);

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

        const float total = std::max(light, 0.0f), lower = total * ft, upper = total - lower;
        const float w01 = upper * fu, w00 = upper - w01, w11 = lower * fu, w10 = lower - w11;
        const size_t row = size_t(knot) * size_t(lobes.height + 2) + size_t(it), pitch = size_t(lobes.pitch);
        const float* p = &lobes.texels[kLobeFloats * (row * pitch + size_t(iu))];
        const float* q = p + kLobeFloats * pitch;
        const auto bilinear
            = [&](int k) { return (w00 * p[k] + w01 * p[k + kLobeFloats]) + (w10 * q[k] + w11 * q[k + kLobeFloats]); };
        for (int c = 0; c < 3; ++c) {
            const float wide = bilinear(c), narrow = bilinear(c + 3);
            const float seen = wide + share * (narrow - wide);
            rgb[c] = seen < brightest[c] ? seen : brightest[c];
        }
    }
    return sound;
}

namespace {

struct LobeShader : ModelShader
{
    LobeLookup lobes;
    ShadeSetup setup;

    bool shade(TexelLayout layout, const float* vismap, size_t texels, float* rgb) const override
    {
        return shade_lobe(lobes, setup, layout, vismap, texels, rgb);
    }
};

} // namespace

std::vector<std::string> lobe_model_channels(const OIIO::ImageSpec& vismap)
{
    std::vector<std::string> names { kVismapChannels.begin(), kVismapChannels.end() };
    if (kernel_of(vismap) == kStrandKernel)
        names.insert(names.end(), kTangentChannels.begin(), kTangentChannels.end());
    return names;
}

std::unique_ptr<ModelShader> prepare_lobe(const ModelInput& input, std::string& error)
{
    if (kernel_of(input.light[0].spec()) == kStrandKernel)
        return prepare_strand_lobe(input, error);
    auto shader = std::make_unique<LobeShader>();
    shader->setup = input.setup;
    if (!prepare_lobes(shader->lobes, input.light, error))
        return nullptr;
    return shader;
}

} // namespace vmlight
#endif
