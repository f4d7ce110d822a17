// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/uv/raster.h>

#include <cstdint>
#include <vector>

namespace vmlight {

/// Count the UV islands of the mesh in the raster's UDIM tile, and those that cover no texel. Triangles that share
/// texture coordinates (equal bit for bit), directly or through others, are one island. Linear in the triangles.
void count_islands(UvReport& report, const Mesh& mesh, const UvRaster& raster);

/// For each triangle a number that all triangles of its island have, whatever their UDIM tile, and no other.
std::vector<uint32_t> triangle_islands(const Mesh& mesh);

} // namespace vmlight
