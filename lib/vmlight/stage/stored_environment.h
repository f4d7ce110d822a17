// SPDX-License-Identifier: Apache-2.0
/// Environments too large to hold: read as the filter goes down them.
#pragma once

#include <vmlight/cfem/environment.h>
#include <vmlight/image/color.h>
#include <vmlight/stage/pixel_source.h>

#include <optional>
#include <string>

namespace vmlight {

/// Whether an image of this spec takes more than 256 MiB as floats.
bool is_large(const OIIO::ImageSpec& spec);

/// `image` in scene-linear light, of which a strip of rows is in memory at a time. Bit for bit what to_scene_linear()
/// makes of the whole. A filter that goes down it twice reads the file twice.
///
/// @param path     its name
/// @param note     as that of to_scene_linear()
/// @returns false, with the reason in `error`, if it has no colour, or its space is not known
bool read_as_it_goes(std::optional<Environment>& dst, const PixelSourcePointer& image, const std::string& path,
                     const ColorSettings& settings, std::string& note, std::string& error);

} // namespace vmlight
