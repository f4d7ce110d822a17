// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/mesh/mesh.h>
#include <vmlight/mesh/tinygltf.h>

#include <Imath/ImathMatrix.h>

namespace vmlight::gltf {

/// The camera of `node`, which has one, at `to_object` (for row vectors). Its name is its own, else the node's. Throws
/// Error if the camera does not exist, or its numbers or its transform make no picture: an angle of view of 0 or of 180
/// degrees and more, or a scale of 0.
MeshCamera read_camera(const tinygltf::Model& model, const tinygltf::Node& node, const Imath::M44d& to_object);

} // namespace vmlight::gltf
