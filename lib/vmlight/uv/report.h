// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace vmlight {

/// What the texture coordinates are like, counted before any texel is.
struct UvReport
{
    int64_t triangles = 0;
    int64_t without_uv = 0; ///< a corner without texture coordinates, or with ones that are not finite
    int64_t outside = 0; ///< reaching out of the UDIM tile, which is [0,1] for 1001: the part outside is not baked
    int64_t elsewhere = 0; ///< of these, wholly outside of it, as triangles of other tiles are
    int64_t beyond = 0; ///< of all, reaching to where no UDIM tile is: u below 0 or above 10, v below 0
    int64_t degenerate_uv = 0; ///< no area in the texture (at 1/256 of a texel): covers nothing
    int64_t degenerate_3d = 0; ///< no area in space: no normal, covers nothing
    int64_t mirrored = 0; ///< clockwise in the texture
    // By count_islands() only: it takes longer than the rest.
    int64_t islands = 0; ///< parts that hang together by their texture coordinates, with area in space and in the tile
    int64_t lost_islands = 0; ///< of these, covering no texel: thinner than one, without area, or too far-reaching
    int64_t lost_triangles = 0; ///< the triangles of those
};

} // namespace vmlight
