// SPDX-License-Identifier: Apache-2.0
// Steps that the vector forms of several models share. Highway includes this anew for each instruction set.
#if defined(VMLIGHT_LOOKUP_VECTORS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VMLIGHT_LOOKUP_VECTORS_INL_H
#undef VMLIGHT_LOOKUP_VECTORS_INL_H
#else
#define VMLIGHT_LOOKUP_VECTORS_INL_H
#endif

#include <vmlight/lightmap/lobe_lookup.h>
#include <vmlight/lightmap/lookup_kernel.h>

#include <hwy/highway.h>

#include <algorithm>
#include <cfloat>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace vmlight {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR

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

// What a group of texels reads of its setup, as values on the stack: stores of colour may alias anything behind a
// pointer, so that the compiler would load it again for every texel.
struct Light
{
    template <class Lookup>
    Light(const Lookup& lookup, const ShadeSetup& setup)
        : texels(lookup.texels.data())
        , width(lookup.width)
        , height(lookup.height)
        , pitch(lookup.pitch)
        , gain(setup.gain)
        , limit(largest_light(lookup, setup.gain))
    {
        std::copy_n(setup.rotation, 9, rotation);
        for (int c = 0; c < 4; ++c)
            brightest[c] = brightest_light(lookup, setup.gain, c);
    }

    const float* texels;
    int width, height, pitch;
    float rotation[9], gain, limit, brightest[4];
};

// Where the texels of a block look, and with what weights: filled by vectors of texels, then used texel by texel. Two
// loops, not one: a group of texels is one long dependency chain, which hides its latency only when several groups are
// in flight, and lookups in between would prevent that.
struct Lookups
{
    static constexpr size_t kTexels = 256;
    HWY_ALIGN int32_t place[kTexels];
    HWY_ALIGN float weights[4][kTexels];
    HWY_ALIGN float share[kTexels]; // of the narrower lobe
};

// lobe_position() of lanes.
template <class D, class V = hn::Vec<D>> HWY_INLINE V LobePosition(D d, V r)
{
    const hn::RebindToSigned<D> di;
    const V one = hn::Set(d, 1.0f), two = hn::Set(d, 2.0f), step = hn::Set(d, kKnotStep);
    r = hn::Min(hn::Max(r, hn::Zero(d)), hn::Set(d, kLargestLobe));
    const V wide = hn::Max(hn::Mul(r, two), hn::Sub(hn::Mul(r, hn::Set(d, 6.0f)), two));
    const V spread = hn::Sqrt(hn::Sub(one, r)), widest = hn::Set(d, kCfemSpread);
    const auto knot = hn::Min(hn::ConvertTo(di, hn::Mul(hn::Sub(widest, spread), hn::Set(d, 1 / kKnotStep))),
                              hn::Set(di, kLobeKnots - 2 - kCfemKnot));
    const V left = hn::Sub(widest, hn::Mul(hn::ConvertTo(d, knot), step));
    const V share = hn::Div(hn::Mul(hn::Sub(left, spread), hn::Add(left, spread)),
                            hn::Mul(step, hn::Sub(hn::Add(left, left), step)));
    const V narrow
        = hn::Add(hn::ConvertTo(d, hn::Add(knot, hn::Set(di, kCfemKnot))), hn::Min(hn::Max(share, hn::Zero(d)), one));
    return hn::IfThenElse(hn::Gt(r, hn::Set(d, 2.0f / 3)), narrow, wide);
}

