// SPDX-License-Identifier: Apache-2.0
/// A stack of lobes made ready to be looked up along any direction, with any spread of the light around it.
///
/// Its levels stand as knots in the order of r: knot 0, r = 0, is the mean of the CFEM over the sphere; knot 1 is the
/// hemisphere, knot 2 the CFEM, and from there on the lobes narrow. Between knots light is linear in r, so that its
/// first moment is right at every r: light a + b.w is filtered to a + r b.d.
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

/// Where r stands among the knots, 0 to kLobeKnots - 1; what is not a number stands at 0.
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
    /// A map for each pair of neighbouring knots, framed as CfemLookup's, height + 2 rows: R, G, B of the wider lobe
    /// and R, G, B of the narrower, so that one load of eight floats fetches both; the last texel is followed by two 0.
    /// Each knot stands here twice: maps of pairs are faster than one map of all, since texels that are neighbours on a
    /// chart share lines of the cache.
    std::vector<float> texels;
    /// Largest absolute value in `texels`.
    float largest = 0;
};

/// Make the levels of a stack ready.
///
/// @param levels   as make_cfem_stack() makes them
/// @returns false, with the reason in `error`, if they are not kStackLevels, one has not the `vmlight:lobe` that its
///          place asks for (within 1e-4), they differ in size, one is no CFEM (prepare_cfem()), or they have more than
///          39 million texels each.
bool prepare_lobes(LobeLookup& dst, OIIO::cspan<OIIO::ImageBuf> levels, std::string& error);

} // namespace vmlight
