// SPDX-License-Identifier: Apache-2.0
/// The polygons of a mesh at one moment.
#pragma once

#include <vmlight/mesh/import/alembic/geom_param.h>

#include <Imath/ImathVec.h>

#include <cstdint>
#include <string>
#include <vector>

namespace vmlight::alembic {

/// In the space of its object. Faces are counter-clockwise seen from outside: in the file they are clockwise.
struct PolyMesh
{
    Faces faces;
    std::vector<Imath::V3d> positions;
    GeomParam uvs, normals;
    std::vector<std::string> face_sets; ///< the names of its face sets
    std::vector<int> face_set; ///< for each face, the first face set that has it, or -1
    std::vector<bool> is_hole; ///< for each face of a subdivision surface; empty if there are none
    std::vector<std::string> faults; ///< what of it is not read, each as a sentence
};

bool is_poly_mesh(const AbcA::ObjectHeader& header);
/// Subdivision surfaces are read as their control cages.
bool is_subdivision_surface(const AbcA::ObjectHeader& header);
bool is_face_set(const AbcA::ObjectHeader& header);

/// Read a polygon mesh or a subdivision surface. Where its faces stay the same, positions and normals between two
/// samples are interpolated; texture coordinates, and all of a mesh whose faces change, are those of the earlier
/// sample. Throws Error if a face uses a vertex that does not exist, or there are not as many corners as faces need.
PolyMesh read_poly_mesh(AbcA::ObjectReader& object, Moment& moment, int uv_set);

} // namespace vmlight::alembic
