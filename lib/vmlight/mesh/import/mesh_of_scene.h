// SPDX-License-Identifier: Apache-2.0
/// What the mesh importer hands over, made a Mesh.
#pragma once

#include <vmlight/mesh/import/assimp_scene.h>
#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/mesh/mesh.h>

#include <string>

namespace vmlight {

/// Set the triangles of `dst` to those of `scene`, as read_mesh() does for its file; names stay.
///
/// @param scene, exact     as read_scene() sets them; of `scene` no number is believed to be finite
/// @returns false, with the reason in `error`, if there is no triangle or a vertex is not finite
bool mesh_of_scene(Mesh& dst, const aiScene& scene, const ExactPositions& exact, const MeshParams& params,
                   std::string& error);

} // namespace vmlight
