// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/base/file_stamp.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/vismap/normal_map.h>

#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// Read the normal map of a recipe whose paths contain no "<UDIM>", or those that the materials name, for its mesh.
///
/// @param dst      nullptr if the recipe has none, or a flat one, which changes nothing
/// @param notes    set to what was read, and to why it was left out; `warnings` to what is doubtful: one sentence each
/// @param files    nullptr, or appended to: the stamps of the textures of materials
/// @returns false, with the reason and the path in `error`, if it cannot be read or is no normal map
bool read_normal_map(NormalMapPointer& dst, const VismapRecipe& recipe, std::shared_ptr<const Mesh> mesh, int nthreads,
                     std::vector<std::string>& notes, std::vector<std::string>& warnings, std::string& error,
                     std::vector<FileStamp>* files = nullptr);

} // namespace vmlight
