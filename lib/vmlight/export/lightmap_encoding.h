// SPDX-License-Identifier: Apache-2.0
/// Lightmaps as files that engines read.
#pragma once

#include <vmlight/base/params.h>
#include <vmlight/image/texture_file.h>

#include <OpenImageIO/imagebuf.h>

#include <string>
#include <vector>

namespace vmlight {

/// A file, whole.
struct TextureFile
{
    std::string extension, bytes;
    /// How it is decoded, for the user; "" if that is its format's matter.
    std::string decode;
};

/// The words of ExportParams::lightmap_encoding: `half` (EXR), `rgbe` (Radiance .hdr), `rgbm` (PNG).
Choices lightmap_encoding_choices();

/// Convert a lightmap of floats to linear Rec.709, which engines take all light for, and clamp what is negative then.
/// Light without a label is Rec.709 already.
/// @param dst  set to R, G, B
/// @returns false, with the reason in `error`, if it has no colour channels, is labelled with a space that is not
///          known, or a value is not finite
bool engine_light(OIIO::ImageBuf& dst, const OIIO::ImageBuf& lightmap, std::string& error);

/// The greatest value of any channel.
float greatest_value(const OIIO::ImageBuf& image);

/// RGBM: light = range * alpha * rgb, all linear. R, G and B are each within range * alpha / 2 steps of the depth;
/// alpha is the least step that holds the largest of the three.
///
/// @param light    R, G, B, not negative
/// @param range    of alpha 1; 0: greatest_value(), which is what `range` is set to
/// @returns false, with the reason in `error`, if a value is greater than `range`
bool encode_rgbm(TextureFile& dst, const OIIO::ImageBuf& light, double& range, TextureDepth depth, std::string& error);

} // namespace vmlight
