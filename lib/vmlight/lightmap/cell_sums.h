// SPDX-License-Identifier: Apache-2.0
/// What the models `mask` and `cells` share: gain V times the mean of the visible light,
///     mean + (n . sum_k f_k Int_k (L - mean) w dw) / (n . sum_k f_k Int_k w dw),
/// where k runs over the visible intervals of columns, or over cells (packed_visibility.h), and f is how much of each
/// is visible. As a ratio, so that V, the most accurate number of a texel, sets how much light there is, and the rest
/// only where it comes from. Cells reach across the horizon, where n.w < 0: where the mean of n.w over the visible part
/// is below 0.2, the weight blends into n.w + 1, so that it never vanishes. The result stays between V times the least
/// and V times the most of the environment, and below the brightest point of the CFEM. 0 where V <= 0.
///
/// A texel is V, B, n and the packed numbers, in this order; one that is not whole, or not in [0, 2^24), counts as 0
/// and makes the result false.
#pragma once

#include <vmlight/lightmap/brightest_light.h>
#include <vmlight/lightmap/cell_light.h>
#include <vmlight/lightmap/model_shader.h>
#include <vmlight/math/float4.h>
#include <vmlight/math/packed_visibility.h>

#include <cmath>

namespace vmlight {

constexpr float kLeastCosine = 0.2f;
constexpr int kBeforePacked = 7; // floats of V, B and n, before the packed numbers

// R, G, B and the weight: times w along each axis, and unweighted.
struct CellSums
{
    Float4 x {}, y {}, z {}, plain {};

    void add(const float* moments)
    {
        x += load_float4(moments);
        y += load_float4(moments + 4);
        z += load_float4(moments + 8);
        plain += load_float4(moments + 12);
    }
    void add_between(const float* low, const float* high, float share)
    {
        const Float4 f = splat_float4(share);
        x += f * (load_float4(high) - load_float4(low));
        y += f * (load_float4(high + 4) - load_float4(low + 4));
        z += f * (load_float4(high + 8) - load_float4(low + 8));
        plain += f * (load_float4(high + 12) - load_float4(low + 12));
    }
};

template <int kCount> bool whole_numbers(const float* packed, uint32_t* codes)
{
    bool sound = true;
    for (int i = 0; i < kCount; ++i) {
        const bool fits = packed[i] >= 0 && packed[i] < 0x1p24f;
        codes[i] = fits ? uint32_t(packed[i]) : 0;
        sound &= fits && float(codes[i]) == packed[i];
    }
    return sound;
}

// Light of a texel of visibility `v`: the mean of `sums`, weighted by n.w as far as that can be trusted.
inline bool light_of(const CellLight& light, const ShadeSetup& setup, const CellSums& sums, const float* n, float v,
                     float* rgb)
{
    const float size = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), unit = size > 0 ? 1 / size : 0.0f;
    const float angle = sums.plain[3];
    const Float4 along
        = splat_float4(n[0] * unit) * sums.x + splat_float4(n[1] * unit) * sums.y + splat_float4(n[2] * unit) * sums.z;
    // Across the horizon n.w is negative: where little weight is left, n.w blends into n.w + 1, which never is.
    const float cosine = angle > 0 ? along[3] / angle : 0.0f;
    const float even = cosine < kLeastCosine ? (kLeastCosine - cosine) * (1 / kLeastCosine) : 0.0f;
    const Float4 weighted = along + splat_float4(even) * sums.plain;
    const float gain = v * setup.gain, share = weighted[3] > 0 ? 1 / weighted[3] : 0.0f;
    bool sound = std::abs(v) <= kLargestVisibility && std::isfinite(size);
    for (int c = 0; c < 3; ++c) {
        const float mean = light.mean[c] + weighted[c] * share;
        // A mean stays within its values. One that is not finite stays, to be reported.
        const float within = mean < light.least[c] ? light.least[c] : mean > light.most[c] ? light.most[c] : mean;
        const float color = gain * within;
        sound &= std::isfinite(color);
        rgb[c] = gain > 0 || !(gain == gain) ? held_to(light.brightest[c], setup.gain, color) : 0.0f;
    }
    return sound;
}

template <int kFloats, class Add>
bool shade_cell_sums(const CellLight& light, const ShadeSetup& setup, const float* vismap, size_t texels, float* rgb,
                     const Add& add)
{
    bool sound = true;
    for (size_t i = 0; i < texels; ++i, vismap += kBeforePacked + kFloats, rgb += 3) {
        uint32_t codes[kFloats];
        sound &= whole_numbers<kFloats>(vismap + kBeforePacked, codes);
        CellSums sums;
        add(sums, codes);
        sound &= light_of(light, setup, sums, vismap + 4, vismap[0], rgb);
    }
    return sound;
}

} // namespace vmlight
