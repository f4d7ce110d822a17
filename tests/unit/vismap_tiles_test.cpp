// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/vismap/tiles.h>

#include <vmlight/base/parallel.h>
#include <vmlight/base/work_counts.h>
#include <vmlight/vismap/vismap.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <string>
#include <vector>

using namespace vmlight;

namespace {

const Mesh& spot_mesh()
{
    static const Mesh mesh = [] {
        Mesh read;
        std::string error;
        EXPECT_TRUE(read_mesh(read, VMLIGHT_TEST_DATA "/spot.obj", {}, error)) << error;
        return read;
    }();
    return mesh;
}

VismapParams quick(int width, int height, int margin)
{
    VismapParams params;
    params.resolution = { width, height };
    params.samples = 4;
    params.margin = margin;
    params.reconstruct = "off"; // what is tested are the tiles that a tile needs
    return params;
}

std::vector<float> whole_map(const VismapParams& params)
{
    OIIO::ImageBuf image;
    EXPECT_TRUE(make_vismap(image, spot_mesh(), {}, params)) << image.geterror();
    std::vector<float> pixels(size_t(image.spec().image_pixels()) * image.nchannels());
    image.get_pixels(image.roi(), OIIO::TypeFloat, pixels.data());
    return pixels;
}

// The map, put together from tiles read in an order of chance by several threads.
std::vector<float> tiled_map(VismapTiles& tiles, const VismapBaker& baker, unsigned seed, int nthreads)
{
    std::vector<int> order(size_t(baker.tiles_across()) * baker.tiles_down());
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::mt19937(seed));
    const size_t channels = size_t(baker.channels());
    std::vector<float> pixels(size_t(baker.width()) * baker.height() * channels, -1.0f);
    parallel_items(int64_t(order.size()), nthreads, [&](int64_t i, int) {
        const int x = order[size_t(i)] % baker.tiles_across() * kTileSize;
        const int y = order[size_t(i)] / baker.tiles_across() * kTileSize;
        const OIIO::ROI roi(x, std::min(x + kTileSize, baker.width()), y, std::min(y + kTileSize, baker.height()));
        std::vector<float> tile(size_t(roi.width()) * roi.height() * channels);
        tiles.read(roi, tile.data());
        for (int row = 0; row < roi.height(); ++row)
            std::copy_n(&tile[size_t(row) * roi.width() * channels], roi.width() * channels,
                        &pixels[(size_t(y + row) * baker.width() + x) * channels]);
    });
    return pixels;
}

} // namespace

TEST(VismapTiles, TilesAreTheWholeMapBitForBitWhateverTheMargin)
{
    for (const auto& [width, height] : { std::pair(256, 256), { 200, 333 } })
        for (int margin : { 0, 1, 16, 63, 64, 65, 128, 129, 200, -1 }) {
            const VismapParams params = quick(width, height, margin);
            VismapBaker baker;
            std::string error;
            ASSERT_TRUE(baker.prepare(spot_mesh(), {}, params, 0, error)) << error;
            VismapTiles tiles(baker, margin);
            EXPECT_EQ(tiled_map(tiles, baker, unsigned(margin + 2), 3), whole_map(params)) << width << " " << margin;
        }
}

TEST(VismapTiles, TheCoverageChannelIsZeroInTheMargin)
{
    VismapParams params = quick(256, 128, 16);
    params.channels = { "coverage" };
    VismapBaker baker;
    std::string error;
    ASSERT_TRUE(baker.prepare(spot_mesh(), {}, params, 0, error)) << error;
    VismapTiles tiles(baker, params.margin);
    EXPECT_EQ(tiled_map(tiles, baker, 1, 2), whole_map(params));
}

TEST(VismapTiles, NormalsAreThoseOfTheWholeMapInTheMarginToo)
{
    for (bool coverage : { false, true })
        for (int margin : { 0, 16, -1 }) {
            VismapParams params = quick(200, 130, margin);
            params.channels = { "normal" };
            if (coverage)
                params.channels.push_back("coverage");
            VismapBaker baker;
            std::string error;
            ASSERT_TRUE(baker.prepare(spot_mesh(), {}, params, 0, error)) << error;
            EXPECT_EQ(baker.channels(), coverage ? 8 : 7);
            VismapTiles tiles(baker, params.margin);
            EXPECT_EQ(tiled_map(tiles, baker, 1, 2), whole_map(params)) << margin;
        }
}

TEST(VismapTiles, EachBasisIsThatOfTheWholeMapInTheMarginToo)
{
    for (const auto& [basis, channels] : { std::pair { "sh", 10 }, { "mask", 19 }, { "cells", 20 } })
        for (int margin : { 0, 16, -1 }) {
            VismapParams params = quick(200, 130, margin);
            params.basis = basis;
            params.order = 3;
            params.channels = { "coverage" };
            VismapBaker baker;
            std::string error;
            ASSERT_TRUE(baker.prepare(spot_mesh(), {}, params, 0, error)) << error;
            EXPECT_EQ(baker.channels(), channels);
            VismapTiles tiles(baker, params.margin);
            const std::vector<float> whole = whole_map(params);
            EXPECT_EQ(tiled_map(tiles, baker, 1, 2), whole) << basis << " " << margin;
            // A margin of packed numbers is copied, so that they stay whole.
            int64_t broken = 0;
            for (size_t texel = 0; basis != std::string("sh") && texel < whole.size(); texel += size_t(channels))
                for (size_t i = texel + 7; i < texel + size_t(channels); ++i)
                    broken += whole[i] != std::floor(whole[i]);
            EXPECT_EQ(broken, 0) << basis << " " << margin;
        }
}

