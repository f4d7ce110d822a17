// SPDX-License-Identifier: Apache-2.0
/// Where a shadow has its edge, from one ray of each texel: more rays are worth it there alone.
#pragma once

#include <vmlight/base/tile_size.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace vmlight {

/// Texels of a tile whose one ray met something, or nothing: bit x of word y. Of others nothing is known.
struct LookedTile
{
    std::array<uint64_t, kTileSize> blocked {}, seen {};

    void set(int x, int y, bool is_seen) { (is_seen ? seen : blocked)[size_t(y)] |= uint64_t(1) << x; }
};

/// A tile and the eight around it, row by row, the tile itself in the middle; nullptr where the map has none.
using LookedAround = std::array<const LookedTile*, 9>;

/// The texels of the tile in the middle that do not agree with one of the 24 around them, or that have fewer than four
/// of the eight beside them to tell: one less than those of a straight edge have.
std::array<uint64_t, kTileSize> penumbra(const LookedAround& tiles);

} // namespace vmlight
