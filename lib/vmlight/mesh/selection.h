// SPDX-License-Identifier: Apache-2.0
/// Choosing the part of a mesh that is baked, by the names of its materials and nodes.
#pragma once

#include <vmlight/base/export.h>
#include <vmlight/base/params.h>
#include <vmlight/mesh/mesh.h>

#include <cstddef>
#include <string>
#include <vector>

namespace vmlight {

/// What is baked of a mesh; the rest of its file occludes. Nothing given: all of it. Both given: what has one of the
/// materials and is below one of the nodes.
///
/// A name chooses everything of that name. If nothing has it, a `*` in it stands for any text.
struct MeshSelection
{
    std::vector<std::string> material;
    /// Each with all nodes below it.
    std::vector<std::string> node;

    bool is_all() const { return material.empty() && node.empty(); }

    template <class Visit> void visit(Visit&& field)
    {
        field("material", material, Names {}, "Bake only this material of the file, * for any text; the rest occludes");
        field("node", node, Names {},
              "Bake only this node of the file and those below it, * for any text; the rest occludes");
    }
};

/// The names by which materials and nodes are chosen: the file's, with spaces for control characters; "material_2" or
/// "node_2" for number 2, counted from 0, if that has no name.
VMLIGHT_API std::string material_name(const Mesh& mesh, size_t index);
VMLIGHT_API std::string node_name(const Mesh& mesh, size_t index);

/// The names of the nodes that are instances and have triangles with uvs, in the file's order, each as often as it has
/// one: entries of a scene list with `bake = true`, and nodes of a glTF with a mesh.
std::vector<std::string> baked_instances(const Mesh& mesh);

/// The names of the materials that triangles with texture coordinates have, in the file's order, each once.
VMLIGHT_API std::vector<std::string> baked_materials(const Mesh& mesh);

/// Find the triangles that `selection` chooses.
///
/// @param dst      set to one element a triangle
/// @param at       set to "material" or "node", where that is what is wrong
/// @returns false, with the reason in `error`, if the mesh has no material or node of a name (the error suggests the
///          nearest and lists some), or no triangle is chosen
VMLIGHT_API bool choose_triangles(std::vector<bool>& dst, const Mesh& mesh, const MeshSelection& selection,
                                  std::string& at, std::string& error);

/// The chosen triangles of `mesh` and their vertices, in the same order, bit for bit. Names, materials and nodes are
/// all there, warnings are not. Without texture coordinates if no triangle has them.
VMLIGHT_API Mesh mesh_part(const Mesh& mesh, const std::vector<bool>& chosen);

} // namespace vmlight
