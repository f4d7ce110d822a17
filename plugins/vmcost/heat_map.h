// SPDX-License-Identifier: Apache-2.0
/// Where a model errs: the signed error of each texel, relative to the mean of the reference.
#pragma once

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight::cost {

/// `R`, `G`, `B`: (model - reference) / mean(reference), and `coverage`. 0 where no triangle covers the texel. Tagged
/// as data.
OIIO::ImageBuf heat_map(const OIIO::ImageBuf& lightmap, const OIIO::ImageBuf& reference);

/// The errors of a heat map that are drawn in full red and full blue.
constexpr float kHeatRange = 0.5f;

/// The bytes of a PNG of the mean of R, G and B: red where the model is too bright, white where right, blue where too
/// dark; grey where nothing is covered. False, with the reason in `error`.
///
/// @param side     of the picture at most, in pixels; 0 is that of the map
bool heat_map_png(std::string& png, const OIIO::ImageBuf& map, int side, std::string& error);

} // namespace vmlight::cost
