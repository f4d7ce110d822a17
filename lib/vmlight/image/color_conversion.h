// SPDX-License-Identifier: Apache-2.0
/// Spaces of a config or known without one, and the conversions between them.
#pragma once

#include <vmlight/image/color.h>
#include <vmlight/image/primaries.h>

#include <OpenImageIO/color.h>

#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// Names of sRGB textures in configs of all ages.
extern const std::vector<const char*> kSrgbNames;

/// The space of an image's pixels: one of the config, or a linear one that only vmlight knows.
struct SourceSpace
{
    std::string name;
    const LinearSpace* unlisted = nullptr; ///< if it is not in the config
    bool is_data = false;
    /// What decided, to end a note: "" unless the file says it in a way that its name does not show.
    const char* reason = "";

    bool found() const { return !name.empty(); }
};

/// The interop id of a space, or its name: several names may be one space.
std::string id_of(const OIIO::ColorConfig& config, const SourceSpace& source);

/// A known linear space, by its name in the config if that has it.
SourceSpace linear_source(const OIIO::ColorConfig& config, const LinearSpace& space);

/// The space with this name, alias, role or interop id; not found() if neither the config nor vmlight has it.
SourceSpace source_named(const OIIO::ColorConfig& config, const std::string& name);

/// Open the config `name`, a file or one built into OpenColorIO. nullptr, with the reason in `error`, if it cannot be
/// read or has no role scene_linear.
std::unique_ptr<OIIO::ColorConfig> open_color_config(const std::string& name, std::string& error);

ColorConversion matrix_conversion(const LinearSpace& from, const LinearSpace& to);

ColorConversion one_after_the_other(ColorConversion first, ColorConversion second);

/// Set `dst` to the conversion between two spaces, empty if nothing changes. From or to a space that the config does
/// not have it goes by a matrix to one that it has. False, with the reason in `error`, if there is no way.
bool conversion_between(ColorConversion& dst, OIIO::ColorConfig& config, const std::string& config_name,
                        const SourceSpace& from, const SourceSpace& to, std::string& error);

} // namespace vmlight
