// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/penumbra.h>

#include <algorithm>

namespace vmlight {
namespace {

using Rows = std::array<uint64_t, kTileSize>;

// How far apart texels are compared.
constexpr int kReach = 2;

// A row of the tile, with those of the tiles beside it.
struct Row
{
    uint64_t before = 0, here = 0, after = 0;

    // Bit x is that of texel x - by.
    uint64_t shifted(int by) const
    {
        return by == 0 ? here
            : by > 0   ? here << by | before >> (kTileSize - by)
                       : here >> -by | after << (kTileSize + by);
    }
};

Row row_at(const LookedAround& tiles, Rows LookedTile::*kind, int y)
{
    const size_t down = y < 0 ? 0 : y < kTileSize ? 1 : 2;
    const auto word = [&](size_t across) {
        const LookedTile* tile = tiles[3 * down + across];
        return tile ? (tile->*kind)[size_t(y + kTileSize) % kTileSize] : 0;
    };
    return { word(0), word(1), word(2) };
}

uint64_t around(const LookedAround& tiles, Rows LookedTile::*kind, int y)
{
    uint64_t all = 0;
    for (int row = y - kReach; row <= y + kReach; ++row)
        for (int by = -kReach; by <= kReach; ++by)
            all |= row_at(tiles, kind, row).shifted(by);
    return all;
}

uint64_t has_neighbours(const LookedAround& tiles, int y)
{
    std::array<uint64_t, 5> at_least { ~uint64_t(0), 0, 0, 0, 0 }; // 0 to 4
    for (int row = y - 1; row <= y + 1; ++row)
        for (int by = -1; by <= 1; ++by) {
            if (row == y && by == 0)
                continue;
            const uint64_t one = row_at(tiles, &LookedTile::blocked, row).shifted(by)
                | row_at(tiles, &LookedTile::seen, row).shifted(by);
            for (size_t n = 4; n > 0; --n)
                at_least[n] |= at_least[n - 1] & one;
        }
    return at_least[4];
}

} // namespace

std::array<uint64_t, kTileSize> penumbra(const LookedAround& tiles)
{
    const LookedTile& own = *tiles[4];
    std::array<uint64_t, kTileSize> result {};
    for (int y = 0; y < kTileSize; ++y) {
        const uint64_t blocked = own.blocked[size_t(y)], seen = own.seen[size_t(y)];
        if (blocked | seen)
            result[size_t(y)] = (blocked & around(tiles, &LookedTile::seen, y))
                | (seen & around(tiles, &LookedTile::blocked, y)) | ((blocked | seen) & ~has_neighbours(tiles, y));
    }
    return result;
}

} // namespace vmlight
