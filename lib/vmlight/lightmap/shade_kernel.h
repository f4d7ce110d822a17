// SPDX-License-Identifier: Apache-2.0
/// The inner loops of shading: texels of a visibility map in, colour out, one function a model.
///
/// Each model has a vector form, compiled for several instruction sets and chosen when it first runs, and a scalar one
/// that is its definition. Both round alike at each step (no fused multiply-add), so their results are the same bits
/// on every machine with IEEE division and square root.
#pragma once

#include <vmlight/lightmap/cell_light.h>
#include <vmlight/lightmap/cfem_lookup.h>
#include <vmlight/lightmap/harmonic_light.h>
#include <vmlight/lightmap/lobe_lookup.h>

#include <cmath>
#include <cstddef>

namespace vmlight {

/// Where the visibility stands among the four floats of a texel; the direction's x, y, z keep their order.
/// Last is how EXR's sorting leaves a map whose channels were written as they come.
enum class VismapOrder
{
    visibility_first,
    visibility_last
};

struct ShadeSetup
{
    const CfemLookup* cfem;
    /// Object space to environment space, row major.
    float rotation[9];
    /// Multiplies the result. Finite, not negative.
    float gain;
    /// What the model `lobe` looks up, in place of the CFEM.
    const LobeLookup* lobes = nullptr;
    /// What `sh`, and `mask` and `cells`, sum in its place; turned already.
    const HarmonicLight* harmonics = nullptr;
    const CellLight* cells = nullptr;
};

/// A texel whose direction has no component of this many times its visibility has none: what it sees is symmetric.
constexpr float kNoDirection = 1e-6f;

/// The largest |V| that is still a visibility: a filter that rings makes a little more of [0, 1] than there was, and
/// what is beyond is another picture, or a map that was graded as if it were one.
constexpr float kLargestVisibility = 2;

/// The largest V gain that is one's, and for which no lookup can leave float's range.
template <class Lookup> float largest_light(const Lookup& map, float gain)
{
    const float in_range = 1.7e38f / (map.largest > 1 ? map.largest : 1.0f);
    return in_range < kLargestVisibility * gain ? in_range : kLargestVisibility * gain;
}

/// Shade `texels` texels by the model `paper`: gain V C(R B / |B|). 0 where V <= 0; where there is light but no
/// direction (kNoDirection), C is the mean of the CFEM over the sphere.
///
/// @param vismap   four floats a texel
/// @param rgb      three floats a texel; may not overlap `vismap`
/// @returns false if an input may not have been finite, |V| is above kLargestVisibility, or a result may be out of
///          float's range: the caller looks closer. Never reads or writes outside its arrays, whatever the input.
using ShadeTexels
    = bool (*)(const ShadeSetup& setup, VismapOrder order, const float* vismap, size_t texels, float* rgb);
bool shade_paper(const ShadeSetup& setup, VismapOrder order, const float* vismap, size_t texels, float* rgb);
/// The same, one texel at a time.
bool shade_paper_scalar(const ShadeSetup& setup, VismapOrder order, const float* vismap, size_t texels, float* rgb);

/// Shade by the model `lobe`: gain V C_r(R B / |B|), r = |B| / V, where C_r is the environment filtered with the lobe
/// whose mean direction has length r (lobe_lookup.h), linear in r between the knots of the stack. 0 where V <= 0.
bool shade_lobe(const ShadeSetup& setup, VismapOrder order, const float* vismap, size_t texels, float* rgb);
/// The same, one texel at a time.
bool shade_lobe_scalar(const ShadeSetup& setup, VismapOrder order, const float* vismap, size_t texels, float* rgb);

/// Shade by the model `sh`: gain max(0, sum_i T_i c_i), where T are the order^2 numbers of a texel, V, B and the
/// harmonics from l = 2 on of (1/pi) vis(w) max(0, n.w), and c the light's (harmonic_light.h). Linear in the texel but
/// for the clamp, which bands that are left out call for. `order` means nothing here: V comes first.
/// Source: P.-P. Sloan, J. Kautz, J. Snyder, "Precomputed Radiance Transfer for Real-Time Rendering in Dynamic,
/// Low-Frequency Lighting Environments", 2002, section 4.
bool shade_harmonics(const ShadeSetup& setup, VismapOrder order, const float* vismap, size_t texels, float* rgb);

/// Shade by the models `mask` and `cells`: gain V times the mean of the light that is seen,
///     mean + (n . sum_k f_k Int_k (L - mean) w dw) / (n . sum_k f_k Int_k w dw),
/// where k runs over the columns' intervals or the cells (packed_visibility.h), and f is how much of each is seen. The
/// ratio makes V, which is known best, tell how much is seen, and the rest only which part of the sky. Where the mean
/// of n.w over what is seen is below 0.2, since cells lie across the horizon, it gives way to n.w + 1, so that the
/// weight never vanishes; and the result stays within V times the least and the most of the environment. `vismap` has
/// V, B, n and the packed numbers, in this order; a number that is not whole, or not in [0, 2^24), counts as 0 and
/// makes the result false.
bool shade_mask(const ShadeSetup& setup, VismapOrder order, const float* vismap, size_t texels, float* rgb);
bool shade_cells(const ShadeSetup& setup, VismapOrder order, const float* vismap, size_t texels, float* rgb);

/// atan(a) / (2 pi) = a (c0 + c1 a^2 + ...) for a in [0, 1]: minimax, off by at most 6e-9.
constexpr float kAtanTurns[8] = { 0.159154832f,  -0.0530461222f,  0.0317459442f,  -0.022136271f,
                                  0.0153460335f, -0.00889872294f, 0.00347959786f, -0.000645304448f };

/// The angle of (x, y) in turns, in [-0.5, 0.5], off by at most 6e-8 turns (4e-7 radians); quarter turns are exact.
/// (0, 0) has angle 0.
inline float atan2_turns(float y, float x)
{
    const float ax = std::abs(x), ay = std::abs(y);
    const float larger = ax > ay ? ax : ay, smaller = ax > ay ? ay : ax;
    const float a = smaller / (larger > 1.17549435e-38f ? larger : 1.17549435e-38f);
    const float s = a * a;
    float r = kAtanTurns[7];
    for (int i = 6; i >= 0; --i)
        r = r * s + kAtanTurns[i];
    r = r * a;
    r = ay > ax ? 0.25f - r : r;
    r = x < 0 ? 0.5f - r : r;
    return std::copysign(r, y);
}

} // namespace vmlight
