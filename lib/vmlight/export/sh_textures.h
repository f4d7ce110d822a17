// SPDX-License-Identifier: Apache-2.0
/// Textures of spherical harmonics: what the model `sh` reads of a visibility map, in the channels of RGBA textures.
#pragma once

#include <OpenImageIO/imagebuf.h>

#include <vector>

namespace vmlight {

/// Numbers of a texel above band 1 lie within this: (1/pi) vis(w) max(0, n.w) is no longer than sqrt(2/3/pi) = 0.461 as
/// a vector, and each of its harmonics no longer than it.
constexpr float kShBound = 0.5f;

/// The channels of a map in fours: V, B.x, B.y, B.z; then sh.4 to sh.7, sh.8 to sh.11, ... for all bands that the map
/// has all channels of, 0 where the last four are incomplete. The light of a texel is the sum of the products of these
/// with the light's numbers: docs/export.md.
/// @param map  a visibility map of floats in memory
/// @returns RGBA images of floats
std::vector<OIIO::ImageBuf> sh_textures(const OIIO::ImageBuf& map);

/// What a PNG holds of texture number `number`: V as it is, B as (B + 1) / 2, all others as T + kShBound. In place.
void fold_sh(OIIO::ImageBuf& texture, int number);

} // namespace vmlight
