// SPDX-License-Identifier: Apache-2.0
/// Mesh files of every supported format.
#pragma once

#include <vmlight/base/export.h>
#include <vmlight/mesh/mesh.h>

#include <functional>
#include <string>

namespace vmlight {

/// Read all meshes of an OBJ, PLY, STL, glTF 2.0 (.gltf, .glb), Collada, FBX or Alembic file, each at its place in the
/// node hierarchy; an image as terrain (height_grid.h); or a scene list (scene_list.h). The format is detected by
/// content, and by the extension only where content cannot tell.
///
/// Polygons are triangulated, points, lines and curves dropped, vertices that agree bit for bit merged. Triangles
/// without area are kept (they occlude nothing).
///
/// Normals are of unit length. One that is missing, zero or not finite is computed: in an OBJ as its `s` statements say
/// (flat where they are off, and before the first of them; smooth within a group; smooth if there are none), in a glTF
/// flat, in other formats smooth, but in a PLY that has texture coordinates of face corners hard where those part along
/// an edge sharper than 60 degrees. Mesh::normals_from says which.
///
/// A glTF is read in the pose that its nodes have: skins, morph targets by their default weights, instances, hidden
/// nodes left out. One that requires an extension that is not read is refused.
///
/// An Alembic file is read at MeshParams::frame; other formats ignore it. Without the Alembic library it is refused.
///
/// Texture coordinates of face corners, in an OBJ or PLY, split vertices where they differ. Materials and textures come
/// along as far as the format has them: MTL files beside an OBJ, TextureFile comments of a PLY. One that is not there
/// is a warning. The objects (`o`) of an OBJ are nodes, its groups (`g`) nodes below them.
///
/// Coordinates are rounded to float, unless an OBJ, or a PLY with `double` coordinates, has a coordinate more than 16
/// times the longest side of its bounding box: then every bit of the file's doubles is kept. An OBJ is measured by the
/// vertices that faces use, a PLY by all.
///
/// @param error        set to the reason, with the path in quotes, if the result is false
/// @param before_open  called with the path of each file before it is opened, a glTF's buffers among them
/// @returns false if the file cannot be read, ends early, has no triangle, a NaN or infinite vertex (the first is
///          named), a face that uses a vertex that does not exist, in an OBJ a statement that cannot be read (its line
///          is named) or texture coordinates that are not finite, or in a PLY a face that has texture coordinates for
///          other than all of its corners. A mesh without the UV set that was asked for is read: the caller decides
///          whether it needs one.
VMLIGHT_API bool read_mesh(Mesh& dst, const std::string& path, const MeshParams& params, std::string& error,
                           const std::function<void(const std::string& path)>& before_open = {});

/// As read_mesh(), of what only casts: a mesh that a glTF shows in several places (nodes that share it, or
/// EXT_mesh_gpu_instancing) or an Alembic file (instances) is in Mesh::instances, once, and not among the triangles;
/// skinned ones are. So is all of a scene list that is not baked, as by read_mesh().
VMLIGHT_API bool read_instanced_mesh(Mesh& dst, const std::string& path, const MeshParams& params, std::string& error,
                                     const std::function<void(const std::string& path)>& before_open = {});

} // namespace vmlight
