// SPDX-License-Identifier: Apache-2.0
/// Where a pixel is sampled, so that the mean of its samples is the picture under a filter.
#pragma once

#include <vmlight/base/params.h>

#include <string>
#include <vector>

namespace vmlight {

/// The filters that pixel_samples() knows.
Choices pixel_filter_choices();

/// How far a filter reaches from the pixel's centre along an axis, in pixels.
double filter_radius(const std::string& filter);
/// The variance of a filter along an axis, in square pixels.
double filter_variance(const std::string& filter);

/// An offset from the pixel's centre, in pixels.
struct PixelSample
{
    double x, y;
};

/// The same pattern for all pixels: a rank-1 lattice, whose points are spread evenly along x and y alike, warped by the
/// filter's shape. All samples count the same. One sample is at the centre.
///
/// @param count    from 1
/// @param filter   a word of pixel_filter_choices()
/// Deterministic. Source: M. Ernst, M. Stamminger, G. Greiner, "Filter Importance Sampling", 2006.
std::vector<PixelSample> pixel_samples(int count, const std::string& filter);

} // namespace vmlight
