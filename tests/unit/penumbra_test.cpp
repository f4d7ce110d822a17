// SPDX-License-Identifier: Apache-2.0
// Which texels of one ray each are in a penumbra.
#include <vmlight/vismap/penumbra.h>

#include <gtest/gtest.h>

#include <functional>
#include <vector>

using namespace vmlight;

namespace {

// 3 x 3 tiles whose texels were looked at as `look` says: -1 not at all, 0 blocked, 1 seen; x and y from -64 to 127.
struct LookedAtTiles
{
    explicit LookedAtTiles(const std::function<int(int x, int y)>& look)
        : tiles(9)
    {
        for (int y = -kTileSize; y < 2 * kTileSize; ++y)
            for (int x = -kTileSize; x < 2 * kTileSize; ++x)
                if (const int seen = look(x, y); seen >= 0)
                    tiles[size_t((y + kTileSize) / kTileSize * 3 + (x + kTileSize) / kTileSize)].set(
                        (x + kTileSize) % kTileSize, (y + kTileSize) % kTileSize, seen == 1);
        for (size_t i = 0; i < 9; ++i)
            around[i] = &tiles[i];
    }
    std::vector<LookedTile> tiles;
    LookedAround around {};
};

void expect_penumbra(const LookedAround& tiles, const std::function<bool(int x, int y)>& wanted)
{
    const auto found = penumbra(tiles);
    for (int y = 0; y < kTileSize; ++y)
        for (int x = 0; x < kTileSize; ++x)
            ASSERT_EQ(bool(found[size_t(y)] >> x & 1), wanted(x, y)) << x << " " << y;
}

} // namespace

TEST(Penumbra, NoneWhereAllAgree)
{
    for (const int seen : { 0, 1, -1 })
        expect_penumbra(LookedAtTiles([&](int, int) { return seen; }).around, [](int, int) { return false; });
}

TEST(Penumbra, TwoTexelsOnEachSideOfAnEdgeAlsoAcrossTiles)
{
    for (int edge = -3; edge <= kTileSize + 3; ++edge) {
        const auto near = [&](int at) { return at >= edge - 2 && at < edge + 2; };
        expect_penumbra(LookedAtTiles([&](int x, int) { return int(x >= edge); }).around,
                        [&](int x, int) { return near(x); });
        expect_penumbra(LookedAtTiles([&](int, int y) { return int(y < edge); }).around,
                        [&](int, int y) { return near(y); });
    }
    // From corner to corner.
    expect_penumbra(LookedAtTiles([](int x, int y) { return int(x >= 0 && y >= 0); }).around,
                    [](int x, int y) { return x < 2 || y < 2; });
    expect_penumbra(LookedAtTiles([](int x, int y) { return int(x >= kTileSize && y >= kTileSize); }).around,
                    [](int x, int y) { return x >= kTileSize - 2 && y >= kTileSize - 2; });
}

TEST(Penumbra, TooFewNeighboursTellNothing)
{
    // A strip a texel wide, one of two, one of three.
    for (const int width : { 1, 2, 3 })
        expect_penumbra(LookedAtTiles([&](int x, int) { return x >= 20 && x < 20 + width ? 1 : -1; }).around,
                        [&](int x, int) { return width == 1 && x == 20; });
    // The border of the map is the straight edge of what is known.
    LookedAtTiles all([](int, int) { return 1; });
    for (const size_t left : { size_t(0), size_t(3), size_t(6) })
        all.around[left] = nullptr;
    expect_penumbra(all.around, [](int, int) { return false; });
}
