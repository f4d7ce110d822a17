// SPDX-License-Identifier: Apache-2.0
/// The exact filters over a hemisphere, cosine-weighted or uniform. For a pixel of the result and a
/// circle of latitude of the environment,
///     n.w = a + b cos(phi - phi_n),  a = cos theta cos theta_n,  b = sin theta sin theta_n >= 0,
/// so the part of the circle above the pixel's horizon is one arc, |phi - phi_n| < acos(-a / b), and its light follows
/// from the prefix integrals of L, L cos phi and L sin phi at the arc's two ends, whatever the width of the
/// environment. Each row of the environment is sampled at a few latitudes, by Gauss quadrature.
#pragma once

#include <vmlight/base/params.h>
#include <vmlight/base/progress.h>
#include <vmlight/cfem/grid.h>

#include <functional>
#include <vector>

namespace vmlight {

/// Sets `rgb` to the 3 x width floats of a row. Called for rows 0, 1, 2, ... in order, from one thread; false stops the
/// filter.
using ReadRow = std::function<bool(int row, float* rgb)>;

/// The weight of a direction of the hemisphere.
enum class HemisphereWeight
{
    cosine, ///< (1/pi) max(0, n.w): a cosine-filtered environment
    uniform ///< 1/(2 pi): the mean over the hemisphere
};

/// Filter the rows of `read`.
///
/// @param rgb  set to 3 x width x height sums, not clamped: below 0 only by rounding
/// @returns false if `read` or `progress` stopped it.
bool filter_exact(std::vector<double>& rgb, const Size& resolution, const EnvironmentGrid& grid, const ReadRow& read,
                  int nthreads, const Progress& progress, HemisphereWeight weight = HemisphereWeight::cosine);

} // namespace vmlight
