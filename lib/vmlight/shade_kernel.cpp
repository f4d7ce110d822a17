// SPDX-License-Identifier: Apache-2.0
#include <vmlight/shade_kernel.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vmlight/shade_kernel.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for each instruction set.
#include <hwy/highway.h>

#include <algorithm>
#include <cfloat>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace vmlight {
namespace HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR

// A processor without vectors, as Highway sees it: SSE2 alone is one.
bool ShadePaper(const ShadeSetup& setup, VismapOrder order, const float* vismap, size_t texels, float* rgb)
{
    return shade_paper_scalar(setup, order, vismap, texels, rgb);
}

#else

namespace hn = hwy::HWY_NAMESPACE;

template <class D, class V = hn::Vec<D>> HWY_INLINE V Atan2Turns(D d, V y, V x)
{
    const V ax = hn::Abs(x), ay = hn::Abs(y);
    const V a = hn::Div(hn::Min(ax, ay), hn::Max(hn::Max(ax, ay), hn::Set(d, FLT_MIN)));
    const V s = hn::Mul(a, a);
    V r = hn::Set(d, kAtanTurns[7]);
    for (int i = 6; i >= 0; --i)
        r = hn::Add(hn::Mul(r, s), hn::Set(d, kAtanTurns[i]));
    r = hn::Mul(r, a);
    r = hn::IfThenElse(hn::Gt(ay, ax), hn::Sub(hn::Set(d, 0.25f), r), r);
    r = hn::IfThenElse(hn::Lt(x, hn::Zero(d)), hn::Sub(hn::Set(d, 0.5f), r), r);
    return hn::CopySign(r, y);
}

template <class D, class V = hn::Vec<D>> HWY_INLINE V Dot(D d, const float* row, V x, V y, V z)
{
    return hn::Add(hn::Add(hn::Mul(hn::Set(d, row[0]), x), hn::Mul(hn::Set(d, row[1]), y)),
                   hn::Mul(hn::Set(d, row[2]), z));
}

// What a group needs of its setup, as values on the stack: stores of colour may alias anything behind a pointer, and
// what lies there would be loaded again for every texel.
struct Paper
{
    explicit Paper(const ShadeSetup& setup)
        : texels(setup.cfem->texels.data())
        , width(setup.cfem->width)
        , height(setup.cfem->height)
        , pitch(setup.cfem->pitch)
        , mean_texel(setup.cfem->mean_texel())
        , gain(setup.gain)
        , limit(largest_light(*setup.cfem))
    {
        std::copy_n(setup.rotation, 9, rotation);
    }

    const float* texels;
    int width, height, pitch, mean_texel;
    float rotation[9], gain, limit;
};

// Where a block's texels look and with what weights: filled by vectors of texels, then used texel by texel. Two loops
// and not one, since a group of texels is one long chain of operations: only when several groups are under way at once
// does the processor keep busy, and the lookups would stand between them.
struct Lookups
{
    static constexpr size_t kTexels = 256;
    HWY_ALIGN int32_t texel[kTexels];
    HWY_ALIGN float weights[4][kTexels];
};

// Lanes(d) texels of `vm`, to `dst` from `at` on.
template <class D>
HWY_INLINE bool Aim(D d, const Paper& paper, VismapOrder order, const float* vm, Lookups& dst, size_t at)
{
    using V = hn::Vec<D>;
    const float* r = paper.rotation;

    V v, bx, by, bz;
    if (order == VismapOrder::visibility_first)
        hn::LoadInterleaved4(d, vm, v, bx, by, bz);
    else
        hn::LoadInterleaved4(d, vm, bx, by, bz, v);

    // x - x is 0 for finite x and NaN for others. A sum that overflows is a false alarm, which the caller sorts out.
    const V sum = hn::Add(hn::Add(bx, by), bz);
    const V light = hn::Mul(v, hn::Set(d, paper.gain));
    const auto sound = hn::And(hn::Eq(hn::Sub(sum, sum), hn::Zero(d)), hn::Le(hn::Abs(light), hn::Set(d, paper.limit)));

    // Scaled by the largest component, so that no square leaves float's range.
    const V m = hn::Max(hn::Max(hn::Abs(bx), hn::Abs(by)), hn::Abs(bz));
    const V scale = hn::Div(hn::Set(d, 1.0f), hn::Max(m, hn::Set(d, FLT_MIN)));
    const V x = hn::Mul(bx, scale), y = hn::Mul(by, scale), z = hn::Mul(bz, scale);
    const V ex = Dot(d, r, x, y, z), ey = Dot(d, r + 3, x, y, z), ez = Dot(d, r + 6, x, y, z);
    const V across = hn::Sqrt(hn::Add(hn::Mul(ex, ex), hn::Mul(ez, ez)));

    // Texels of the frame: its first column and row lie at -1, centres at halves, hence + 0.5.
    const float w = float(paper.width), h = float(paper.height);
    const V u = hn::Sub(hn::Set(d, 0.5f * w + 0.5f), hn::Mul(Atan2Turns(d, ex, ez), hn::Set(d, w)));
    V t = hn::Sub(hn::Set(d, 0.5f * h + 0.5f), hn::Mul(Atan2Turns(d, ey, across), hn::Set(d, 2 * h)));
    t = hn::Min(hn::Max(t, hn::Set(d, 0.5f)), hn::Set(d, h + 0.5f));

    // Clamped as whole numbers: whatever became of a NaN, the index is inside.
    const hn::RebindToSigned<D> di;
    const auto zero = hn::Zero(di);
    const auto iu = hn::Min(hn::Max(hn::ConvertTo(di, u), zero), hn::Set(di, paper.width));
    const auto it = hn::Min(hn::Max(hn::ConvertTo(di, t), zero), hn::Set(di, paper.height));
    const V fu = hn::Sub(u, hn::ConvertTo(d, iu)), ft = hn::Sub(t, hn::ConvertTo(d, it));

    const auto symmetric = hn::Lt(m, hn::Mul(v, hn::Set(d, kNoDirection)));
    const auto texel = hn::Add(hn::Mul(it, hn::Set(di, paper.pitch)), iu);
    const auto mean = hn::Set(di, paper.mean_texel);

    const V total = hn::Max(light, hn::Zero(d));
    const V lower = hn::Mul(total, ft), upper = hn::Sub(total, lower);
    const V w01 = hn::Mul(upper, fu), w11 = hn::Mul(lower, fu);

    hn::Store(hn::IfThenElse(hn::RebindMask(di, symmetric), mean, texel), di, dst.texel + at);
    hn::Store(hn::Sub(upper, w01), d, dst.weights[0] + at);
    hn::Store(w01, d, dst.weights[1] + at);
    hn::Store(hn::Sub(lower, w11), d, dst.weights[2] + at);
    hn::Store(w11, d, dst.weights[3] + at);
    return hn::AllTrue(d, sound);
}

