// SPDX-License-Identifier: Apache-2.0
/// From the polygons of an archive to parts of a mesh.
#pragma once

#include <vmlight/mesh/import/alembic/poly_mesh.h>
#include <vmlight/mesh/import/mesh_builder.h>

#include <Imath/ImathMatrix.h>

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace vmlight::alembic {

struct TriangulatedMesh
{
    struct Triangle
    {
        uint32_t face;
        std::array<uint32_t, 3> corners; ///< indices into Faces::corners
    };

    TriangulatedMesh() = default;
    /// Throws Error if a face cannot be cut into triangles. Holes have none.
    explicit TriangulatedMesh(PolyMesh polygons);

    PolyMesh polygons;
    std::vector<Triangle> triangles;
};

/// Appends meshes to a builder. Face sets are materials: everywhere the same for one name.
class MeshParts
{
public:
    explicit MeshParts(MeshBuilder& dst)
        : m_dst(dst)
    {
    }

    /// @param node     of the builder
    void append(const TriangulatedMesh& mesh, const std::string& name, const Imath::M44d& to_object, uint32_t node);

private:
    std::vector<uint32_t> materials_of(const PolyMesh& mesh);

    MeshBuilder& m_dst;
    std::map<std::string, uint32_t> m_materials;
};

} // namespace vmlight::alembic
