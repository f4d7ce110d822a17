// SPDX-License-Identifier: Apache-2.0
// Which texels a pilot picks.
#include "closed_forms.h"
#include "scenes.h"

#include <vmlight/uv/udim.h>
#include <vmlight/vismap/pilot.h>
#include <vmlight/vismap/reconstruct_pilot.h>

#include <set>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

constexpr int kTexelsAcross = 256;

// Places in the order of tiles and rows, in which texels are counted.
std::vector<int64_t> picked_ranks(int64_t most, int64_t neighbours, int texels_across = kTexelsAcross)
{
    const BakeScenePointer scene = closed_forms::shared_scene(floor_facing_z(1), {});
    VismapParams params;
    params.resolution = { texels_across, texels_across };
    VismapPilot pilot(*scene, nullptr, params, 2, {});
    const UvRaster raster(scene->mesh(), texels_across, texels_across);
    EXPECT_TRUE(pilot.pick(raster, {}, most, 1, neighbours));
    EXPECT_EQ(pilot.covered(), int64_t(texels_across) * texels_across);
    std::vector<int64_t> ranks;
    for (int64_t i = 0; i < pilot.texels(); ++i) {
        const Imath::V2i place = pilot.place(i);
        const int tile = place.y / kTileSize * raster.tiles_across() + place.x / kTileSize;
        ranks.push_back((int64_t(tile) * kTileSize + place.y % kTileSize) * kTileSize + place.x % kTileSize);
    }
    return ranks;
}

} // namespace

TEST(Pilot, PicksTexelsEvenly)
{
    const std::vector<int64_t> ranks = picked_ranks(1024, 1);
    ASSERT_EQ(ranks.size(), 1024u);
    for (size_t i = 0; i < ranks.size(); ++i)
        EXPECT_EQ(ranks[i] / 64, int64_t(i)) << "one of each 64 texels";
    EXPECT_GT(std::set<int64_t>({ ranks[0] % 64, ranks[1] % 64, ranks[2] % 64, ranks[3] % 64 }).size(), 1u)
        << "not always the same column";
}

TEST(Pilot, PicksNeighboursTogether)
{
    const std::vector<int64_t> ranks = picked_ranks(1024, 16);
    ASSERT_EQ(ranks.size(), 1024u);
    for (size_t i = 0; i < ranks.size(); ++i)
        EXPECT_EQ(ranks[i], i % 16 ? ranks[i - 1] + 1 : ranks[i]) << i;
    for (size_t group = 0; group < 64; ++group) {
        EXPECT_GE(ranks[16 * group], int64_t(1024 * group)) << "evenly, too";
        EXPECT_LT(ranks[16 * group + 15], int64_t(1024 * (group + 1)));
    }
}

TEST(Pilot, PicksAllTexelsOfASmallMap)
{
    const std::vector<int64_t> ranks = picked_ranks(4096, 16, 64);
    ASSERT_EQ(ranks.size(), 4096u);
    for (size_t i = 0; i < ranks.size(); ++i)
        EXPECT_EQ(ranks[i], int64_t(i));
}

// Its windows have 81 texels each, which are the same again and again.
TEST(Pilot, WindowsOfASmallMapTraceEachTexelOnce)
{
    constexpr int kAcross = 16, kTexels = kAcross * kAcross;
    const BakeScenePointer scene = closed_forms::shared_scene(floor_facing_z(1), {});
    VismapParams params;
    params.resolution = { kAcross, kAcross };
    const UvRaster raster(scene->mesh(), kAcross, kAcross);
    VismapPilot pilot(*scene, nullptr, params, 2, {});
    ASSERT_TRUE(pilot.pick(raster, {}));
    ReconstructPilot windows(*scene, pilot, params, 2, {});
    ASSERT_TRUE(windows.pick(raster, {}, SeamLinks(scene->mesh(), raster, kAcross, kAcross, kFirstUdim)));
    EXPECT_GT(windows.traced_texels(), kTexels);
    EXPECT_LE(windows.traced_texels(), kTexels * (1 + 2 * 8)) << "each, and twice 8 times the rays for the middles";
}
