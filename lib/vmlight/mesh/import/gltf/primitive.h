// SPDX-License-Identifier: Apache-2.0
/// The triangles of a glTF primitive.
#pragma once

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vmlight::gltf {

class Document;

/// Vertices and triangles in the space of the mesh, before any skin. Attributes that the file lacks are empty.
struct Primitive
{
    std::vector<Imath::V3d> positions, normals;
    std::vector<Imath::V2f> uvs; ///< v up
    std::vector<std::array<uint32_t, 3>> triangles;
    /// Of each vertex, for skins: as many joints as weights, `influences` each.
    size_t influences = 0;
    std::vector<uint32_t> joints;
    std::vector<double> weights;
};

/// Read a primitive, compressed or not, in the pose of its morph targets' weights. Points and lines have no triangles.
///
/// @param weights      of the morph targets; missing ones are 0
/// @param uv_set       the set that `uvs` are of
/// @param with_skin    read joints and weights
///
/// Throws Error if an accessor is invalid, attributes differ in their number of elements, or an index is out of range.
/// Source: Khronos, glTF 2.0 specification, 3.7.2 (meshes) and 3.7.3 (skins).
Primitive read_primitive(Document& document, int mesh, int primitive, const std::vector<double>& weights, int uv_set,
                         bool with_skin);

} // namespace vmlight::gltf
