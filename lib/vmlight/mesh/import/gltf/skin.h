// SPDX-License-Identifier: Apache-2.0
/// Skins: vertices that follow joints.
#pragma once

#include <vmlight/mesh/import/gltf/primitive.h>

#include <Imath/ImathMatrix.h>

#include <vector>

namespace vmlight::gltf {

class Document;

/// Move the vertices of a primitive to where the joints of a skin put them, in the file's space, in the pose that the
/// nodes have; the transform of the mesh's own node plays no part. Normals turn along. Weights are divided by their
/// sum; vertices without weight stay where they are. Where joints mirror, triangles are turned round.
///
/// @param transforms   node_transforms()
///
/// Throws Error if the skin or a joint does not exist, or its matrices are too few.
/// Source: Khronos, glTF 2.0 specification, 3.7.3 (skins).
void apply_skin(Primitive& primitive, Document& document, int skin, const std::vector<Imath::M44d>& transforms);

} // namespace vmlight::gltf
