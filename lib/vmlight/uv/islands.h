// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/uv/uvraster.h>

namespace vmlight {

/// Count the islands of the mesh in this raster's tile, and those that cover no texel of it. Triangles are of one
/// island if they share texture coordinates, bit for bit, or a chain of triangles joins them so. Time grows with the
/// triangles.
void count_islands(UvReport& report, const Mesh& mesh, const UvRaster& raster);

} // namespace vmlight
