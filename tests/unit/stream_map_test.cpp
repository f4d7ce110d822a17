// SPDX-License-Identifier: Apache-2.0
// Maps that are baked and written from the top down, without the whole of them in memory.
#include "cases.h"
#include "drawn_map.h"
#include "scenes.h"
#include "stage_scene.h"

#include <vmlight/image/image_file.h>
#include <vmlight/stage/large_map.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/vismap/band_baker.h>
#include <vmlight/vismap/make_map.h>

#include <OpenImageIO/filesystem.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <string>
#include <vector>

using namespace vmlight;
using Imath::V3d;

namespace {

// What stream_map() gives away, put together.
struct StreamedMap
{
    OIIO::ImageBuf image;
    VismapReport report;
    std::string error;
    int bands = 0, end = 0;

    bool bake(const MapJob& job)
    {
        MapRows rows = rows_into(image);
        rows.take = [this, take = rows.take](int ybegin, int yend, const float* texels, std::string& reason) {
            ++bands;
            end = yend;
            return take(ybegin, yend, texels, reason);
        };
        const bool made = stream_map(rows, job, report, error);
        EXPECT_TRUE(!made || end == image.spec().height);
        return made;
    }
};

MapJob job_of(const BakeScenePointer& scene, const VismapParams& params, int threads)
{
    MapJob job { scene, params, threads, {}, 0, nullptr };
    job.in_bands = true;
    return job;
}

void expect_same_counts(const VismapReport& streamed, const VismapReport& whole)
{
    EXPECT_EQ(streamed.rays, whole.rays); // no texel is traced twice
    EXPECT_EQ(streamed.covered, whole.covered);
    EXPECT_EQ(streamed.overlapping, whole.overlapping);
    EXPECT_EQ(streamed.dark, whole.dark);
    EXPECT_EQ(streamed.open, whole.open);
    EXPECT_EQ(streamed.samples, whole.samples);
}

} // namespace

TEST(StreamMap, IsTheWholeMapWhateverTheMeshAndTheParameters)
{
    std::mt19937 random(11);
    int streamed = 0, reconstructed = 0;
    for (int turn = 0; turn < cases(24, 16); ++turn) {
        const Mesh mesh = random_mesh(random);
        VismapParams params = random_params(random);
        params.resolution = { 1 + int(random() % 200), 300 + int(random() % 500) };
        params.samples = 2;
        params.margin = std::array { 0, 3, 16, 70, 128, 300, -1 }[random() % 7];
        const auto scene = part_scene(mesh, { scenes::rectangle(V3d(-1, 3, -1), V3d(2, 0, 0), V3d(0, 0, 2)) });
        SCOPED_TRACE(testing::Message() << turn << ": " << mesh.name << ", " << params.size().width << "x"
                                        << params.size().height << " " << params.basis << " " << params.reconstruct
                                        << " margin " << params.margin);
        OIIO::ImageBuf whole;
        VismapReport report;
        ASSERT_TRUE(make_vismap(whole, scene, params, &report, 2, {})) << whole.geterror();
        StreamedMap map;
        ASSERT_TRUE(map.bake(job_of(scene, params, turn % 2 ? 1 : 2))) << map.error;
        expect_same_map(map.image, whole);
        expect_same_counts(map.report, report);
        streamed += map.bands > 1;
        reconstructed += map.bands > 1 && is_reconstructed(params);
    }
    EXPECT_GT(streamed, cases(6, 2));
    EXPECT_GE(reconstructed, cases(2, 1));
}

// A floor of two islands, the left half at the top of the map and the right half at its bottom.
TEST(StreamMap, TexelsBeyondSeamsInRowsThatAreGoneOrToComeAreBakedOnce)
{
    VismapParams params = part_params(256, 1024);
    Mesh mesh;
    mesh.name = "halves";
    scenes::add_quad(mesh, V3d(0), V3d(1, 0, 0), V3d(1, 1, 0), V3d(0, 1, 0), Imath::V2f(.1f, .02f),
                     Imath::V2f(.9f, .3f));
    scenes::add_quad(mesh, V3d(1, 0, 0), V3d(2, 0, 0), V3d(2, 1, 0), V3d(1, 1, 0), Imath::V2f(.1f, .7f),
                     Imath::V2f(.9f, .98f));
    const auto scene = part_scene(mesh, { scenes::quad(V3d(1, 0, .2), V3d(1, 1, .2), V3d(2, 1, 1), V3d(2, 0, 1)) });
    OIIO::ImageBuf whole;
    VismapReport report;
    ASSERT_TRUE(make_vismap(whole, scene, params, &report, 2, {})) << whole.geterror();
    VismapBaker baker;
    std::string error;
    ASSERT_TRUE(baker.prepare(scene, params, error)) << error;
    const TexelSet above = texels_beyond_seams(baker, 8, 16, 1, [](int, int, int y) { return y < 6 * kTileSize; });
    const TexelSet below = texels_beyond_seams(baker, 0, 4, 1, [](int, int, int y) { return y >= 10 * kTileSize; });
    EXPECT_FALSE(above.empty());
    EXPECT_FALSE(below.empty());
    StreamedMap map;
    ASSERT_TRUE(map.bake(job_of(scene, params, 1))) << map.error;
    EXPECT_GE(map.bands, 2);
    expect_same_map(map.image, whole);
    expect_same_counts(map.report, report);
}

