// SPDX-License-Identifier: Apache-2.0
/// Buffer views compressed by meshoptimizer.
#pragma once

#include <vmlight/mesh/tinygltf.h>

#include <cstdint>
#include <vector>

namespace vmlight::gltf {

class Document;

/// Decompress a buffer view.
///
/// @param extension    the view's EXT_meshopt_compression
/// @param view         its index, for messages
///
/// Throws Error if a parameter is out of its range, the view claims more than its bytes can hold (64 times for
/// attributes, 3 indices a byte), or the bytes are invalid.
/// Source: Khronos, EXT_meshopt_compression; meshoptimizer 0.18.
std::vector<uint8_t> decompress_meshopt(Document& document, const tinygltf::Value& extension, int view);

} // namespace vmlight::gltf
