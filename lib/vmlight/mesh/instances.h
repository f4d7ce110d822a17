// SPDX-License-Identifier: Apache-2.0
/// Meshes that are in many places, and are held once.
#pragma once

#include <vmlight/base/export.h>
#include <vmlight/mesh/mesh.h>

#include <Imath/ImathMatrix.h>

#include <cstdint>
#include <string>
#include <vector>

namespace vmlight {

struct MeshInstances
{
    struct Place
    {
        uint32_t mesh = 0; ///< an index into `meshes`
        Imath::M44d to_object; ///< from its space; as everywhere in Imath, for row vectors
    };
    /// Distinct ones, without instances of their own.
    std::vector<Mesh> meshes;
    std::vector<Place> places;

    /// Triangles of all places; and of all distinct meshes.
    VMLIGHT_API int64_t triangles() const;
    VMLIGHT_API int64_t distinct_triangles() const;
};

/// The triangles of `mesh` in one place, as they would be read there: a mirror turns their winding and keeps the
/// outside out. Normals are turned along; materials and opacity are kept.
VMLIGHT_API Mesh placed_mesh(const Mesh& mesh, const Imath::M44d& to_object);

/// As check_mesh(), for each distinct mesh; and false if a place has a mesh that does not exist, or a transform that is
/// not finite.
bool check_instances(const Mesh& mesh, std::string& error);

/// Triangles in memory: of a mesh and the distinct meshes of its instances.
int64_t held_triangles(const Mesh& mesh);

} // namespace vmlight
