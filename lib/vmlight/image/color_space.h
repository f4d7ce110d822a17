// SPDX-License-Identifier: Apache-2.0
/// Colour spaces by name: those of an OCIO config, those that a file's name tells, and their interop ids.
#pragma once

#include <OpenImageIO/color.h>

#include <string>
#include <vector>

namespace vmlight {

constexpr const char* kLinearRec709 = "lin_rec709_scene";
constexpr const char* kSrgb = "srgb_rec709_scene";

/// Is `name` one of `names`, in any case?
bool is_any_of(const std::string& name, const std::vector<std::string>& names);

/// Every name that a user may give: spaces, their aliases, roles.
std::vector<std::string> all_space_names(const OIIO::ColorConfig& config);

/// The space that `name` (a space, alias or role) stands for, or "". Only names that the config itself has count.
std::string space_named(const OIIO::ColorConfig& config, const std::string& name);

/// The space of the first of `names` that stands for one, or "".
std::string first_space_named(const OIIO::ColorConfig& config, const std::vector<const char*>& names);

/// The space by the config's file rules (the default one aside), else the one whose name is a word of the file's name,
/// or "".
std::string space_of_path(const OIIO::ColorConfig& config, const std::string& path);

bool is_data_space(const OIIO::ColorConfig& config, const std::string& space);

/// The interop id of a scene-linear space of the config, or its own name where it has none.
std::string interop_id_of(const OIIO::ColorConfig& config, const std::string& space);

/// The xy of red, green, blue and white (8 numbers) of a scene-linear interop id, or nullptr if it is not known.
const float* chromaticities_of(const std::string& interop_id);

} // namespace vmlight
