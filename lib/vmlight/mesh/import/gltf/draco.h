// SPDX-License-Identifier: Apache-2.0
/// Primitives compressed by Draco.
#pragma once

#include <vmlight/mesh/import/gltf/accessor.h>
#include <vmlight/mesh/tinygltf.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace vmlight::gltf {

class Document;

/// What a Draco payload holds of a primitive.
struct DracoPrimitive
{
    std::map<std::string, Numbers> attributes; ///< by glTF's names: "POSITION"
    std::vector<uint32_t> indices;
};

/// Decompress a primitive that has the extension KHR_draco_mesh_compression.
/// @param wanted   the attributes to decode
///
/// Throws Error if the extension is invalid, or Draco cannot decode the bytes.
/// Source: Khronos, KHR_draco_mesh_compression.
DracoPrimitive decompress_draco(Document& document, const tinygltf::Primitive& primitive,
                                const std::vector<std::string>& wanted);

} // namespace vmlight::gltf
