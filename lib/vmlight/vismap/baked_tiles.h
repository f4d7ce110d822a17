// SPDX-License-Identifier: Apache-2.0
/// Tiles of a map as they are kept, and their texels wherever they are in the map.
#pragma once

#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/reconstruct_map.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

namespace vmlight {

/// A tile of kTileSize x kTileSize texels.
struct MapTile
{
    /// Rows without padding; empty if all values are 0.
    std::vector<float> texels;
    /// Texels that a triangle covers; excludes the margin.
    TileBits covered {};
    /// What reconstruction needs of a tile that it has not been applied to.
    TexelContexts contexts {};

    size_t bytes() const
    {
        return sizeof(*this) + texels.size() * sizeof(float) + contexts.texels.size() * sizeof(TexelContext);
    }
};
using MapTilePointer = std::shared_ptr<const MapTile>;

/// Texels of a map that is baked by tile. Keeps the tiles that it has seen. One per thread.
class BakedTiles
{
public:
    /// @param bake     returns a tile of `baker`, before reconstruction
    BakedTiles(const VismapBaker& baker, std::function<MapTilePointer(int tile)> bake)
        : m_baker(baker)
        , m_bake(std::move(bake))
        , m_scratch(baker.scratch())
    {
    }
    /// As it was baked. Its tile is baked only if a triangle covers the texel.
    BakedTexel at(int x, int y);

private:
    struct Tile
    {
        TileBits covered;
        MapTilePointer baked; // once it was needed
    };
    const VismapBaker& m_baker;
    const std::function<MapTilePointer(int tile)> m_bake;
    const VismapBaker::ScratchPointer m_scratch;
    std::unordered_map<int, Tile> m_tiles;
};

} // namespace vmlight
