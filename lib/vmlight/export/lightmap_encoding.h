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

/// A file of a lightmap; `suffix` follows the name of the lightmap's own file, which has none.
struct LightmapFile
{
    std::string suffix;
    TextureFile texture;
};

/// The words of ExportParams::lightmap_encoding: `half` (EXR), `rgbe` (Radiance .hdr), `rgbm` (PNG), `gain_map` (two
/// PNGs and JSON).
Choices lightmap_encoding_choices();

/// Encode a lightmap as files of any encoding but `half`, which is an image that OpenEXR writes.
///
/// @param light    from engine_light()
/// @param encoding one of lightmap_encoding_choices()
/// @param range    of RGBM, see there
/// @returns false, with the reason in `error`, if the encoding cannot hold the light
bool encode_lightmap(std::vector<LightmapFile>& dst, const OIIO::ImageBuf& light, const std::string& encoding,
                     double range, TextureDepth depth, std::string& error);

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

/// A gain map, by Adobe's specification 1.0: what a file viewer shows, `_gain` that turns it into the light, and JSON
/// of its numbers by the names of that specification. With S the linear value of the first and g that of the second,
/// light = (S + 1/64) 2^(min + (max - min) g) - 1/64, channel by channel: light + 1/64 is within a factor of
/// 2^((max - min) / 2 steps of the depth).
///
/// @param dst      set to the three files: sRGB, cut off at 1; the gain; the numbers
/// @param light    R, G, B, not negative
bool encode_gain_map(std::vector<LightmapFile>& dst, const OIIO::ImageBuf& light, TextureDepth depth,
                     std::string& error);

} // namespace vmlight
