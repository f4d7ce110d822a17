// SPDX-License-Identifier: Apache-2.0
/// The only place that drives the mesh importer.
#pragma once

#include <Imath/ImathVec.h>
#include <assimp/Importer.hpp>
#include <assimp/scene.h>

#include <functional>
#include <string>
#include <vector>

namespace vmlight {

/// The vertices of each mesh of a scene in double, or empty: those of the importer are as good as the file's.
using ExactPositions = std::vector<std::vector<Imath::V3d>>;

/// Read a file's scene, its polygons cut into triangles; every index is in range. The importer owns the scene.
///
/// @param exact    set where the file's doubles hold what floats lose (MeshFile::positions): the vertices of the scene
///                 are then moved
/// @param opens    called with the path of each file before it is opened
/// @returns nullptr, with the reason in `error`, if the file cannot be read
const aiScene* read_scene(Assimp::Importer& importer, const std::string& path, ExactPositions& exact,
                          const std::function<void(const std::string& path)>& opens, std::string& error);

} // namespace vmlight
