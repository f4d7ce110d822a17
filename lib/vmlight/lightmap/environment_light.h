// SPDX-License-Identifier: Apache-2.0
/// A lat-long environment as a light whose bright parts are sampled more often.
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
    double density = 0; ///< with which sample() takes it, per steradian; 0 if never
};

class EnvironmentLight
{
public:
    /// Take the pixels of `env`, as make_cfem() does: each is constant over its area. False, with the reason in
    /// `error`, if there is no colour, or a pixel is NaN, infinite or negative and not to be mended (`sanitize`).
    bool build(const OIIO::ImageBuf& env, bool sanitize, std::string& error);

    /// The direction for a point of the unit square: density is proportional to the mean of R, G, B. A black
    /// environment has density 0 everywhere.
    EnvironmentSample sample(double u, double v) const;

    /// What arrives from `direction`, of any length but zero.
    EnvironmentSample at(const Imath::V3d& direction) const;

private:
    EnvironmentSample in_cell(int column, int row, const Imath::V3d& direction) const;

    EnvironmentGrid m_grid;
    std::vector<float> m_rgb;
    // Shares of the light up to the end of each row; and in each row, up to the end of each column. Densities are the
    // differences of what is stored, so that rounding makes a sample more or less likely, but never its weight wrong.
    std::vector<double> m_rows;
    std::vector<float> m_columns;
};

} // namespace vmlight
