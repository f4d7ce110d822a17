// SPDX-License-Identifier: Apache-2.0
/// How bright a lightmap is, and the exposure that makes it middle grey.
#pragma once

#include <OpenImageIO/imagebuf.h>

#include <array>
#include <cstdint>
#include <string>

namespace vmlight {

constexpr double kMiddleGray = 0.18;

/// Luminance of the lit texels of a lightmap: those above 0 that the visibility map's channel `coverage` says a
/// triangle covers, or, without that channel, that see anything, which counts the margin as well.
struct LightLevel
{
    int64_t texels = 0; ///< 0: nothing is lit, and the rest means nothing
    double mean = 0, percentile95 = 0;

    /// Stops that bring the mean to middle grey, in hundredths, within what LightmapParams::exposure takes; 0 if
    /// nothing is lit.
    double stops_to_gray() const;
};

/// Measure `lightmap`, which `vismap` was lit to: float images of one size in memory.
LightLevel measure_light(const OIIO::ImageBuf& lightmap, const OIIO::ImageBuf& vismap);

/// The mean luminance of what covers a picture of R, G, B, times alpha, and A, float and in memory; 0 if nothing does.
///
/// @param space    interop id of its light
double covered_luminance(const OIIO::ImageBuf& picture, const std::string& space);

/// The share of R, G and B in luminance, by the `chromaticities` of the image, or those of its `colorInteropID`; of
/// Rec.709 if it has neither.
std::array<double, 3> luminance_weights(const OIIO::ImageSpec& spec);

} // namespace vmlight
