// SPDX-License-Identifier: Apache-2.0
/// Files that a mesh file names: materials and textures.
#pragma once

#include <string>

namespace vmlight {

/// The path of the file that a file in `folder` calls `name`: there, or where an absolute name says; where it is
/// neither, as with paths of the machine that wrote it, a file of that name beside the mesh. Backslashes are slashes.
/// @returns "" if there is no such file
std::string find_side_file(const std::string& folder, const std::string& name);

/// The same; if there is no such file, where it should be.
std::string side_path(const std::string& folder, const std::string& name);

} // namespace vmlight
