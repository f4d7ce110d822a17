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

// Angles and weights of Lanes(d) texels at once, then each texel's four neighbours by 128-bit loads: faster than
// gathers, which fetch a float at a time. Each store writes one float past its texel; the next one mends it.
template <class D> HWY_INLINE bool PaperGroup(D d, const ShadeSetup& setup, VismapOrder order, const float* vm, float* rgb)
{
    using V = hn::Vec<D>;
    const CfemLookup& cfem = *setup.cfem;
    const float* r = setup.rotation;

    V v, bx, by, bz;
    if (order == VismapOrder::visibility_first)
        hn::LoadInterleaved4(d, vm, v, bx, by, bz);
    else
        hn::LoadInterleaved4(d, vm, bx, by, bz, v);

    // x - x is 0 for finite x and NaN for others. A sum that overflows is a false alarm, which the caller sorts out.
    const V sum = hn::Add(hn::Add(bx, by), bz);
    const float limit = cfem.largest > 1 ? FLT_MAX / 2 / cfem.largest : FLT_MAX / 2;
    const V light = hn::Mul(v, hn::Set(d, setup.gain));
    const auto sound = hn::And(hn::Eq(hn::Sub(sum, sum), hn::Zero(d)), hn::Le(hn::Abs(light), hn::Set(d, limit)));

    // Scaled by the largest component, so that no square leaves float's range.
    const V m = hn::Max(hn::Max(hn::Abs(bx), hn::Abs(by)), hn::Abs(bz));
    const V scale = hn::Div(hn::Set(d, 1.0f), hn::Max(m, hn::Set(d, FLT_MIN)));
    const V x = hn::Mul(bx, scale), y = hn::Mul(by, scale), z = hn::Mul(bz, scale);
    const V ex = Dot(d, r, x, y, z), ey = Dot(d, r + 3, x, y, z), ez = Dot(d, r + 6, x, y, z);
    const V across = hn::Sqrt(hn::Add(hn::Mul(ex, ex), hn::Mul(ez, ez)));

    // Texels of the frame: its first column and row lie at -1, centres at halves, hence + 0.5.
    const float w = float(cfem.width), h = float(cfem.height);
    const V u = hn::Sub(hn::Set(d, 0.5f * w + 0.5f), hn::Mul(Atan2Turns(d, ex, ez), hn::Set(d, w)));
    V t = hn::Sub(hn::Set(d, 0.5f * h + 0.5f), hn::Mul(Atan2Turns(d, ey, across), hn::Set(d, 2 * h)));
    t = hn::Min(hn::Max(t, hn::Set(d, 0.5f)), hn::Set(d, h + 0.5f));

    // Clamped as whole numbers: whatever became of a NaN, the index is inside.
    const hn::RebindToSigned<D> di;
    const auto zero = hn::Zero(di);
    const auto iu = hn::Min(hn::Max(hn::ConvertTo(di, u), zero), hn::Set(di, cfem.width));
    const auto it = hn::Min(hn::Max(hn::ConvertTo(di, t), zero), hn::Set(di, cfem.height));
    const V fu = hn::Sub(u, hn::ConvertTo(d, iu)), ft = hn::Sub(t, hn::ConvertTo(d, it));

    const auto symmetric = hn::Lt(m, hn::Mul(v, hn::Set(d, kNoDirection)));
    auto at = hn::Add(hn::Mul(it, hn::Set(di, cfem.pitch)), iu);
    at = hn::IfThenElse(hn::RebindMask(di, symmetric), hn::Set(di, cfem.mean_texel()), at);

    const V total = hn::Max(light, hn::Zero(d));
    const V lower = hn::Mul(total, ft), upper = hn::Sub(total, lower);
    const V w01 = hn::Mul(upper, fu), w11 = hn::Mul(lower, fu);

    constexpr size_t kMax = hn::MaxLanes(d);
    HWY_ALIGN int32_t texel[kMax];
    HWY_ALIGN float weights[4][kMax];
    hn::Store(at, di, texel);
    hn::Store(hn::Sub(upper, w01), d, weights[0]);
    hn::Store(w01, d, weights[1]);
    hn::Store(hn::Sub(lower, w11), d, weights[2]);
    hn::Store(w11, d, weights[3]);

    const hn::FixedTag<float, 4> d4;
    const size_t below = 4 * size_t(cfem.pitch);
    for (size_t i = 0; i < hn::Lanes(d); ++i) {
        const float* p = cfem.texels.data() + 4 * size_t(texel[i]);
        const auto up = hn::Add(hn::Mul(hn::Set(d4, weights[0][i]), hn::LoadU(d4, p)),
                                hn::Mul(hn::Set(d4, weights[1][i]), hn::LoadU(d4, p + 4)));
        const auto down = hn::Add(hn::Mul(hn::Set(d4, weights[2][i]), hn::LoadU(d4, p + below)),
                                  hn::Mul(hn::Set(d4, weights[3][i]), hn::LoadU(d4, p + below + 4)));
        hn::StoreU(hn::Add(up, down), d4, rgb + 3 * i);
    }
    return hn::AllTrue(d, sound);
}

bool ShadePaper(const ShadeSetup& setup, VismapOrder order, const float* vismap, size_t texels, float* rgb)
{
    const hn::ScalableTag<float> d;
    const size_t lanes = hn::Lanes(d);
    bool sound = true;
    size_t done = 0;
    // Less than, not up to: the float past a group must be one of ours.
    for (; done + lanes < texels; done += lanes)
        sound &= PaperGroup(d, setup, order, vismap + 4 * done, rgb + 3 * done);

    HWY_ALIGN float in[4 * hn::MaxLanes(d)] = {};
    HWY_ALIGN float out[3 * hn::MaxLanes(d) + 1];
    std::memcpy(in, vismap + 4 * done, 4 * (texels - done) * sizeof(float));
    sound &= PaperGroup(d, setup, order, in, out);
    std::memcpy(rgb + 3 * done, out, 3 * (texels - done) * sizeof(float));
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
    const float limit = cfem.largest > 1 ? FLT_MAX / 2 / cfem.largest : FLT_MAX / 2;
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
