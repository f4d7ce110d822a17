// SPDX-License-Identifier: Apache-2.0
/// The cosine filter by spherical harmonics: fast where few bands suffice, but it rings around small bright lights.
/// A cosine filter multiplies band l by A_l / pi = 1, 2/3, 1/4, 0, -1/24, 0, 1/64, ...
/// Source: R. Ramamoorthi and P. Hanrahan, "An Efficient Representation for Irradiance Environment Maps", 2001.
#pragma once

#include <vmlight/cfem/exact.h>
#include <vmlight/math/harmonics.h>

#include <vector>

namespace vmlight {

/// Project the rows of `read` onto orthonormal harmonics, for l < order. With P_lm >= 0 at the pole-side end (no
/// Condon-Shortley sign), theta from +y and phi = 2 pi s:
///     Y_l0 = P_l0(cos theta), Y_lm = sqrt 2 P_lm cos m phi, Y_l-m = sqrt 2 P_lm sin m phi,  Int P_lm^2 dw = 1.
///
/// @param coefficients  set to 3 order^2 numbers: R, G, B of (l, m) at 3 (l^2 + l + m)
/// @returns false if `read` or `progress` stopped it.
bool project_harmonics(std::vector<double>& coefficients, int order, const EnvironmentGrid& grid, const ReadRow& read,
                       int nthreads, const Progress& progress);

/// Set `rgb` to the 3 x width x height values of sum c_lm Y_lm at the pixel centres.
void evaluate_harmonics(std::vector<double>& rgb, const Size& resolution, const std::vector<double>& coefficients,
                        int order, int nthreads);

/// Filter the rows of `read` with l < order, by a kernel that multiplies band l by `eigenvalue`. False if `read` or
/// `progress` stopped it.
bool filter_harmonics(std::vector<double>& rgb, const Size& resolution, int order, const EnvironmentGrid& grid,
                      const ReadRow& read, int nthreads, const Progress& progress,
                      double (*eigenvalue)(int band) = cosine_eigenvalue);

} // namespace vmlight
