// SPDX-License-Identifier: Apache-2.0
/// The brightest that a surface can be under an unfiltered environment, for models that look light up in it.
#pragma once

#include <vmlight/lightmap/model_shader.h>

#include <OpenImageIO/imagebuf.h>

#include <cmath>

namespace vmlight {

/// Set `rgb` to the largest R, G and B of the environment's cosine-filtered map, at least 0: no surface is lit
/// brighter, whatever part of the sky it sees. From a map of 64x32 pixels, which may miss the peak under a small sun by
/// 0.3 %.
///
/// @param radiance     as make_radiance() makes it; values that are negative or not finite are repaired
void find_brightest_light(float rgb[3], const OIIO::ImageBuf& radiance);

/// `value`, or `brightest` times `gain` if it is above that and finite; one that is not finite stays, to be reported.
inline float held_to(float brightest, float gain, float value)
{
    const float most = brightest * gain * kAboveRounding;
    return value > most && std::isfinite(value) ? most : value;
}

} // namespace vmlight
