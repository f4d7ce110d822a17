// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace vmlight {

/// Statistics of a mesh's texture coordinates.
struct UvReport
{
    int64_t triangles = 0;
    int64_t without_uv = 0; ///< with a corner whose texture coordinates are missing or not finite
    int64_t outside
        = 0; ///< partly or fully outside the UDIM tile, which is [0,1] for 1001; only the part inside is baked
    int64_t fully_outside = 0; ///< of these, fully outside, like triangles of other tiles
    int64_t beyond_udims = 0; ///< partly outside every UDIM tile: u below 0 or above 10, or v below 0
    int64_t degenerate_uv = 0; ///< without area in UV (at 1/256 of a texel): cover nothing
    int64_t degenerate_3d = 0; ///< without area in space: no normal, cover nothing
    int64_t mirrored = 0; ///< clockwise in UV
    // Only set by count_islands(), which takes longer than the rest.
    int64_t islands = 0; ///< groups of triangles connected in UV, with area in space, in the tile
    int64_t uncovered_islands = 0; ///< of these, covering no texel: thinner than a texel, without area, or too far away
    int64_t uncovered_triangles = 0; ///< triangles of those
};

} // namespace vmlight
