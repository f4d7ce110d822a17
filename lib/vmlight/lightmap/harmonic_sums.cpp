// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/harmonic_sums.h>

#include <vmlight/lightmap/brightest_light.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vmlight/lightmap/harmonic_sums.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for each instruction set.
#include <hwy/highway.h>

#include <algorithm>
#include <cfloat>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace vmlight {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_MAX_BYTES >= 32 && !HWY_HAVE_SCALABLE
using Lanes = hn::FixedTag<float, 8>;
#else
using Lanes = hn::FixedTag<float, 4>;
#endif
using Sums = hn::Vec<Lanes>;

// Four floats of the texel in each block of lanes.
HWY_INLINE Sums LoadRows(const float* texel, [[maybe_unused]] size_t stride)
{
    const hn::FixedTag<float, 4> four;
#if HWY_MAX_BYTES >= 32 && !HWY_HAVE_SCALABLE
    return hn::Combine(Lanes(), hn::LoadU(four, texel + 4 * stride), hn::LoadU(four, texel));
#else
    return hn::LoadU(four, texel);
#endif
}

// A texel in each lane. Whether all are sound.
HWY_INLINE bool ShadeLanes(const HarmonicLight& light, float gain, const float* vismap, float* rgb)
{
    using V = Sums;
    const Lanes d;
    const auto count = size_t(light.count);
    const float* coefficients = light.coefficients.data();
    V even[3] = { hn::Zero(d), hn::Zero(d), hn::Zero(d) }, odd[3] = { hn::Zero(d), hn::Zero(d), hn::Zero(d) };
    const auto add = [&](V* sums, V number, size_t k) HWY_ATTR {
        for (size_t c = 0; c < 3; ++c)
            sums[c] = hn::Add(sums[c], hn::Mul(number, hn::Set(d, coefficients[4 * k + c])));
    };
    size_t k = 0;
    V visibility = hn::Zero(d);
    for (; k + 4 <= count; k += 4) { // four numbers of each texel, transposed
        const float* const at = vismap + k;
        const V a = LoadRows(at, count), b = LoadRows(at + count, count), c = LoadRows(at + 2 * count, count),
                e = LoadRows(at + 3 * count, count);
        const V low_even = hn::InterleaveLower(d, a, c), low_odd = hn::InterleaveLower(d, b, e),
                high_even = hn::InterleaveUpper(d, a, c), high_odd = hn::InterleaveUpper(d, b, e);
        const V first = hn::InterleaveLower(d, low_even, low_odd);
        if (k == 0)
            visibility = first;
        add(even, first, k);
        add(odd, hn::InterleaveUpper(d, low_even, low_odd), k + 1);
        add(even, hn::InterleaveLower(d, high_even, high_odd), k + 2);
        add(odd, hn::InterleaveUpper(d, high_even, high_odd), k + 3);
    }
    for (; k < count; ++k) {
        HWY_ALIGN float numbers[8];
        for (size_t i = 0; i < hn::Lanes(d); ++i)
            numbers[i] = vismap[i * count + k];
        add(k % 2 ? odd : even, hn::Load(d, numbers), k);
    }
    auto sound = hn::Le(hn::Abs(visibility), hn::Set(d, kLargestVisibility));
    V colors[3];
    for (int c = 0; c < 3; ++c) {
        const V sum = hn::Mul(hn::Set(d, gain), hn::Add(even[c], odd[c]));
        const auto finite = hn::Le(hn::Abs(sum), hn::Set(d, FLT_MAX));
        sound = hn::And(sound, finite);
        const V most = hn::Set(d, light.brightest[c] * gain * kAboveRounding);
        const V held = hn::IfThenElse(hn::And(finite, hn::Gt(sum, most)), most, sum);
        const auto dark = hn::Or(hn::Not(hn::Gt(visibility, hn::Zero(d))), hn::And(finite, hn::Lt(sum, hn::Zero(d))));
        colors[c] = hn::IfThenZeroElse(dark, held);
    }
    hn::StoreInterleaved3(colors[0], colors[1], colors[2], d, rgb);
    return hn::AllTrue(d, sound);
}

#endif

bool ShadeHarmonics(const HarmonicLight& light, const ShadeSetup& setup, const float* vismap, size_t texels, float* rgb)
{
    bool sound = true;
    size_t i = 0;
#if HWY_TARGET != HWY_SCALAR
    const size_t lanes = hn::Lanes(Lanes());
    for (; i + lanes <= texels; i += lanes)
        sound &= ShadeLanes(light, setup.gain, vismap + i * size_t(light.count), rgb + 3 * i);
#endif
    return shade_harmonics_scalar(light, setup, vismap + i * size_t(light.count), texels - i, rgb + 3 * i) && sound;
}

} // namespace HWY_NAMESPACE
} // namespace vmlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vmlight {

HWY_EXPORT(ShadeHarmonics);

bool shade_harmonics(const HarmonicLight& light, const ShadeSetup& setup, const float* vismap, size_t texels,
                     float* rgb)
{
    return HWY_DYNAMIC_DISPATCH(ShadeHarmonics)(light, setup, vismap, texels, rgb);
}

bool shade_harmonics_scalar(const HarmonicLight& light, const ShadeSetup& setup, const float* vismap, size_t texels,
                            float* rgb)
{
    const int count = light.count;
    bool sound = true;
    for (size_t i = 0; i < texels; ++i, vismap += count, rgb += 3) {
        sound &= std::abs(vismap[0]) <= kLargestVisibility;
        for (size_t c = 0; c < 3; ++c) {
            float sums[2] = { 0, 0 };
            for (int k = 0; k < count; ++k)
                sums[k % 2] += vismap[k] * light.coefficients[size_t(4 * k) + c];
            const float sum = setup.gain * (sums[0] + sums[1]);
            sound &= std::isfinite(sum);
            // A texel that sees nothing has no light, whatever rounding left of its harmonics. A value that is not
            // finite stays, to be reported.
            rgb[c] = !(vismap[0] > 0) || (sum < 0 && std::isfinite(sum)) ? 0.0f
                                                                         : held_to(light.brightest[c], setup.gain, sum);
        }
    }
    return sound;
}

} // namespace vmlight
#endif
