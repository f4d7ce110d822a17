// SPDX-License-Identifier: Apache-2.0
/// A visibility map by tile, margin included: bit for bit the texels of make_vismap(), at the cost of the tiles that
/// are asked for and of those whose texels reach into their margin.
#pragma once

#include <vmlight/base/once_cache.h>
#include <vmlight/vismap/baked_tiles.h>
#include <vmlight/vismap/baker.h>

#include <OpenImageIO/imageio.h>

#include <cstdint>
#include <memory>
#include <tuple>
#include <vector>

namespace vmlight {

class VismapTiles
{
public:
    /// @param baker    prepared; must outlive this
    /// @param margin   as in VismapParams
    VismapTiles(const VismapBaker& baker, int margin);
    ~VismapTiles();
    VismapTiles(const VismapTiles&) = delete;
    VismapTiles& operator=(const VismapTiles&) = delete;

    /// Tile number `tile` (row by row). Any thread; a tile is baked once as long as the cache has room for it.
    MapTilePointer tile(int tile);

    /// Texels of `roi`, all channels, rows without padding.
    void read(OIIO::ROI roi, float* dst);

    /// Whether the margin is so wide that the first read bakes the whole map, which this then keeps.
    bool is_whole() const { return m_whole; }

    /// Limit of the tile cache that all maps of the process share: 512 MiB by default.
    static void set_cache_limit(size_t bytes);

private:
    struct Window;
    MapTilePointer baked(int tile);
    MapTilePointer reconstructed(int tile);
    MapTilePointer filled(int tile);
    MapTilePointer copied(int tile);
    bool add_tile(Window& window, int tile, VismapBaker::Scratch& scratch);

    const VismapBaker& m_baker;
    const int m_margin;
    const bool m_whole; // the margin is too wide: bake all at once
    const uint64_t m_id;
    RunOnce m_bake_map;
    std::vector<float> m_map;
};

} // namespace vmlight
