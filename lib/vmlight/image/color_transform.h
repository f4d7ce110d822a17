// SPDX-License-Identifier: Apache-2.0
/// Chooses the colour conversion of an image from its metadata, before pixels are read.
#pragma once

#include <vmlight/image/color.h>

#include <OpenImageIO/imageio.h>

#include <string>
#include <vector>

namespace vmlight {

struct ColorTransform
{
    ColorConversion convert; ///< for finite triples; empty if pixels stay unchanged
    std::string space; ///< interop id to tag the image with
    std::string note; ///< a line for the user
    std::vector<std::string> warnings; ///< lines for the user, with the path
};

/// Find the source space of an image, from `settings.from`, or else its name, labels and pixel type, and the
/// conversion to scene-linear: with the OCIO config of `settings`, else $OCIO, else without a config. See
/// to_scene_linear().
///
/// @param path     of the image
/// @param settings `stored` must be set
/// @returns false, with the reason in `error`, if the config cannot be read, lacks the space or cannot convert it, or
///          the label that decides is older than the pixels.
bool find_color_transform(ColorTransform& transform, const OIIO::ImageSpec& spec, const std::string& path,
                          const ColorSettings& settings, std::string& error);

/// Find the conversion of light from the working space to the space `asked`.
///
/// @param working  interop id of the light
/// @param settings its config is used
/// @returns false, with the reason in `error`, if the space is unknown, data or not linear.
bool find_output_transform(ColorTransform& transform, const std::string& working, const std::string& asked,
                           const ColorSettings& settings, std::string& error);

} // namespace vmlight
