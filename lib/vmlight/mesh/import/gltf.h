// SPDX-License-Identifier: Apache-2.0
/// glTF 2.0 files, read by the room gltf/.
#pragma once

#include <vmlight/mesh/import/importer.h>

#include <string>

namespace vmlight {

/// Starts as a GLB does, or as a JSON object with "asset" near its start.
bool is_gltf(const FileHead& head);

/// MeshFormat::read of .gltf and .glb: the default scene, in the pose that its nodes have and by the default weights of
/// morph targets. Normals that it lacks are flat. An extension that the file requires and that is not read is an error
/// that names it; one that is only used is a warning, if it may change the geometry. See docs/conventions.md.
bool read_gltf(MeshBuilder& dst, const ImportRequest& request, std::string& error);

} // namespace vmlight
