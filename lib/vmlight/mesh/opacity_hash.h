// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/mesh/mesh.h>

#include <string>

namespace vmlight {

/// A 64-bit hash of all that makes a mesh not opaque: its materials' alpha, with the pixels of their textures, and the
/// triangles and uvs that have them. 16 hexadecimal digits; "" if Mesh::opacity is not set. The same on every
/// little-endian machine.
std::string opacity_hash(const Mesh& mesh);

} // namespace vmlight