TEST(StreamMap, StopsWhereItIsStopped)
{
    const auto scene = part_scene(scenes::box(V3d(-1), V3d(1), true));
    MapJob job = job_of(scene, part_params(64, 3000), 1);
    job.progress = [](double done) { return done < 0.5; };
    StreamedMap map;
    EXPECT_FALSE(map.bake(job));
    EXPECT_EQ(map.error, "interrupted");
    EXPECT_LE(map.bands, 1);

    job.progress = {};
    int taken = 0;
    MapRows full;
    full.begin = [](OIIO::ImageSpec&, std::string&) { return true; };
    full.take = [&](int, int, const float*, std::string& error) {
        error = "the disk is full";
        return ++taken < 2;
    };
    VismapReport report;
    std::string error;
    EXPECT_FALSE(stream_map(full, job, report, error));
    EXPECT_EQ(error, "the disk is full");
    EXPECT_EQ(taken, 2);
}

TEST(StreamMap, ProgressNeverFallsAndGoesUpToOne)
{
    const auto scene = part_scene(scenes::box(V3d(-1), V3d(1), true));
    MapJob job = job_of(scene, part_params(64, 3000), 1);
    double last = 0;
    job.progress = [&](double done) {
        EXPECT_GE(done, last);
        last = done;
        return true;
    };
    StreamedMap map;
    ASSERT_TRUE(map.bake(job)) << map.error;
    EXPECT_DOUBLE_EQ(last, 1);
}

TEST(StreamMap, HoldsRowsAndNotTheMap)
{
    VismapParams params = part_params(8192, 8192);
    const double small = BandBaker::held_bytes(params, 4, 2);
    EXPECT_LT(small, 0.5e9);
    params.resolution = { 8192, 65536 };
    EXPECT_EQ(BandBaker::held_bytes(params, 4, 2), small);
    params.resolution = { 32768, 32768 };
    EXPECT_LT(BandBaker::held_bytes(params, 4, 2), 2e9);
    EXPECT_TRUE(MarginRows::is_narrow(0));
    EXPECT_TRUE(MarginRows::is_narrow(2 * kTileSize));
    EXPECT_FALSE(MarginRows::is_narrow(2 * kTileSize + 1));
    EXPECT_FALSE(MarginRows::is_narrow(-1)); // all texels: any is filled from any other
}

TEST(LargeMap, OnlyMapsOfMoreThanAGigabyteAreWrittenWhileTheyAreBaked)
{
    VismapRecipe recipe;
    recipe.mesh = "hero.obj";
    recipe.vismap_params.resolution = { 2048, 2048 };
    EXPECT_FALSE(is_large_map(recipe, {}));
    EXPECT_GT(map_bytes(recipe, {}), 2048 * 2048 * 4 * 4);
    recipe.vismap_params.resolution = { 8192, 8192 };
    EXPECT_TRUE(is_large_map(recipe, {}));
    EXPECT_EQ(map_bytes(recipe, {}), BandBaker::held_bytes(recipe.vismap_params, 4, 0));
    recipe.vismap_params.margin = -1;
    EXPECT_FALSE(is_large_map(recipe, {}));
    EXPECT_GT(map_bytes(recipe, {}), 8192.0 * 8192 * 4 * 4);
}

TEST(LargeMap, IsTheSameFile)
{
    const stage_scene::Folder folder;
    VismapRecipe recipe;
    std::string error;
    ASSERT_TRUE(read_recipe(recipe, folder / "hero.vismap", error)) << error;
    recipe.vismap_params.resolution = { 100, 600 };
    OIIO::ImageBuf whole;
    ASSERT_TRUE(make_image(whole, recipe)) << whole.geterror();
    const std::string expected = folder / "whole.exr", found = folder / "rows.exr";
    const auto bytes = [](const std::string& path) {
        std::string text;
        EXPECT_TRUE(OIIO::Filesystem::read_text_file(path, text)) << path;
        return text;
    };
    for (const char* format : { "float", "half" })
        for (const char* compression : { "zip", "none" }) {
            const FileParams file { format, compression };
            ASSERT_TRUE(write_image(whole, expected, file, {}, error)) << error;
            ASSERT_TRUE(write_large_map(recipe, found, file, {}, error)) << error;
            EXPECT_EQ(bytes(found), bytes(expected)) << format << " " << compression;
        }
    // What fails leaves the file as it was.
    const std::string before = bytes(found);
    recipe.mesh = folder / "missing.obj";
    EXPECT_FALSE(write_large_map(recipe, found, {}, {}, error));
    EXPECT_THAT(error, testing::HasSubstr("missing.obj"));
    EXPECT_FALSE(write_large_map(recipe, folder / "no such folder/map.exr", {}, {}, error));
    EXPECT_THAT(error, testing::HasSubstr("no such folder"));
    EXPECT_EQ(bytes(found), before);
}

TEST(LargeMap, ValuesBeyondHalfAreRefusedWhereverTheyAre)
{
    const stage_scene::Folder folder;
    const std::string path = folder / "rows.exr";
    OIIO::ImageSpec spec(64, 128, 2, OIIO::TypeFloat);
    spec.channelnames = { "visibility", "sun" };
    spec.tile_width = spec.tile_height = 64;
    std::vector<float> rows(64 * 64 * 2, -65504.0f);
    std::string error;
    ExrOutput output(path, { "half", "zip" });
    ASSERT_TRUE(output.open({ spec }, error)) << error;
    ASSERT_TRUE(output.write_rows(0, 64, rows.data(), error)) << error;
    rows[5001] = -65505;
    EXPECT_FALSE(output.write_rows(64, 128, rows.data(), error));
    EXPECT_EQ(error, "\"" + path + "\": channel sun reaches 65505, but the maximum of half is 65504: write float");
    EXPECT_FALSE(OIIO::Filesystem::exists(path));
}
