// SPDX-License-Identifier: Apache-2.0
/// From scene-linear light to what a screen shows: an OCIO display and view, or sRGB where there is no config.
#pragma once

#include <vmlight/base/params.h>

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight {

struct DisplayParams
{
    /// Names of the OCIO config; "" for its defaults.
    std::string display, view, look;

    template <class Visit> void visit(Visit&& field)
    {
        field("display", display, Text { "NAME" }, "Display of the OCIO config, for pictures; default: the config's");
        field("view", view, Text { "NAME" }, "View of that display; default: the display's");
        field("look", look, Text { "NAME" }, advanced("Look, or looks separated by commas, before the view"));
    }
};

/// Bring R, G, B of `image`, float and in memory, from scene-linear light to a display, and clamp to [0, 1]: views
/// return values outside. Where there is an alpha channel, colour is taken as multiplied by it, and is not any more
/// afterwards, as PNG stores it. Without a config: the curve of sRGB.
///
/// @param space    interop id of the light
/// @param config   OCIO config; "" means $OCIO, or none
/// @param note     set to a line for the user: "display: sRGB - Display, view: ACES 1.0 - SDR Video"
/// @returns false, with the reason in `error`, if the config cannot be read or lacks a name (the error lists what it
///          has), or a name is given without a config
bool show_on_display(OIIO::ImageBuf& image, const DisplayParams& params, const std::string& space,
                     const std::string& config, int nthreads, std::string& note, std::string& error);

/// Clamp R, G, B of `image`, float and in memory, to [0, 1] as they are: of numbers, not of light. Alpha is taken as by
/// show_on_display().
void show_numbers(OIIO::ImageBuf& image);

} // namespace vmlight
