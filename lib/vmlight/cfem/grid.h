// SPDX-License-Identifier: Apache-2.0
/// How the pixels of a lat-long environment divide the sphere, and at which latitudes their rows are sampled.
/// Longitude here is phi = 2 pi s, in [0, 2 pi] from the left edge: half a turn from that of latlong.h, so that only
/// the first cell begins at the seam. Only differences of longitude matter to a filter.
#pragma once

#include <vector>

namespace vmlight {

/// Each pixel is constant over its cell. Cells are equal in s and t; or, with `border`, pixels are samples at
/// s = i / (width - 1), t = j / (height - 1), and cells reach half-way to their neighbours and end at seam and poles.
struct EnvironmentGrid
{
    int width = 0, height = 0;
    bool border = false;

    /// Longitude of the left edge of column `i`; edge `width` is 2 pi.
    double column_edge(int i) const;
    /// theta, the angle from +y, of the upper edge of row `j`; edge `height` is pi.
    double row_edge(int j) const;
    /// The column that holds longitude phi is floor(column_scale() phi + column_offset()).
    double column_scale() const;
    double column_offset() const;
};

/// A circle of latitude that represents the band around it; `weight` is the band's extent in cos theta.
struct LatitudeNode
{
    double cos_theta, sin_theta, weight;
};

/// Gauss-Legendre quadrature in theta over bands of latitude.
class LatitudeRule
{
public:
    /// @param nodes    per band, at least 1
    explicit LatitudeRule(int nodes);

    /// Append the nodes of the band theta0..theta1. Their weights hold sin theta and add up to
    /// cos theta0 - cos theta1, so that any band has its exact solid angle.
    void append(std::vector<LatitudeNode>& dst, double theta0, double theta1) const;

private:
    std::vector<double> m_position, m_weight; // on [-1, 1]
};

} // namespace vmlight
