// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

struct aiScene;

namespace vmlight {

/// Why the mesh importer must not go on with what it has read of a file, or "": a face with a vertex that is none,
/// which assimp 5.2 passes on from cut and damaged PLYs, and reads beyond its memory when it cuts polygons.
std::string mesh_scene_fault(const aiScene& scene);

/// Have the kinds of faces that each mesh says it has be those that it has. assimp 5.2 takes a face without corners for
/// a polygon, and ends the process when it finds no polygon to cut.
void correct_primitive_types(aiScene& scene);

} // namespace vmlight
