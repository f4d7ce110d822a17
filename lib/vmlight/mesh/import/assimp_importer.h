// SPDX-License-Identifier: Apache-2.0
/// Meshes through assimp, which only this header, its sources and polygons.cpp include.
#pragma once

#include <vmlight/mesh/import/importer.h>

#include <string>
#include <vector>

struct aiScene;

namespace vmlight {

/// MeshFormat::read of the formats that assimp reads. Only the assimp importer whose first extension is the format's
/// is given the file, whatever the file is called.
bool read_with_assimp(MeshBuilder& dst, const ImportRequest& request, std::string& error);

/// Append every triangle under the root node of what assimp imported. Every index must be in range; no number is
/// trusted to be finite. Recurses as deep as the node hierarchy.
/// @param folder   of the file, where the paths of textures start
void append_imported(MeshBuilder& dst, const aiScene& imported, const std::string& folder);

/// What assimp says of the file's materials, in its order.
std::vector<Material> materials_of(const aiScene& imported, const std::string& folder);

/// Why assimp must not process further what it has imported, or "": a face with a vertex that does not exist, which
/// assimp 5.2 passes on from damaged files, and reads beyond its memory when it triangulates.
std::string face_error(const aiScene& imported);

} // namespace vmlight
