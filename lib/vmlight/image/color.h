// SPDX-License-Identifier: Apache-2.0
/// Environments and albedo into the scene-linear working space, by OIIO's ColorConfig (OpenColorIO).
#pragma once

#include <vmlight/base/export.h>

#include <OpenImageIO/imagebuf.h>

#include <functional>
#include <string>

namespace vmlight {

struct ColorSettings
{
    /// OCIO config file; "" means $OCIO, and if that is not set, no config.
    std::string config;
    /// Colour space of the image; "" means: ask the config's file rules, then the file's own metadata.
    std::string from;
    /// Pixel type in the file, for an image in memory that no longer tells.
    OIIO::TypeDesc stored {};
};

/// Convert `image` in place into the config's role `scene_linear`, and tag it with its space.
///
/// The space it comes from is the first of: `settings.from`; the config's file rules for `path`, when a rule other than
/// the default one matches; a space's name that stands as a word in the file's name; the file's `colorInteropID`; sRGB
/// for images of 8 or 16 bits whole numbers; else the working space itself. Without a config the working space is
/// linear with the primaries of Rec.709 and only sRGB is converted; a file whose tag says another space keeps
/// its pixels and its tag.
///
/// @param image    R, G, B (or one channel) are converted, alpha and other channels are not; a pixel that is not finite
///                 stays as it is. An image that is converted becomes float, in memory of its own.
/// @param note     set to one line that says what was done: "Linear Rec.709 (sRGB) -> ACEScg"
/// @param error    set if the config cannot be read, or a space is not in it (the nearest name is told)
/// @param nthreads 0 means OIIO's default
/// @returns false on error; `image` is then as it was. Not checked: that the named space is true.
VMLIGHT_API bool to_scene_linear(OIIO::ImageBuf& image, const std::string& path, const ColorSettings& settings,
                                 std::string& note, std::string& error, int nthreads = 0);

/// Converts RGB triples in place, on any thread; one that is not finite stays as it is. None: all stay.
using ColorConversion = std::function<void(float* rgb, int count)>;

/// What to_scene_linear() would do to the pixels of an image that are read later. Tags `spec`, read from the file
/// `path`, as it would tag the image: no pixel is looked at.
VMLIGHT_API bool describe_scene_linear(OIIO::ImageSpec& spec, ColorConversion& conversion, const std::string& path,
                                       const ColorSettings& settings, std::string& note, std::string& error);
/// The same, of which the tags alone are wanted.
VMLIGHT_API bool describe_scene_linear(OIIO::ImageSpec& spec, const std::string& path, const ColorSettings& settings,
                                       std::string& error);

/// Tag `spec` as scene-linear colour of the working space: `colorInteropID`, and `chromaticities` of the ids
/// lin_ap1_scene, lin_ap0_scene and lin_rec709_scene. What the spec said of its colour before is dropped.
VMLIGHT_API void tag_scene_linear(OIIO::ImageSpec& spec, const std::string& interop_id);
/// Tag `spec` as data that no tool may convert.
VMLIGHT_API void tag_data(OIIO::ImageSpec& spec);

} // namespace vmlight
