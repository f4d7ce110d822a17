// SPDX-License-Identifier: Apache-2.0
/// Environments too large to hold in memory: streamed through the filter, a strip of rows at a time.
#pragma once

#include <vmlight/cfem/environment.h>
#include <vmlight/image/color.h>
#include <vmlight/stage/pixel_source.h>

#include <optional>
#include <string>
#include <vector>

namespace vmlight {

/// Whether the image takes more than 256 MiB as floats.
bool is_too_large_to_hold(const OIIO::ImageSpec& spec);

/// Open `image` as scene-linear light, converted row by row: bit for bit the result of to_scene_linear() on the whole
/// image. A filter with two passes reads the file twice.
///
/// @param path     name of the image, for its colour space and for messages
/// @param note, warnings   as for to_scene_linear()
/// @returns false, with the reason in `error`, if the image has no colour channels, or its colour space is unknown.
bool stream_environment(std::optional<Environment>& dst, const PixelSourcePointer& image, const std::string& path,
                        const ColorSettings& settings, std::string& note, std::string& error,
                        std::vector<std::string>* warnings = nullptr);

} // namespace vmlight