// Lanes(d) texels of `vm`, to `dst` from `at` on. Places are texels of a CFEM, or floats of a stack of lobes.
template <class Model, class D>
HWY_INLINE bool Aim(D d, const Light& sky, TexelLayout layout, const float* vm, Lookups& dst, size_t at)
{
    using V = hn::Vec<D>;
    const float* r = sky.rotation;

    V v, bx, by, bz;
    if (layout == TexelLayout::visibility_first)
        hn::LoadInterleaved4(d, vm, v, bx, by, bz);
    else
        hn::LoadInterleaved4(d, vm, bx, by, bz, v);

    // x - x is 0 for finite x and NaN for others. A sum that overflows is a false alarm, which the caller sorts out.
    const V sum = hn::Add(hn::Add(bx, by), bz);
    const V light = hn::Mul(v, hn::Set(d, sky.gain));
    const auto sound = hn::And(hn::Eq(hn::Sub(sum, sum), hn::Zero(d)), hn::Le(hn::Abs(light), hn::Set(d, sky.limit)));

    // Scaled by the largest component, so that no square leaves float's range.
    const V m = hn::Max(hn::Max(hn::Abs(bx), hn::Abs(by)), hn::Abs(bz));
    const V scale = hn::Div(hn::Set(d, 1.0f), hn::Max(m, hn::Set(d, FLT_MIN)));
    const V x = hn::Mul(bx, scale), y = hn::Mul(by, scale), z = hn::Mul(bz, scale);
    const V ex = Dot(d, r, x, y, z), ey = Dot(d, r + 3, x, y, z), ez = Dot(d, r + 6, x, y, z);
    const V across = hn::Sqrt(hn::Add(hn::Mul(ex, ex), hn::Mul(ez, ez)));

    // Texels of the frame: its first column and row lie at -1, centres at halves, hence + 0.5.
    const float w = float(sky.width), h = float(sky.height);
    const V u = hn::Sub(hn::Set(d, 0.5f * w + 0.5f), hn::Mul(Atan2Turns(d, ex, ez), hn::Set(d, w)));
    V t = hn::Sub(hn::Set(d, 0.5f * h + 0.5f), hn::Mul(Atan2Turns(d, ey, across), hn::Set(d, 2 * h)));
    t = hn::Min(hn::Max(t, hn::Set(d, 0.5f)), hn::Set(d, h + 0.5f));

    // Clamped as whole numbers: whatever became of a NaN, the index is inside.
    const hn::RebindToSigned<D> di;
    const auto zero = hn::Zero(di);
    const auto iu = hn::Min(hn::Max(hn::ConvertTo(di, u), zero), hn::Set(di, sky.width));
    const auto it = hn::Min(hn::Max(hn::ConvertTo(di, t), zero), hn::Set(di, sky.height));
    const V fu = hn::Sub(u, hn::ConvertTo(d, iu)), ft = hn::Sub(t, hn::ConvertTo(d, it));

    auto place = hn::Add(hn::Mul(it, hn::Set(di, sky.pitch)), iu);
    if (Model::kLobe) {
        const V length = hn::Mul(m, hn::Sqrt(hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z))));
        const V position = LobePosition(d, hn::Div(length, hn::Max(v, hn::Set(d, FLT_MIN))));
        const auto knot = hn::Min(hn::Max(hn::ConvertTo(di, position), zero), hn::Set(di, kLobeKnots - 2));
        place = hn::Add(place, hn::Mul(knot, hn::Set(di, (sky.height + 2) * sky.pitch)));
        place = hn::Mul(place, hn::Set(di, kLobeFloats));
        hn::Store(hn::Sub(position, hn::ConvertTo(d, knot)), d, dst.share + at);
    } else {
        const auto symmetric = hn::Lt(m, hn::Mul(v, hn::Set(d, kNoDirection)));
        const auto mean = hn::Set(di, (sky.height + 2) * sky.pitch);
        place = hn::IfThenElse(hn::RebindMask(di, symmetric), mean, place);
    }
    hn::Store(place, di, dst.place + at);

    const V total = hn::Max(light, hn::Zero(d));
    const V lower = hn::Mul(total, ft), upper = hn::Sub(total, lower);
    const V w01 = hn::Mul(upper, fu), w11 = hn::Mul(lower, fu);

    hn::Store(hn::Sub(upper, w01), d, dst.weights[0] + at);
    hn::Store(w01, d, dst.weights[1] + at);
    hn::Store(hn::Sub(lower, w11), d, dst.weights[2] + at);
    hn::Store(w11, d, dst.weights[3] + at);
    return hn::AllTrue(d, sound);
}

// Shade a run of texels. `Model` looks up one texel of a block.
template <class Model>
HWY_INLINE bool Shade(const Light& sky, TexelLayout layout, const float* vismap, size_t texels, float* rgb)
{
    const hn::CappedTag<float, 64> d;
    const size_t lanes = hn::Lanes(d);
    Lookups lookups;
    HWY_ALIGN float rest[4 * hn::MaxLanes(d)] = {};
    bool sound = true;
    for (size_t begin = 0; begin < texels; begin += Lookups::kTexels) {
        const size_t count = std::min(texels - begin, Lookups::kTexels);
        const float* vm = vismap + 4 * begin;
        size_t at = 0;
        for (; at + lanes <= count; at += lanes)
            sound &= Aim<Model>(d, sky, layout, vm + 4 * at, lookups, at);
        if (at < count) {
            std::memcpy(rest, vm + 4 * at, 4 * (count - at) * sizeof(float));
            sound &= Aim<Model>(d, sky, layout, rest, lookups, at);
        }
        // Each store writes one float past its texel, which the next one overwrites; the last of all must not.
        const bool last = begin + count == texels;
        for (size_t i = 0; i < count - last; ++i)
            Model::LookUp(sky, lookups, i, rgb + 3 * (begin + i));
        if (last) {
            float rgbx[4];
            Model::LookUp(sky, lookups, count - 1, rgbx);
            std::copy_n(rgbx, 3, rgb + 3 * (texels - 1));
        }
    }
    return sound;
}

#endif

} // namespace HWY_NAMESPACE
} // namespace vmlight
HWY_AFTER_NAMESPACE();

#endif
