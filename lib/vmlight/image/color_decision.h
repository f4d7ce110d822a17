// SPDX-License-Identifier: Apache-2.0
/// What is to be done with an image's colours, decided before a pixel is touched.
#pragma once

#include <vmlight/image/color.h>

#include <OpenImageIO/imageio.h>

#include <string>

namespace vmlight {

struct ColorDecision
{
    ColorConversion convert; ///< of finite triples; empty if pixels stay
    std::string space; ///< to tag the image with
    std::string note; ///< one line on what is done
};

/// Find the space that an image of `spec` is in, by `settings.from`, else its name, its tags and its numbers, and the
/// way from there to scene-linear light: by the OCIO config of `settings`, else of $OCIO, else without one.
///
/// @param path     its name
/// @param settings `stored` must be known
/// @returns false, with the reason in `error`, if the config cannot be read or has no such space, or no way from it.
bool decide_color(ColorDecision& decision, const OIIO::ImageSpec& spec, const std::string& path,
                  const ColorSettings& settings, std::string& error);

} // namespace vmlight
