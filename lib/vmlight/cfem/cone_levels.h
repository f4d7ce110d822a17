// SPDX-License-Identifier: Apache-2.0
/// What a strand mirrors: light from around the cone at the angle a from its tangent t,
///     S(t, a) = Int L(w) k dw / Int k dw,   k = max(0, cos(angle(t, w) - a))^exponent,
/// over the whole sphere. A constant L gives L, and S(t, a) = S(-t, pi - a). Seen along d, from the eye, a strand
/// mirrors the cone with cos a = t.d.
/// Source: J. Kajiya, T. Kay, "Rendering Fur with Three Dimensional Textures", SIGGRAPH 1989 (the specular term).
#pragma once

#include <vmlight/cfem/environment.h>

#include <Imath/ImathVec.h>

#include <string>
#include <vector>

namespace vmlight {

/// Filtered by zonal harmonics for angles from 0 to pi / 2, as finely as the lobe is wide.
struct ConeLevels
{
    /// Beyond it the lobe would be narrower than what the harmonics hold.
    static constexpr double kLargestExponent = 500;

    int width = 0, height = 0; ///< of a lat-long map of tangents
    int count = 0; ///< levels: angles from 0 to pi / 2, evenly spaced
    std::vector<float> texels; ///< R, G, B; level after level, row after row

    /// Filter `environment`.
    ///
    /// @param exponent from 1 to kLargestExponent
    /// @returns false, with the reason in `error`, if make_cfem() would refuse the environment
    bool make(const Environment& environment, double exponent, int nthreads, std::string& error);

    /// Set `rgb` to S for a unit tangent in the environment's space, and the cosine of a. Linear in between.
    void look(float* rgb, Imath::V3d tangent, double cos_angle) const;
};

} // namespace vmlight
