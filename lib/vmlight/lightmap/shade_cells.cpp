// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/shade_kernel.h>
#include <vmlight/math/four_floats.h>
#include <vmlight/math/packed_visibility.h>

#include <cmath>

namespace vmlight {
namespace {

constexpr float kLeastCosine = 0.2f;
constexpr int kHead = 7; // floats of V, B and n

// R, G, B and the weight: for each axis, and alike everywhere.
struct Sums
{
    FourFloats x {}, y {}, z {}, plain {};

    void add(const float* moments)
    {
        x += load_four(moments);
        y += load_four(moments + 4);
        z += load_four(moments + 8);
        plain += load_four(moments + 12);
    }
    void add_between(const float* low, const float* high, float share)
    {
        const FourFloats f = all_four(share);
        x += f * (load_four(high) - load_four(low));
        y += f * (load_four(high + 4) - load_four(low + 4));
        z += f * (load_four(high + 8) - load_four(low + 8));
        plain += f * (load_four(high + 12) - load_four(low + 12));
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

// The mean of the light in `sums`, weighted by n.w as far as that can be trusted, for a texel that sees `v`.
bool light_of(const ShadeSetup& setup, const Sums& sums, const float* n, float v, float* rgb)
{
    const CellLight& light = *setup.cells;
    const float size = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), unit = size > 0 ? 1 / size : 0.0f;
    const float angle = sums.plain[3];
    const FourFloats along
        = all_four(n[0] * unit) * sums.x + all_four(n[1] * unit) * sums.y + all_four(n[2] * unit) * sums.z;
    // What lies across the horizon has parts of either sign: where these leave little of the weight, n.w gives way to
    // n.w + 1, which is nowhere below 0.
    const float cosine = angle > 0 ? along[3] / angle : 0.0f;
    const float even = cosine < kLeastCosine ? (kLeastCosine - cosine) * (1 / kLeastCosine) : 0.0f;
    const FourFloats weighted = along + all_four(even) * sums.plain;
    const float gain = v * setup.gain, share = weighted[3] > 0 ? 1 / weighted[3] : 0.0f;
    bool sound = std::abs(v) <= kLargestVisibility && std::isfinite(size);
    for (int c = 0; c < 3; ++c) {
        const float mean = light.mean[c] + weighted[c] * share;
        // No mean is beyond what there is; and what is no number stays none, to be found.
        const float within = mean < light.least[c] ? light.least[c] : mean > light.most[c] ? light.most[c] : mean;
        const float color = gain * within;
        sound &= std::isfinite(color);
        rgb[c] = gain > 0 || !(gain == gain) ? color : 0.0f;
    }
    return sound;
}

template <int kFloats, class Add>
bool shade(const ShadeSetup& setup, const float* vismap, size_t texels, float* rgb, const Add& add)
{
    bool sound = true;
    for (size_t i = 0; i < texels; ++i, vismap += kHead + kFloats, rgb += 3) {
        uint32_t codes[kFloats];
        sound &= whole_numbers<kFloats>(vismap + kHead, codes);
        Sums sums;
        add(sums, codes);
        sound &= light_of(setup, sums, vismap + 4, vismap[0], rgb);
    }
    return sound;
}

} // namespace

bool shade_mask(const ShadeSetup& setup, VismapOrder, const float* vismap, size_t texels, float* rgb)
{
    constexpr int kEdges = direction_grid::kSlices + 1;
    const float* running = setup.cells->running.data();
    return shade<kMaskFloats>(setup, vismap, texels, rgb, [&](Sums& sums, const uint32_t* codes) {
        for (int column = 0; column < direction_grid::kColumns; ++column) {
            const ColumnView view = unpack_mask(codes, column);
            if (view.density == 0)
                continue;
            const float* edges = running + column * kEdges * kMomentFloats;
            sums.add_between(edges + view.low * kMomentFloats, edges + view.high * kMomentFloats, float(view.density));
        }
    });
}

bool shade_cells(const ShadeSetup& setup, VismapOrder, const float* vismap, size_t texels, float* rgb)
{
    constexpr int kTriplesPerFloat = kCellsPerFloat / 3;
    constexpr size_t kTable = size_t(kTripleCodes) * kMomentFloats;
    const float* triples = setup.cells->triples.data();
    return shade<kCellsFloats>(setup, vismap, texels, rgb, [&](Sums& sums, const uint32_t* codes) {
        const float* table = triples;
        for (int i = 0; i < kCellsFloats; ++i)
            for (int k = kTriplesPerFloat - 1; k >= 0; --k, table += kTable)
                if (const uint32_t code = codes[i] >> (6 * k) & 63)
                    sums.add(table + code * kMomentFloats);
    });
}

} // namespace vmlight
