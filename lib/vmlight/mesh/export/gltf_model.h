// SPDX-License-Identifier: Apache-2.0
/// A mesh as a glTF document in memory, to which others may add before it is written.
#pragma once

#include <vmlight/mesh/mesh.h>
#include <vmlight/mesh/tinygltf.h>

#include <string>

namespace vmlight {

/// One buffer, one node, one mesh with a primitive for each material; see write_mesh().
tinygltf::Model gltf_model(const Mesh& mesh);

/// Append `bytes` to the model's buffer, after padding to four bytes, and a view of them. Returns the view's index.
int add_buffer_view(tinygltf::Model& model, const void* bytes, size_t size, int target = 0);

/// The file, binary.
std::string glb_bytes(tinygltf::Model& model);

} // namespace vmlight
