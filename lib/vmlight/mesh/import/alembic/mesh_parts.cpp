// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/alembic/mesh_parts.h>

#include <vmlight/base/unique_index.h>
#include <vmlight/mesh/import/alembic/error.h>
#include <vmlight/mesh/import/polygons.h>

#include <utility>

namespace vmlight::alembic {

using Imath::V2f;
using Imath::V3d;

TriangulatedMesh::TriangulatedMesh(PolyMesh given)
    : polygons(std::move(given))
{
    std::string error;
    const auto add = [&](size_t face, const std::array<uint32_t, 3>& corners) {
        if (polygons.is_hole.empty() || !polygons.is_hole[face])
            triangles.push_back({ uint32_t(face), corners });
    };
    if (!visit_triangles(
            polygons.faces.ends, [&](uint32_t corner) { return polygons.positions[polygons.faces.corners[corner]]; },
            false, add, error))
        throw Error(error);
}

void MeshParts::append(const TriangulatedMesh& triangulated, const std::string& name, const Imath::M44d& to_object,
                       uint32_t node)
{
    struct Corner
    {
        uint32_t vertex, uv, normal;
    };
    const PolyMesh& mesh = triangulated.polygons;
    UniqueIndex<Corner> vertices(mesh.faces.corners.size());
    size_t count = 0;
    m_dst.begin_part(name, to_object, node);
    const auto vertex_of = [&](uint32_t corner) {
        const uint32_t vertex = mesh.faces.corners[corner];
        const uint32_t uv = mesh.uvs.exists() ? mesh.uvs.values[corner] : 0;
        const uint32_t normal = mesh.normals.exists() ? mesh.normals.values[corner] : 0;
        const uint32_t index = vertices.index_of({ vertex, uv, normal });
        if (index == count) {
            ++count;
            const float* n = mesh.normals.exists() ? &mesh.normals.numbers[3 * size_t(normal)] : nullptr;
            const float* t = mesh.uvs.exists() ? &mesh.uvs.numbers[2 * size_t(uv)] : nullptr;
            const V2f coordinates = t ? V2f(t[0], t[1]) : V2f(0);
            m_dst.add_vertex(mesh.positions[vertex], n ? V3d(n[0], n[1], n[2]) : V3d(0), t ? &coordinates : nullptr);
        }
        return index;
    };
    const std::vector<uint32_t> materials = materials_of(mesh);
    for (const TriangulatedMesh::Triangle& triangle : triangulated.triangles) {
        const uint32_t a = vertex_of(triangle.corners[0]), b = vertex_of(triangle.corners[1]),
                       c = vertex_of(triangle.corners[2]);
        m_dst.add_triangle({ a, b, c }, materials[size_t(mesh.face_set[triangle.face] + 1)]);
    }
}

// The material of faces without a face set, then those of the face sets.
std::vector<uint32_t> MeshParts::materials_of(const PolyMesh& mesh)
{
    std::vector<std::string> names { "" };
    names.insert(names.end(), mesh.face_sets.begin(), mesh.face_sets.end());
    std::vector<bool> used(names.size(), false);
    for (const int set : mesh.face_set)
        used[size_t(set + 1)] = true;
    std::vector<uint32_t> materials(names.size(), 0);
    for (size_t i = 0; i < names.size(); ++i) {
        if (!used[i])
            continue;
        auto known = m_materials.find(names[i]);
        if (known == m_materials.end()) {
            Material material;
            material.name = names[i];
            known = m_materials.emplace(names[i], m_dst.add_material(std::move(material))).first;
        }
        materials[i] = known->second;
    }
    return materials;
}

} // namespace vmlight::alembic
