// SPDX-License-Identifier: Apache-2.0
/// Conversion of environments and albedo to the scene-linear working space, with OIIO's ColorConfig (OpenColorIO).
#pragma once

#include <vmlight/base/export.h>

#include <OpenImageIO/imagebuf.h>

#include <functional>
#include <string>
#include <vector>

namespace vmlight {

struct ColorSettings
{
    /// OCIO config file; "" means $OCIO, or no config if that is not set.
    std::string config;
    /// Colour space of the image; "" means by its name and labels.
    std::string from;
    /// Pixel type in the file, if the image in memory has another.
    OIIO::TypeDesc stored {};
    /// Interop id of the working space where there is no config; "" means linear Rec.709.
    std::string working {};
    /// Believe the file's own labels alone, not its name: for a CFEM, whatever it is called.
    bool labels_only = false;
};

/// Convert `image` in place to the config's role `scene_linear`, and tag it with that space.
///
/// The source space is the first of: `settings.from`; the config's file rule for `path`, if it looks at more than the
/// extension, or a space whose name is a word of the file name; the file's `colorInteropID`; its `chromaticities`, if
/// of known primaries; the config's rule for the extension; sRGB for 8 and 16 bit integers; the working space. A known
/// space that the config lacks is converted by a matrix. Without a config the working space is linear Rec.709, and sRGB
/// and known primaries are converted; a file that is tagged with another space keeps its pixels and tag.
///
/// @param image    R, G, B (or one channel) are converted; alpha, other channels and non-finite pixels are not.
///                 A converted image becomes float and owns its memory.
/// @param note     set to a line for the user: "Linear Rec.709 (sRGB) -> ACEScg"
/// @param error    set if the config cannot be read or lacks a space (it suggests the closest name), or a program has
///                 converted the pixels and kept the label that would decide
/// @param nthreads 0 means OIIO's default
/// @param warnings if set, gets a line for each label that contradicts another or is not understood
/// @returns false on error; `image` is then unchanged. Not checked: that the image really is in its source space.
VMLIGHT_API bool to_scene_linear(OIIO::ImageBuf& image, const std::string& path, const ColorSettings& settings,
                                 std::string& note, std::string& error, int nthreads = 0,
                                 std::vector<std::string>* warnings = nullptr);

/// Converts RGB triples in place, on any thread, except those that are not finite. Empty if nothing is to be converted.
using ColorConversion = std::function<void(float* rgb, int count)>;

/// What to_scene_linear() would do, for pixels that are read later: sets `conversion`, and tags `spec`, read from the
/// file `path`, as it would tag the image.
VMLIGHT_API bool describe_scene_linear(OIIO::ImageSpec& spec, ColorConversion& conversion, const std::string& path,
                                       const ColorSettings& settings, std::string& note, std::string& error,
                                       std::vector<std::string>* warnings = nullptr);
/// The same, for the tags only.
VMLIGHT_API bool describe_scene_linear(OIIO::ImageSpec& spec, const std::string& path, const ColorSettings& settings,
                                       std::string& error);

/// How to_scene_linear() would convert the colours of a file with this header, such as "sRGB -> ACEScg"; "" if it would
/// leave them as they are, or fail.
std::string conversion_note(const OIIO::ImageSpec& spec, const std::string& path, const ColorSettings& settings);

/// Convert R, G, B of a float image in memory by `conversion`, which may be empty, and tag it with `interop_id`.
/// nthreads: 0 means OIIO's default.
void convert_color(OIIO::ImageBuf& image, const ColorConversion& conversion, const std::string& interop_id,
                   int nthreads);

/// Tag `spec` as scene-linear colour of the working space: `colorInteropID`, and `chromaticities` of the ids
/// that primaries.h knows. Removes all earlier colour metadata.
VMLIGHT_API void tag_scene_linear(OIIO::ImageSpec& spec, const std::string& interop_id);
/// Tag `spec` as data that colour management must not convert.
VMLIGHT_API void tag_data(OIIO::ImageSpec& spec);

} // namespace vmlight