TEST(VismapTiles, ReconstructedTilesAreThoseOfTheWholeMap)
{
    for (const char* basis : { "vector", "sh" })
        for (int margin : { 0, 16, -1 }) {
            VismapParams params = quick(200, 333, margin);
            params.reconstruct = "auto";
            params.basis = basis;
            params.order = 3;
            params.channels = { "coverage", "error" };
            VismapBaker baker;
            std::string error;
            ASSERT_TRUE(baker.prepare(spot_mesh(), {}, params, 0, error)) << error;
            VismapTiles tiles(baker, margin);
            const std::vector<float> whole = whole_map(params);
            EXPECT_EQ(tiled_map(tiles, baker, 1, 3), whole) << basis << " " << margin;
            if (margin != 0)
                continue;
            params.reconstruct = "off";
            EXPECT_NE(whole_map(params), whole);
        }
}

TEST(VismapTiles, ErrorsAndWhatWasChosenForOneAreThoseOfTheWholeMap)
{
    for (int margin : { 0, 16, -1 }) {
        VismapParams params = quick(200, 130, margin);
        params.target_error = 0.05;
        params.channels = { "normal", "coverage", "error" };
        VismapBaker baker;
        std::string error;
        ASSERT_TRUE(baker.prepare(spot_mesh(), {}, params, 0, error)) << error;
        EXPECT_NE(baker.params().samples, params.samples);
        EXPECT_EQ(baker.channels(), 9);
        EXPECT_EQ(baker.margin_channels().averaged, 8);
        VismapTiles tiles(baker, margin);
        EXPECT_EQ(tiled_map(tiles, baker, 1, 2), whole_map(params)) << margin;
    }
}

TEST(VismapTiles, ACacheWithoutRoomCostsTimeAndNoBit)
{
    VismapTiles::set_cache_limit(1);
    const VismapParams params = quick(256, 256, 16);
    VismapBaker baker;
    std::string error;
    ASSERT_TRUE(baker.prepare(spot_mesh(), {}, params, 0, error)) << error;
    VismapTiles tiles(baker, params.margin);
    EXPECT_EQ(tiled_map(tiles, baker, 1, 4), whole_map(params));
    VismapTiles::set_cache_limit(size_t(512) << 20);
}

TEST(VismapTiles, ATileOfALargeMapCostsItselfAndWhatReachesIntoItsMargin)
{
    VismapParams params = quick(8192, 8192, 16);
    VismapBaker baker;
    std::string error;
    ASSERT_TRUE(baker.prepare(spot_mesh(), {}, params, 0, error)) << error;
    const auto scratch = baker.scratch();
    // One tile in the midst of an island, and one on its rim.
    int inside = -1, rim = -1;
    for (int tile = 0; tile < baker.tiles_across() * baker.tiles_down(); ++tile) {
        TileBits bits;
        baker.cover_tile(tile, *scratch, bits);
        if (std::all_of(bits.begin(), bits.end(), [](uint64_t row) { return row == ~uint64_t(0); }))
            inside = tile;
        else if (bits != TileBits {})
            rim = tile;
    }
    ASSERT_GE(inside, 0);
    ASSERT_GE(rim, 0);
    VismapTiles tiles(baker, params.margin);
    int64_t before = work_counts().tiles_baked;
    EXPECT_EQ(tiles.tile(inside)->texels.size(), size_t(kTileSize * kTileSize * 4));
    EXPECT_EQ(work_counts().tiles_baked, before + 1);
    tiles.tile(inside);
    EXPECT_EQ(work_counts().tiles_baked, before + 1);
    before = work_counts().tiles_baked;
    tiles.tile(rim);
    EXPECT_GE(work_counts().tiles_baked, before + 1);
    EXPECT_LE(work_counts().tiles_baked, before + 9);

    // Reconstruction reads the tiles around, here also one on the other side of a seam; the margin those around them.
    params.reconstruct = "auto";
    VismapBaker reconstructing;
    ASSERT_TRUE(reconstructing.prepare(spot_mesh(), {}, params, 0, error)) << error;
    for (const auto& [tile, most] : { std::pair(inside, 10), { rim, 25 } }) {
        VismapTiles smooth(reconstructing, params.margin);
        before = work_counts().tiles_baked;
        smooth.tile(tile);
        EXPECT_GT(work_counts().tiles_baked, before + 1);
        EXPECT_LE(work_counts().tiles_baked, before + most);
    }
}
