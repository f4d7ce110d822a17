// SPDX-License-Identifier: Apache-2.0
/// The normal maps that the materials of a mesh name, as one map.
#pragma once

#include <vmlight/base/file_stamp.h>
#include <vmlight/mesh/mesh.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/vismap/normal_map.h>

#include <string>
#include <vector>

namespace vmlight {

/// Read the normal maps of the materials that triangles have, each for the texels of its triangles. Texels of materials
/// without one stay as they are, and so do those of one that is not in the UVs that are baked: of another UV set, with
/// a transform, or beyond [0, 1] where it does not repeat; `warnings` says so.
///
/// @param recipe   whose UV set, size and UDIM tile are baked
/// @param notes    appended to: what was read
/// @param files    nullptr, or appended to: the stamps of the textures
/// @returns false, with the reason in `error`, if a texture is missing, cannot be read, or is no normal map
bool read_material_normals(NormalMap& dst, const VismapRecipe& recipe, const Mesh& mesh, int nthreads,
                           std::vector<std::string>& notes, std::vector<std::string>& warnings,
                           std::vector<FileStamp>* files, std::string& error);

} // namespace vmlight
