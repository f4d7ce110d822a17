// SPDX-License-Identifier: Apache-2.0
/// A CFEM made ready to be looked up along any direction: bilinear in (s, t), continuous over the seam and the poles,
/// with no test for either in the inner loop.
///
/// The texels stand in a frame of one more texel on each side. The extra columns repeat the column across the seam.
/// The extra row above row 0 is 2 P - row 0, where P, the mean of row 0, is the value of the pole: halfway between the
/// two, where the pole is, interpolation gives P from whatever side it is reached. Unlike the row that lies across
/// the pole (row 0, half a turn away), this asks for no even width, and the pole has one value.
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
    /// R, G, B and a 0, so that one 128-bit load fetches a texel: height + 2 rows, then two rows of nothing but the
    /// mean of the map over the sphere, where a lookup without a direction goes.
    std::vector<float> texels;
    /// Largest absolute value in `texels`.
    float largest = 0;

    /// R, G, B of a texel of the map.
    const float* at(int x, int y) const { return &texels[4 * (size_t(y + 1) * size_t(pitch) + size_t(x + 1))]; }
    int mean_texel() const { return (height + 2) * pitch; }
};

/// Make `cfem` ready.
///
/// @param cfem     a lat-long map of R, G, B, or of one channel, of any size from 1x1 to 2^28 texels, frame included.
///                 Negative values pass: filters that ring make them
/// @returns false, with the reason in `error`, if `vmlight:stage` says that the image is no CFEM, it has no colour,
///          cannot be read, or has values that are not finite or so large that interpolating them would not be.
bool prepare_cfem(CfemLookup& dst, const OIIO::ImageBuf& cfem, std::string& error);

} // namespace vmlight
