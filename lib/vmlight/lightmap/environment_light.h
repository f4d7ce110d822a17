// SPDX-License-Identifier: Apache-2.0
/// A lat-long environment, importance sampled: bright parts more often.
/// Source: M. Pharr, W. Jakob, G. Humphreys, "Physically Based Rendering", 3rd ed., section 14.2.4; here the density is
/// constant over each pixel, as the light is.
#pragma once

#include <vmlight/cfem/grid.h>

#include <Imath/ImathVec.h>
#include <OpenImageIO/imagebuf.h>

#include <string>
#include <vector>

namespace vmlight {

/// Light from one direction of the environment.
struct EnvironmentSample
{
    Imath::V3d direction { 0 }; ///< of unit length, in the environment's frame
    Imath::V3f radiance { 0 };
    double density = 0; ///< of sample() in this direction, per steradian; 0 if it never returns it
};

class EnvironmentLight
{
public:
    /// Read the pixels of `env`, constant over their area as for make_cfem(). False, with the reason in `error`, if
    /// there is no colour, or a pixel is NaN, infinite or negative; `sanitize` repairs these instead.
    bool build(const OIIO::ImageBuf& env, bool sanitize, std::string& error);

    /// The direction for a point of the unit square, with a density proportional to the mean of R, G, B. In a black
    /// environment the density is 0 everywhere.
    EnvironmentSample sample(double u, double v) const;

    /// Light from `direction`, of any length but zero.
    EnvironmentSample at(const Imath::V3d& direction) const;

private:
    EnvironmentSample in_cell(int column, int row, const Imath::V3d& direction) const;

    EnvironmentGrid m_grid;
    std::vector<float> m_rgb;
    // Cumulative distributions over rows, and over the columns of each row. Densities are differences of the stored
    // values, so that rounding changes how often a direction is sampled, but never makes its weight wrong.
    std::vector<double> m_rows;
    std::vector<float> m_columns;
};

} // namespace vmlight
