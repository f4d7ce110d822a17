// SPDX-License-Identifier: Apache-2.0
/// The colours of materials, in the space of the light.
#pragma once

#include <vmlight/image/color.h>
#include <vmlight/mesh/material.h>

#include <OpenImageIO/imagebuf.h>

#include <array>
#include <string>

namespace vmlight {

/// Read the colours of a texture that exists, converted by `settings`, whose `stored` is ignored.
///
/// @param index    set to its channels R, G, B
/// @returns false, with the reason in `error`, if it cannot be read or converted, or has no colour
bool read_material_texture(OIIO::ImageBuf& dst, std::array<int, 3>& index, const MaterialTexture& texture,
                           const ColorSettings& settings, int nthreads, std::string& error);

/// The conversion of Material::base_color, which is linear with Rec.709 primaries; empty if there is none. False, with
/// the reason in `error`, if the config of `settings` cannot be used.
bool find_factor_conversion(ColorConversion& dst, const ColorSettings& settings, std::string& error);

} // namespace vmlight
