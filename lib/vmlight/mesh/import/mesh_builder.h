// SPDX-License-Identifier: Apache-2.0
/// From what a library read of a mesh file to a Mesh: the same for every format.
#pragma once

#include <vmlight/mesh/mesh.h>

#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace vmlight {

/// The smoothing group of formats that have none: smooth over all parts of the file.
constexpr uint32_t kSmoothGroup = 0xffffffff;

/// Appends the parts of a file to a mesh, each with the transform of its node. No number is trusted to be finite.
class MeshBuilder
{
public:
    /// @param dst      empty but for its names
    MeshBuilder(Mesh& dst, const MeshParams& params)
        : m_mesh(dst)
        , m_params(params)
    {
    }

    const MeshParams& params() const { return m_params; }

    /// The transform that every node hierarchy starts with: turns z up to y up, if params() or the file ask for it.
    /// @param is_file_z_up     what the file's axis metadata says; false if it has none
    Imath::M44d root_transform(bool is_file_z_up) const;

    /// @returns the index that add_triangle() takes
    uint32_t add_material(Material material);
    /// @param parent   of a node added before, or -1
    /// @returns the index that begin_part() takes
    uint32_t add_node(const std::string& name, int parent);
    /// See MeshNode::is_instance.
    void mark_instance(uint32_t node) { m_mesh.nodes[node].is_instance = true; }
    void add_camera(MeshCamera camera) { m_mesh.cameras.push_back(std::move(camera)); }
    /// Something that the user should know, as a sentence without the file's path. Said once each.
    void warn(const std::string& sentence);

    /// Start a part (a mesh under a node). As everywhere in Imath, `to_object` multiplies row vectors.
    void begin_part(const std::string& name, const Imath::M44d& to_object, uint32_t node);
    /// The triangles that follow are under another node, in the same part.
    void set_node(uint32_t node) { m_node = node; }
    /// @param normal   of any length; zero or not finite if the file has none: finish() computes it
    /// @param uv       v up, of the set params().uv_set; nullptr if the part has no such set
    void add_vertex(const Imath::V3d& position, const Imath::V3d& normal, const Imath::V2f* uv);
    /// @param corners  vertices of this part, from 0, that add_vertex() has added
    /// @param material from add_material()
    /// @param smoothing_group  how normals that the file lacks are computed: see fill_missing_normals(). Groups of
    ///                 different parts are different ones, unless both are kSmoothGroup
    void add_triangle(std::array<uint32_t, 3> corners, uint32_t material, uint32_t smoothing_group = kSmoothGroup);

    /// Normals that the file lacks are hard where its UVs part along an edge sharper than this, in degrees.
    void set_seam_angle(double degrees) { m_seam_angle = degrees; }

    /// Another mesh, held once, which add_place() shows in many places: see Mesh::instances.
    /// @returns the index that add_place() takes
    uint32_t add_distinct(Mesh mesh);
    /// Show it there.
    void add_place(uint32_t distinct, const Imath::M44d& to_object);
    const std::vector<Material>& materials() const { return m_mesh.materials; }
    /// Append a whole mesh with its materials and nodes, its triangles below `node`, where its file is in the object.
    /// Its instances come along.
    void append_mesh(const Mesh& mesh, const Imath::M44d& to_object, uint32_t node);

    /// So many vertices and triangles will be added.
    void reserve(size_t vertices, size_t triangles);

    /// No two of the vertices added agree in all, and all have a normal: finish() need not compare them.
    void set_unique_vertices() { m_has_unique_vertices = true; }

    /// The positions are the file's own, without rounding to float.
    void set_exact_positions() { m_mesh.has_exact_positions = true; }

    /// Compute the normals that are missing or asked for, say so in Mesh::normals_from, and warn of what the materials
    /// in use have that is not read.
    /// @returns false, with the reason in `error`, if there is no triangle, a vertex is not finite or beyond 1e70 (the
    ///          first is named), or a triangle has a vertex that does not exist
    bool finish(std::string& error);

private:
    Mesh& m_mesh;
    const MeshParams& m_params;
    void compute_normals();
    void warn_of_heights();

    std::string m_part, m_error;
    Imath::M44d m_to_object, m_normals_to_object;
    bool m_is_mirrored = false, m_has_uvs = false, m_has_unique_vertices = false;
    size_t m_first = 0; // vertex of the part
    uint32_t m_node = 0;
    double m_seam_angle = 180;
    TriangleIndices m_groups; // of each triangle, unique across parts
    std::map<std::pair<size_t, uint32_t>, uint32_t> m_group_numbers; // by first vertex of the part and its group
};

} // namespace vmlight
