// SPDX-License-Identifier: Apache-2.0
/// Real spherical harmonics in the convention of project_harmonics() (cfem/sh.h): orthonormal, poles on the y axis,
/// longitude from s = 0 of latlong.h.
#pragma once

#include <vmlight/math/rotation.h>

#include <Imath/ImathVec.h>

#include <vector>

namespace vmlight {

/// Evaluates Y_lm for l < order, for several directions at a time.
/// Source: P.-P. Sloan, "Efficient Spherical Harmonic Evaluation", JCGT 2(2), 2013 (associated Legendre functions
/// without the power of the sine, which is part of the longitude factor).
class Harmonics
{
public:
    static constexpr int kLargestOrder = 8;
    /// Directions per call of evaluate().
    static constexpr int kLanes = 8;

    /// @param order    1 to kLargestOrder
    explicit Harmonics(int order);

    int order() const { return m_order; }
    int count() const { return m_order * m_order; }

    /// Set values[(l^2 + l + m) * kLanes + i] to Y_lm of the unit vector (x[i], y[i], z[i]).
    void evaluate(const float* x, const float* y, const float* z, float* values) const;

private:
    int m_order;
    struct Step
    {
        float rise, fall; // P_l = rise y P_l-1 - fall P_l-2
    };
    std::vector<Step> m_steps; // at [l order + m]
    std::vector<float> m_first; // P_mm, sqrt 2 included where m > 0
};

/// The coefficients of f(R w), from those of f. R, G, B of (l, m) are at 3 (l^2 + l + m), as from project_harmonics().
/// Exact to rounding: uses a quadrature that is exact for products of two functions of this order.
/// Source: J. Driscoll, D. Healy, "Computing Fourier Transforms and Convolutions on the 2-Sphere", 1994, theorem 3.
std::vector<double> rotate_harmonics(const std::vector<double>& coefficients, int order, const Rotation& rotation);

/// The factor A_l / pi of band l in a cosine filter: 1, 2/3, 1/4, 0, -1/24, 0, 1/64, ...
double cosine_eigenvalue(int l);

/// The same of the filter of strands, (1/pi^2) sin(t, w): 1, 0, -1/8, 0, -1/64, 0, -5/1024, ... From P_l(cos theta) as
/// a sum of cosines of multiples of theta: with a_n = (2n - 1)!! / (2n)!! it is a_n^2 - a_(n-1) a_(n+1) for l = 2n.
double sine_eigenvalue(int l);

} // namespace vmlight
