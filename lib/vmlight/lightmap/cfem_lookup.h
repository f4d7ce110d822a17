// SPDX-License-Identifier: Apache-2.0
/// A CFEM prepared for lookups along any direction: bilinear in (s, t), continuous across the seam and the poles,
/// without a test for either in the inner loop.
///
/// The texels have a frame one texel wide. Its columns repeat the column across the seam. The row above row 0 is
/// 2 P - row 0, where P, the mean of row 0, is the value of the pole: halfway between the two rows, at the pole,
/// interpolation gives P along every meridian. Repeating row 0 rotated by half a turn instead would need an even width
/// and give the pole no single value.
#pragma once

#include <OpenImageIO/imagebuf.h>

#include <string>
#include <vector>

namespace vmlight {

struct CfemLookup
{
    /// Size of the map, without its frame.
    int width = 0, height = 0;
    /// Texels from one row of `texels` to the next: width + 2.
    int pitch = 0;
    /// R, G, B and a 0, so that one 128-bit load fetches a texel: height + 2 rows, then two rows that hold the mean of
    /// the map over the sphere, for lookups without a direction.
    std::vector<float> texels;
    /// Largest absolute value in `texels`.
    float largest = 0;
    /// Largest R, G, B of the map, at least 0, and a 0: no surface is lit brighter.
    float brightest[4] = { 0, 0, 0, 0 };

    /// R, G, B of a texel of the map.
    const float* at(int x, int y) const { return &texels[4 * (size_t(y + 1) * size_t(pitch) + size_t(x + 1))]; }
    int mean_texel() const { return (height + 2) * pitch; }
};

/// Check all but the pixels of a CFEM. False, with the reason in `error`, as prepare_cfem().
bool check_cfem(const OIIO::ImageSpec& spec, std::string& error);

/// Prepare `cfem`.
///
/// @param cfem     a lat-long map of R, G, B, or of one channel, of any size from 1x1 to 2^28 texels, frame included.
///                 Negative values are allowed: filters that ring make them
/// @returns false, with the reason in `error`, if `vmlight:stage` names another stage, the image has no colour, is a
///          crop, stored flipped or rotated, cannot be read, or has values that are not finite or too large to
///          interpolate.
bool prepare_cfem(CfemLookup& dst, const OIIO::ImageBuf& cfem, std::string& error);

} // namespace vmlight
