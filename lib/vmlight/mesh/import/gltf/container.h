// SPDX-License-Identifier: Apache-2.0
/// The parts of a glTF file: of a .gltf its text, of a GLB its chunks.
#pragma once

#include <vmlight/mesh/import/gltf/error.h>

#include <string>

namespace vmlight::gltf {

/// The JSON is a copy, the rest points into the file.
struct Container
{
    std::string json; ///< as UTF-8: invalid bytes became question marks. Without byte order mark
    Bytes binary; ///< the GLB's binary chunk, or nothing
};

/// Split a file into its parts. Throws Error if a GLB ends early, is of another version, or has no JSON.
/// Source: Khronos, glTF 2.0 specification, 4.4 (GLB).
Container split_file(const std::string& file);

} // namespace vmlight::gltf
