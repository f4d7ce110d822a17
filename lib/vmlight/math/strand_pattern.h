// SPDX-License-Identifier: Apache-2.0
/// Ray directions around a strand: over the whole sphere, with a density proportional to the sine of the angle to its
/// tangent. A pure function of (sample, texel, seed), as in sampling.h.
#pragma once

#include <vmlight/math/ray_fan.h>
#include <vmlight/math/sampling.h>

#include <Imath/ImathVec.h>

#include <memory>
#include <string>

namespace vmlight {

/// The polar angle, 0 to pi, below which a share `u` in [0, 1] of the density sin^2 lies: the solution of
///     (theta - sin theta cos theta) / pi = u.
double strand_angle(double u);

/// The directions of all points: `count`, stratified.
class StrandPattern
{
public:
    /// @param sampler  "halton", "sobol" or "fibonacci"
    StrandPattern(const std::string& sampler, int count);

    ~StrandPattern();

    int count() const;

    /// Fill `fan` with the texel's directions, unit vectors around the unit vector `tangent`, and set the lane bits of
    /// all `count`.
    void directions(RayFan& fan, const Imath::V3f& tangent, Point32 texel) const;

private:
    std::unique_ptr<const PointPattern> m_points;
};

} // namespace vmlight
