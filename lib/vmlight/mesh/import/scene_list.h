// SPDX-License-Identifier: Apache-2.0
/// Scene lists: TOML files that put meshes in places.
///     # village.toml
///     [[instance]]
///     mesh = "house.obj"          # any mesh file, or another scene list
///     bake = true
///     [[instance]]
///     mesh = "tree.glb"
///     translate = [4, 0, -2]
///     rotate = [0, 30, 0]         # degrees, about the fixed axes x, then y, then z
///     scale = 1.5                 # or [x, y, z]
///     material = ["Leaf*"]        # only these; all without
/// `matrix` (12 or 16 numbers, row by row, for column vectors) stands for translate, rotate and scale. Relative paths
/// start at the folder of the list.
#pragma once

#include <vmlight/mesh/import/importer.h>

#include <Imath/ImathMatrix.h>

#include <string>
#include <vector>

namespace vmlight {

/// A place of a scene list.
struct SceneListEntry
{
    std::string mesh, name; ///< the path as it can be opened; the name, "" without
    std::vector<std::string> material;
    Imath::M44d to_object; ///< for row vectors
    bool bake = false;
    int line = 0;
};

/// TOML text that has a table array `instance`.
bool is_scene_list(const FileHead& head);

/// Parse the text of the scene list `path`, where relative paths start. False, with the reason and the line in `error`,
/// if it is not TOML, has another key, no instance, a value of another type, or a transform that is not finite or not
/// invertible.
bool parse_scene_list(std::vector<SceneListEntry>& dst, const std::string& text, const std::string& path,
                      std::string& error);

/// Read a scene list: what is baked as triangles, each entry a node of its name, and all else as Mesh::instances, each
/// file and choice of materials once. As an occluder (ImportRequest::keeps_instances) all of it is instances.
bool read_scene_list(MeshBuilder& dst, const ImportRequest& request, std::string& error);

} // namespace vmlight
