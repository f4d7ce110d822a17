// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/baked_tiles.h>

namespace vmlight {

BakedTexel BakedTiles::at(int x, int y)
{
    const int number = y / kTileSize * m_baker.tiles_across() + x / kTileSize;
    const auto [found, is_new] = m_tiles.try_emplace(number);
    Tile& tile = found->second;
    if (is_new)
        m_baker.cover_tile(number, *m_scratch, tile.covered);
    if (!(tile.covered[size_t(y % kTileSize)] >> x % kTileSize & 1))
        return {};
    if (!tile.baked)
        tile.baked = m_bake(number);
    const size_t at = size_t(y % kTileSize) * kTileSize + size_t(x % kTileSize);
    return { &tile.baked->texels[at * size_t(m_baker.channels())], &tile.baked->contexts.at(x, y) };
}

} // namespace vmlight
