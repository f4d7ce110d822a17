// SPDX-License-Identifier: Apache-2.0
/// Meshes and strands as files, for renderers: what was baked, with the UVs of the map.
#pragma once

#include <vmlight/base/export.h>
#include <vmlight/mesh/mesh.h>
#include <vmlight/mesh/strands.h>

#include <string>
#include <vector>

namespace vmlight {

/// "" if the extension of `path` is that of a format that is written, else the reason why not.
VMLIGHT_API std::string mesh_name_fault(const std::string& path);

/// Write a mesh as OBJ or binary glTF (.glb), as the extension says: triangles in their order (in a glTF, of each
/// material in turn), positions, normals, UVs, names of materials and their base colours; not their textures. An OBJ
/// has every bit of every coordinate, and its materials in a second file, .mtl, beside it. A glTF has floats, and where
/// those do not hold the positions, a node that moves and scales them to where they do.
///
/// Files are replaced atomically, each for itself.
/// @returns false, with the reason in `error`, if the format is unknown, the mesh fails check_mesh(), or a file cannot
///          be written
VMLIGHT_API bool write_mesh(const Mesh& mesh, const std::string& path, std::string& error);

/// Write strands as polylines in their order, with all their points: `l` statements of an OBJ, or LINE_STRIPs of a .glb
/// that share one array of points. Neither has the radius. Coordinates as write_mesh() writes them.
///
/// @param strands  must have passed check_strands()
/// @param uvs      of each point, v up
bool write_strands(const Strands& strands, const std::vector<Imath::V2f>& uvs, const std::string& path,
                   std::string& error);

} // namespace vmlight
