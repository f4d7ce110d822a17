// SPDX-License-Identifier: Apache-2.0
/// Colour space names: those of an OCIO config, those in file names, and their interop ids.
#pragma once

#include <OpenImageIO/color.h>

#include <string>
#include <vector>

namespace vmlight {

constexpr const char* kLinearRec709 = "lin_rec709_scene";
constexpr const char* kSrgb = "srgb_rec709_scene";

/// Whether `name` is one of `names`, ignoring case.
bool is_any_of(const std::string& name, const std::vector<std::string>& names);

/// All names that users may give: spaces, aliases, roles.
std::vector<std::string> all_space_names(const OIIO::ColorConfig& config);

/// The space that `name` (a space, alias or role of the config) refers to, or "".
std::string space_named(const OIIO::ColorConfig& config, const std::string& name);

/// The space that the first known one of `names` refers to, or "".
std::string first_space_named(const OIIO::ColorConfig& config, const std::vector<const char*>& names);

/// A space that a file's path gives, or "".
struct PathSpace
{
    std::string space;
    /// Whether more than the extension gives it: a rule that looks at the name, or the name of a space in it.
    bool by_name = false;
};
/// The space by the config's file rules, except the default rule; else one whose name is a word of the file name.
PathSpace space_of_path(const OIIO::ColorConfig& config, const std::string& path);

bool is_data_space(const OIIO::ColorConfig& config, const std::string& space);

/// The interop id of a scene-linear space of the config, or its name if it has none.
std::string interop_id_of(const OIIO::ColorConfig& config, const std::string& space);

} // namespace vmlight
