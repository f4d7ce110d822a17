// SPDX-License-Identifier: Apache-2.0
/// Heat maps: the signed error of each texel, relative to the mean of the reference.
#pragma once

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight::cost {

/// `R`, `G`, `B`: (model - reference) / mean(reference), and `coverage`. 0 in texels that are not covered. Tagged as
/// data.
OIIO::ImageBuf heat_map(const OIIO::ImageBuf& lightmap, const OIIO::ImageBuf& reference);

/// The error that is drawn in full red; full blue is its negative.
constexpr float kHeatRange = 0.5f;

/// Encode the mean of R, G and B as a PNG: red where the model is too bright, white where it is right, blue where it is
/// too dark; grey where nothing is covered. Returns false, with the reason in `error`.
///
/// @param side     maximum width and height in pixels; 0: the map's size
bool heat_map_png(std::string& png, const OIIO::ImageBuf& map, int side, std::string& error);

} // namespace vmlight::cost
