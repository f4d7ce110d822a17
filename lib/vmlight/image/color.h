// SPDX-License-Identifier: Apache-2.0
/// Conversion of environments and albedo to the scene-linear working space, with OIIO's ColorConfig (OpenColorIO).
#pragma once

#include <vmlight/base/export.h>

#include <OpenImageIO/imagebuf.h>

#include <functional>
#include <string>

namespace vmlight {

struct ColorSettings
{
    /// OCIO config file; "" means $OCIO, or no config if that is not set.
    std::string config;
    /// Colour space of the image; "" means the config's file rules, then the file's metadata.
    std::string from;
    /// Pixel type in the file, if the image in memory has another.
    OIIO::TypeDesc stored {};
};

/// Convert `image` in place to the config's role `scene_linear`, and tag it with that space.
///
/// The source space is the first of: `settings.from`; the config's file rules for `path`, if a rule other than the
/// default matches; a space whose name is a word of the file name; the file's `colorInteropID`; sRGB for 8 and 16 bit
/// integers; the working space. Without a config the working space is linear Rec.709 and only sRGB is converted; a file
/// that is tagged with another space keeps its pixels and tag.
///
/// @param image    R, G, B (or one channel) are converted; alpha, other channels and non-finite pixels are not.
///                 A converted image becomes float and owns its memory.
/// @param note     set to a line for the user: "Linear Rec.709 (sRGB) -> ACEScg"
/// @param error    set if the config cannot be read or lacks a space (it suggests the closest name)
/// @param nthreads 0 means OIIO's default
/// @returns false on error; `image` is then unchanged. Not checked: that the image really is in its source space.
VMLIGHT_API bool to_scene_linear(OIIO::ImageBuf& image, const std::string& path, const ColorSettings& settings,
                                 std::string& note, std::string& error, int nthreads = 0);

/// Converts RGB triples in place, on any thread, except those that are not finite. Empty if nothing is to be converted.
using ColorConversion = std::function<void(float* rgb, int count)>;

/// What to_scene_linear() would do, for pixels that are read later: sets `conversion`, and tags `spec`, read from the
/// file `path`, as it would tag the image.
VMLIGHT_API bool describe_scene_linear(OIIO::ImageSpec& spec, ColorConversion& conversion, const std::string& path,
                                       const ColorSettings& settings, std::string& note, std::string& error);
/// The same, for the tags only.
VMLIGHT_API bool describe_scene_linear(OIIO::ImageSpec& spec, const std::string& path, const ColorSettings& settings,
                                       std::string& error);

/// Tag `spec` as scene-linear colour of the working space: `colorInteropID`, and `chromaticities` of the ids
/// lin_ap1_scene, lin_ap0_scene and lin_rec709_scene. Removes all earlier colour metadata.
VMLIGHT_API void tag_scene_linear(OIIO::ImageSpec& spec, const std::string& interop_id);
/// Tag `spec` as data that colour management must not convert.
VMLIGHT_API void tag_data(OIIO::ImageSpec& spec);

} // namespace vmlight
