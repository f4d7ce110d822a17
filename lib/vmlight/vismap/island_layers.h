// SPDX-License-Identifier: Apache-2.0
/// Islands of a tile that can be reconstructed together: a cell between two islands is what lies beyond the seam of
/// one, or of the other.
#pragma once

#include <vmlight/base/tile_size.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace vmlight {

struct TexelContext;

/// A texel that stands for the surface beyond a seam, at (x, y) from the first of the tile, for one island alone.
struct Continuation
{
    uint32_t island;
    int x, y; ///< as for Reconstruction::add()
    const float* texel; ///< as it was baked; must stay where it is until apply()
    const TexelContext* context;
};

struct IslandLayer
{
    /// The layer's own texels; bit x of word y.
    std::array<uint64_t, kTileSize> texels {};
    /// Ranges of continuations.
    std::vector<std::pair<size_t, size_t>> continuations;
};

/// Share out a tile's texels among layers, so that none reads a cell that stands for different things in it. Islands
/// without continuations are one layer, and so are those that too many others are near to.
///
/// @param islands  of the tile's texels, row by row; kNoIsland where no triangle covers one
/// @param continuations    those of an island one after the other
constexpr uint32_t kNoIsland = ~0u;
std::vector<IslandLayer> layers_of_islands(const std::vector<uint32_t>& islands,
                                           const std::vector<Continuation>& continuations);

} // namespace vmlight
