// SPDX-License-Identifier: Apache-2.0
/// EXT_mesh_gpu_instancing.
#pragma once

#include <vmlight/mesh/tinygltf.h>

#include <Imath/ImathMatrix.h>

#include <vector>

namespace vmlight::gltf {

class Document;

/// Where the mesh of a node is shown, relative to the node: once, as it is, without the extension.
/// Throws Error if an attribute is invalid, or attributes differ in their number of elements.
/// Source: Khronos, EXT_mesh_gpu_instancing.
std::vector<Imath::M44d> read_instances(Document& document, const tinygltf::Node& node);

} // namespace vmlight::gltf