// Four neighbours, each by one 128-bit load: faster than gathers, which fetch a float at a time.
HWY_INLINE void LookUp(const Paper& paper, const Lookups& lookups, size_t i, float* rgbx)
{
    const hn::FixedTag<float, 4> d;
    const float* p = paper.texels + 4 * size_t(lookups.texel[i]);
    const float* q = p + 4 * size_t(paper.pitch);
    const auto up = hn::Add(hn::Mul(hn::Set(d, lookups.weights[0][i]), hn::LoadU(d, p)),
                            hn::Mul(hn::Set(d, lookups.weights[1][i]), hn::LoadU(d, p + 4)));
    const auto down = hn::Add(hn::Mul(hn::Set(d, lookups.weights[2][i]), hn::LoadU(d, q)),
                              hn::Mul(hn::Set(d, lookups.weights[3][i]), hn::LoadU(d, q + 4)));
    hn::StoreU(hn::Add(up, down), d, rgbx);
}

bool ShadePaper(const ShadeSetup& setup, VismapOrder order, const float* vismap, size_t texels, float* rgb)
{
    const hn::CappedTag<float, 64> d;
    const size_t lanes = hn::Lanes(d);
    const Paper paper(setup);
    Lookups lookups;
    HWY_ALIGN float rest[4 * hn::MaxLanes(d)] = {};
    bool sound = true;
    for (size_t begin = 0; begin < texels; begin += Lookups::kTexels) {
        const size_t count = std::min(texels - begin, Lookups::kTexels);
        const float* vm = vismap + 4 * begin;
        size_t at = 0;
        for (; at + lanes <= count; at += lanes)
            sound &= Aim(d, paper, order, vm + 4 * at, lookups, at);
        if (at < count) {
            std::memcpy(rest, vm + 4 * at, 4 * (count - at) * sizeof(float));
            sound &= Aim(d, paper, order, rest, lookups, at);
        }
        // Each store writes one float past its texel, which the next one mends; the last of all must not.
        const bool last = begin + count == texels;
        for (size_t i = 0; i < count - last; ++i)
            LookUp(paper, lookups, i, rgb + 3 * (begin + i));
        if (last) {
            float rgbx[4];
            LookUp(paper, lookups, count - 1, rgbx);
            std::copy_n(rgbx, 3, rgb + 3 * (texels - 1));
        }
    }
    return sound;
}

#endif

} // namespace HWY_NAMESPACE
} // namespace vmlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vmlight {

HWY_EXPORT(ShadePaper);

bool shade_paper(const ShadeSetup& setup, VismapOrder order, const float* vismap, size_t texels, float* rgb)
{
    return HWY_DYNAMIC_DISPATCH(ShadePaper)(setup, order, vismap, texels, rgb);
}

bool shade_paper_scalar(const ShadeSetup& setup, VismapOrder order, const float* vismap, size_t texels, float* rgb)
{
    const CfemLookup& cfem = *setup.cfem;
    const float* r = setup.rotation;
    const float w = float(cfem.width), h = float(cfem.height);
    const float limit = largest_light(cfem);
    bool sound = true;
    for (size_t i = 0; i < texels; ++i, vismap += 4, rgb += 3) {
        const bool first = order == VismapOrder::visibility_first;
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

} // namespace vmlight
#endif
