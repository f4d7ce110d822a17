// SPDX-License-Identifier: Apache-2.0
/// How bright a lightmap is, and the exposure that makes it middle grey.
#pragma once

#include <OpenImageIO/imagebuf.h>

#include <array>
#include <cstdint>
#include <string>

namespace vmlight {

constexpr double kMiddleGray = 0.18;

/// The exposure that brings light to middle grey, as far as LightmapParams::exposure goes.
struct GrayExposure
{
    double stops = 0; ///< 0 if there is no light
    double mean = 0; ///< luminance of the light at that exposure
    bool is_gray = false; ///< whether that is middle grey

    /// Of light whose mean luminance is `mean` without exposure.
    static GrayExposure of(double mean);
    /// "--exposure 1.50 brings the mean to 0.18"; or how near to that an exposure can bring it.
    std::string advice() const;
};

/// Luminance of the lit texels of a lightmap: those above 0 that the visibility map's channel `coverage` says a
/// triangle covers, or, without that channel, that see anything, which counts the margin as well.
struct LightLevel
{
    int64_t texels = 0; ///< 0: nothing is lit, and the rest means nothing
    double mean = 0, percentile95 = 0;

    /// The exposure that brings the mean to middle grey, to a hundredth of a stop.
    ///
    /// @param exposure     at which the light was measured
    GrayExposure gray_exposure(double exposure) const;
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
