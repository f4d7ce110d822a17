// SPDX-License-Identifier: Apache-2.0
/// Mesh files, of every format that there is an importer for.
#pragma once

#include <vmlight/base/export.h>
#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/mesh/mesh.h>

#include <functional>
#include <string>

namespace vmlight {

/// Read every mesh of a file (OBJ, PLY, glTF, GLB, FBX, and what else assimp reads), at its place in the scene graph.
///
/// Polygons are triangulated, points and lines dropped, vertices that agree bit for bit merged. Normals are of unit
/// length; a zero or non-finite one is made as a smooth one. Triangles without area stay (they still occlude nothing).
/// Coordinates are rounded to float, as assimp delivers them, but for an OBJ, or a PLY of `double` coordinates, whose
/// greatest coordinate is more than 16 times its greatest side: those keep every bit of the file's doubles. Of an OBJ
/// the vertices that faces use are counted, of a PLY all.
///
/// @param error    set to what is wrong, with the path in quotes, if the result is false
/// @param opens    called with the path of each file before it is opened, the buffers of a glTF among them
/// @returns false if the file cannot be read, ends early, has no triangle, a NaN or infinite vertex (the first is
///          named), a face of a vertex that it has not, or, in an OBJ, texture coordinates that are not finite.
///          A mesh without the asked-for texture coordinates is read: whether they are needed is the caller's matter.
VMLIGHT_API bool read_mesh(Mesh& dst, const std::string& path, const MeshParams& params, std::string& error,
                           const std::function<void(const std::string& path)>& opens = {});

} // namespace vmlight
