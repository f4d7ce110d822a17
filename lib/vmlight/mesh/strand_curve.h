// SPDX-License-Identifier: Apache-2.0
/// A strand as the smooth curve that is traced and baked: the uniform cubic B-spline of its points, extended by one
/// point at either end so that it starts and ends at the strand's own first and last points.
#pragma once

#include <vmlight/mesh/strands.h>

#include <cstddef>
#include <vector>

namespace vmlight {

struct CurvePoint
{
    Imath::V3d position;
    Imath::V3d tangent; ///< of unit length, towards the tip
    double radius;
};

class StrandCurve
{
public:
    /// Four of these in a row are one span of the curve.
    struct Control
    {
        Imath::V3d position;
        double radius;
    };

    /// @param strands  must have passed check_strands()
    StrandCurve(const Strands& strands, size_t strand);

    /// The curve at a share of its length, from 0 at the root to 1 at the tip. Lengths are those of the chords of its
    /// spans.
    CurvePoint at(double share) const;

    /// The share of the length at the start of each span, and 1.
    std::vector<double> knot_shares() const;

    /// Three more than spans.
    const std::vector<Control>& controls() const { return m_controls; }

    /// Cut each span in two until none is longer than `longest` of its radii. It stays the same curve.
    /// @returns false if that takes more than `most` spans
    bool cut(double longest, size_t most);

private:
    size_t spans() const { return m_controls.size() - 3; }
    Control knot(size_t k) const;
    void measure();

    std::vector<Control> m_controls;
    std::vector<double> m_lengths; // from the root to each knot
};

} // namespace vmlight
