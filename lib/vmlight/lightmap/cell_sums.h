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
///
/// Here are the scalar forms, which define the models, and what the vector forms (cell_vectors-inl.h) share with them.
#pragma once

#include <vmlight/lightmap/brightest_light.h>
#include <vmlight/lightmap/cell_light.h>
#include <vmlight/lightmap/model_shader.h>
#include <vmlight/math/latlong.h>
#include <vmlight/math/packed_visibility.h>

#include <cmath>

namespace vmlight {

constexpr float kLeastCosine = 0.2f;
constexpr int kBeforePacked = 7; // floats of V, B and n, before the packed numbers

// What a texel sees: sums of moments, and the solid angle in units of `kAngle`.
struct CellSums
{
    int64_t lanes[kMomentLanes] = { 0, 0, 0, 0 };
    int32_t angle = 0;

    void add(const PackedMoments& moments)
    {
        for (int lane = 0; lane < kMomentLanes; ++lane)
            lanes[lane] += moments.lanes[lane];
    }
    void subtract(const PackedMoments& moments)
    {
        for (int lane = 0; lane < kMomentLanes; ++lane)
            lanes[lane] -= moments.lanes[lane];
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

struct MaskCodes
{
    static constexpr int kFloats = kMaskFloats;
    static constexpr float kAngle = float(4 * latlong::pi / (direction_grid::kColumns * direction_grid::kSlices));

    static void sum(const CellLight& light, const uint32_t* codes, CellSums& sums)
    {
        for (int column = 0; column < direction_grid::kColumns; ++column) {
            const MaskColumn view = unpack_mask(codes, column);
            const PackedMoments* part = &light.moments[size_t(column) * kMaskStride];
            sums.add(part[view.high << 4 | view.density]);
            sums.subtract(part[view.low << 4 | view.density]);
            sums.angle += (view.high - view.low) * view.density;
        }
    }

    // R, G, B of the moments without w.
    static void sum_plain(const CellLight& light, const uint32_t* codes, float* rgb)
    {
        constexpr int kEdges = direction_grid::kSlices + 1;
        for (int column = 0; column < direction_grid::kColumns; ++column) {
            const MaskColumn view = unpack_mask(codes, column);
            const float* edges = &light.plain[size_t(column * kEdges * 4)];
            for (int c = 0; c < 3; ++c)
                rgb[c] += float(view.density) * (edges[4 * view.high + c] - edges[4 * view.low + c]);
        }
    }
};

struct CellsCodes
{
    static constexpr int kFloats = kCellsFloats;
    static constexpr float kAngle = float(4 * latlong::pi / direction_grid::kCells);

    static void sum(const CellLight& light, const uint32_t* codes, CellSums& sums)
    {
        for (int part = 0; part < kCellsParts; ++part) {
            const uint32_t code = codes[part / 3] >> (16 - part % 3 * 8) & 255;
            sums.add(light.moments[size_t(part) * kCellsStride + code]);
            sums.angle += int32_t((code & 3) + (code >> 2 & 3) + (code >> 4 & 3) + (code >> 6));
        }
    }

    static void sum_plain(const CellLight& light, const uint32_t* codes, float* rgb)
    {
        const float* part = light.plain.data();
        for (int i = 0; i < kCellsFloats; ++i)
            for (int shift = 18; shift >= 0; shift -= 6, part += 4 * kTripleCodes)
                if (const uint32_t code = codes[i] >> shift & 63)
                    for (uint32_t c = 0; c < 3; ++c)
                        rgb[c] += part[4 * code + c];
    }
};

// Light of one texel.
template <class Codes>
bool shade_cell_texel(const CellLight& light, const ShadeSetup& setup, const float* vismap, float* rgb)
{
    uint32_t codes[Codes::kFloats];
    bool sound = whole_numbers<Codes::kFloats>(vismap + kBeforePacked, codes);
    CellSums sums;
    Codes::sum(light, codes, sums);
    const float *n = vismap + 4, v = vismap[0];
    const float size = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), unit = size > 0 ? 1 / size : 0.0f;
    float along[kMomentLanes]; // n
    for (int lane = 0; lane < kMomentLanes; ++lane) {
        const auto part = [&](int axis) { return unpack_moment(sums.lanes[lane], axis) * (n[axis] * unit); };
        along[lane] = ((part(0) + part(2)) + part(1)) * light.unit[lane];
    }
    // Across the horizon n.w is negative: where little weight is left, n.w blends into n.w + 1, which never is.
    const float angle = float(sums.angle) * Codes::kAngle, cosine = angle > 0 ? along[3] / angle : 0.0f;
    const float even = cosine < kLeastCosine ? (kLeastCosine - cosine) * (1 / kLeastCosine) : 0.0f;
    float plain[3] = { 0, 0, 0 };
    if (even > 0)
        Codes::sum_plain(light, codes, plain);
    const float gain = v * setup.gain, weight = along[3] + even * angle, share = weight > 0 ? 1 / weight : 0.0f;
    sound &= std::abs(v) <= kLargestVisibility && std::isfinite(size);
    for (int c = 0; c < 3; ++c) {
        const float mean = light.mean[c] + (along[c] + even * plain[c]) * share;
        // A mean stays within its values. One that is not finite stays, to be reported.
        const float within = mean < light.least[c] ? light.least[c] : mean > light.most[c] ? light.most[c] : mean;
        const float color = gain * within;
        sound &= std::isfinite(color);
        rgb[c] = gain > 0 || !(gain == gain) ? held_to(light.brightest[c], setup.gain, color) : 0.0f;
    }
    return sound;
}

template <class Codes>
bool shade_cells_one_by_one(const CellLight& light, const ShadeSetup& setup, const float* vismap, size_t texels,
                            float* rgb)
{
    bool sound = true;
    for (size_t i = 0; i < texels; ++i, vismap += kBeforePacked + Codes::kFloats, rgb += 3)
        sound &= shade_cell_texel<Codes>(light, setup, vismap, rgb);
    return sound;
}

} // namespace vmlight
