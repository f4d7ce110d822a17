// SPDX-License-Identifier: Apache-2.0
/// A stack of lobes prepared for lookups along any direction d, with a lobe of any width.
///
/// Its levels are knots, sorted by r: knot 0, r = 0, is the mean of the CFEM over the sphere; knot 1 the hemisphere,
/// knot 2 the CFEM, and from there on the lobes narrow. Light is linear in r between knots, so that its first moment is
/// right at every r: light a + b.w is filtered to a + r b.d.
///
/// The first level of a stack for strands is no lobe. There, knot 0 is the hemisphere too, and knot 2 lies between its
/// neighbours.
#pragma once

#include <vmlight/cfem/stack.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace vmlight {

/// Floats of a texel of two lobes.
constexpr int kLobeFloats = 6;
constexpr int kLobeKnots = kStackLevels + 1;
constexpr int kCfemKnot = 2;
/// r is clamped to that of the narrowest lobe.
constexpr float kLargestLobe = 0.98482115f;
/// sqrt(1 - r) of the CFEM, and its step from knot to knot above.
constexpr float kCfemSpread = 0.57735027f, kKnotStep = float(kStackStep);

/// The position of r among the knots, 0 to kLobeKnots - 1; 0 for NaN.
inline float lobe_position(float r)
{
    r = r > 0 ? std::min(r, kLargestLobe) : 0.0f;
    if (!(r > 2.0f / 3))
        return std::max(r * 2, r * 6 - 2);
    const float spread = std::sqrt(1 - r);
    const int knot = std::min(int((kCfemSpread - spread) * (1 / kKnotStep)), kLobeKnots - 2 - kCfemKnot);
    const float left = kCfemSpread - float(knot) * kKnotStep;
    // (r - r_knot) / (r_next - r_knot), r = 1 - spread^2
    const float share = (left - spread) * (left + spread) / (kKnotStep * (left + left - kKnotStep));
    return float(knot + kCfemKnot) + std::min(std::max(share, 0.0f), 1.0f);
}

struct LobeLookup
{
    /// Size of the maps, without their frame.
    int width = 0, height = 0;
    /// Texels from one row of `texels` to the next: width + 2.
    int pitch = 0;
    /// A map for each pair of neighbouring knots, with the frame of CfemLookup, height + 2 rows: R, G, B of the wider
    /// lobe and R, G, B of the narrower, so that one load of eight floats fetches both; two zeros follow the last
    /// texel. Each knot is stored twice: maps of pairs are faster than one map of all knots, since neighbouring texels
    /// share cache lines.
    std::vector<float> texels;
    /// Largest absolute value in `texels`.
    float largest = 0;
    /// CfemLookup::brightest of level 0.
    float brightest[4] = { 0, 0, 0, 0 };
};

/// Check all but the pixels of the levels of a stack. False, with the reason in `error`, as prepare_lobes().
bool check_lobes(OIIO::cspan<OIIO::ImageBuf> levels, std::string& error);

/// Prepare the levels of a stack.
///
/// @param levels   as make_cfem_stack() makes them, without the last image
/// @returns false, with the reason in `error`, if there are not kStackLevels of them, the `vmlight:lobe` of one is not
///          that of its level (within 1e-4), they differ in size, prepare_cfem() refuses one, or they have more than 39
///          million texels each.
bool prepare_lobes(LobeLookup& dst, OIIO::cspan<OIIO::ImageBuf> levels, std::string& error);

} // namespace vmlight
