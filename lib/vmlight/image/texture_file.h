// SPDX-License-Identifier: Apache-2.0
/// Textures for engines: PNG and Radiance files whose numbers are as they are given.
#pragma once

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight {

/// Bits per channel of a PNG.
enum class TextureDepth
{
    Eight,
    Sixteen
};

/// The largest whole number of a channel: 255 or 65535.
double largest_of(TextureDepth depth);

/// Encode a PNG. Values in [0, 1] are multiplied by largest_of(depth) and rounded to the nearest; others are clamped.
/// The file says nothing of colour (no gAMA, sRGB, iCCP or cICP), and channels are not multiplied by an alpha.
/// @param texture  1, 3 or 4 float channels
/// @returns false, with the reason in `error`, if OIIO cannot write it
bool encode_png(std::string& bytes, const OIIO::ImageBuf& texture, TextureDepth depth, std::string& error);

/// Encode a Radiance .hdr (RGBE): R, G, B share one exponent, so that each is within 1/256 of the largest of the three.
/// @param texture  three float channels, none negative or above the format's range (1e38)
bool encode_rgbe(std::string& bytes, const OIIO::ImageBuf& texture, std::string& error);

} // namespace vmlight
