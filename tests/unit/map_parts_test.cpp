// SPDX-License-Identifier: Apache-2.0
// Maps that are baked in parts.
#include "baked_parts.h"
#include "cases.h"
#include "drawn_map.h"
#include "scenes.h"

#include <vmlight/vismap/bake_parts.h>
#include <vmlight/vismap/map_part.h>
#include <vmlight/vismap/tile_shares.h>
#include <vmlight/vismap/vismap.h>

#include <OpenImageIO/imagebuf.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <numeric>
#include <random>
#include <string>
#include <vector>

using namespace vmlight;
using Imath::V2f;
using Imath::V3d;

TEST(MapParts, JoinedTheyAreTheWholeMapWhateverTheMeshAndTheirNumber)
{
    std::mt19937 random(7);
    for (int turn = 0; turn < cases(24, 8); ++turn) {
        const Mesh mesh = random_mesh(random);
        const VismapParams params = random_params(random);
        const auto scene = part_scene(mesh, { scenes::rectangle(V3d(-1, 3, -1), V3d(2, 0, 0), V3d(0, 0, 2)) });
        const int count = std::array { 1, 2, 3, 7, 16, 40 }[random() % 6];
        SCOPED_TRACE(testing::Message() << turn << ": " << mesh.name << ", " << params.size().width << "x"
                                        << params.size().height << " " << params.basis << " " << params.reconstruct
                                        << ", parts " << count);
        OIIO::ImageBuf whole, joined;
        ASSERT_TRUE(make_vismap(whole, scene, params, nullptr, 2, {})) << whole.geterror();
        // Some machines bake several parts, in any order.
        std::vector<int> left(static_cast<size_t>(count));
        std::iota(left.begin(), left.end(), 1);
        std::shuffle(left.begin(), left.end(), random);
        Parts parts;
        while (!left.empty()) {
            const size_t some = std::min(left.size(), size_t(1 + random() % 5));
            std::vector<int> which(left.end() - long(some), left.end());
            std::sort(which.begin(), which.end());
            left.resize(left.size() - some);
            Parts more = baked_parts(scene, params, count, which, int(1 + random() % 3));
            EXPECT_EQ(more.size(), some);
            parts.merge(more);
        }
        ASSERT_EQ(join_fault(joined, parts, count), "");
        expect_same_map(joined, whole);
    }
}

TEST(MapParts, APartIsCroppedToItsTiles)
{
    const auto scene = part_scene(scenes::floor_facing_z(1)); // 16 tiles alike
    const Parts parts = baked_parts(scene, part_params(256, 256), 16, { 1, 16 });
    const OIIO::ImageSpec& first = parts.at(1).spec();
    EXPECT_EQ(OIIO::get_roi_full(first), OIIO::ROI(0, 256, 0, 256, 0, 1, 0, first.nchannels));
    EXPECT_EQ(OIIO::get_roi(first), OIIO::ROI(0, 64, 0, 64, 0, 1, 0, first.nchannels));
    EXPECT_EQ(first.get_string_attribute("vmlight:stage"), "vismap part");
    EXPECT_EQ(first.get_string_attribute("vmlight:part"), "1/16");
    EXPECT_EQ(first.get_string_attribute("vmlight:partTiles"), "0-0");
    const OIIO::ImageSpec& last = parts.at(16).spec();
    EXPECT_EQ(OIIO::get_roi(last), OIIO::ROI(192, 256, 192, 256, 0, 1, 0, last.nchannels));
}

// A quad over the lower half of the map: the upper half costs nothing, and so is one part with some of the lower.
TEST(MapParts, SharesHaveTheSameExpectedCost)
{
    Mesh mesh;
    mesh.name = "half";
    scenes::add_quad(mesh, V3d(-1, 0, 1), V3d(1, 0, 1), V3d(1, 0, -1), V3d(-1, 0, -1), V2f(0, 0), V2f(1, .5f));
    const auto scene = part_scene(mesh, { scenes::rectangle(V3d(-1, 1, -1), V3d(2, 0, 0), V3d(0, 0, 2)) });
    VismapBaker baker;
    std::string error;
    ASSERT_TRUE(baker.prepare(scene, part_params(1024, 1024), error)) << error;
    for (const int count : { 1, 2, 3, 16, 64, 1000 }) {
        TileShares shares;
        ASSERT_TRUE(share_tiles(shares, baker, count, 2, {}));
        ASSERT_EQ(shares.ranges.size(), size_t(count));
        EXPECT_EQ(shares.counts.covered, 512 * 1024);
        int next = 0;
        std::vector<int64_t> costs;
        for (const TileRange& range : shares.ranges) {
            EXPECT_EQ(range.first, next);
            EXPECT_GE(range.count(), 0);
            next = range.end;
            costs.push_back(
                std::accumulate(shares.costs.begin() + range.first, shares.costs.begin() + range.end, int64_t(0)));
        }
        EXPECT_EQ(next, 256);
        const int64_t total = std::accumulate(costs.begin(), costs.end(), int64_t(0));
        const int64_t largest = *std::max_element(shares.costs.begin(), shares.costs.end());
        for (const int64_t cost : costs)
            EXPECT_LE(std::abs(cost * count - total), largest * count) << "off by no more than a tile";
    }
}

TEST(MapParts, APartIsNotBakedIfItIsThere)
{
    const auto scene = part_scene(scenes::box(V3d(-1), V3d(1), true));
    const VismapParams params = part_params(256, 256);
    PartsJob job { { scene, params, 2, {}, 0, nullptr }, 4, { 1, 2, 3, 4 }, {}, {}, {} };
    std::vector<int> written;
    const Parts parts = baked_parts(scene, params, 4, { 1, 3 });
    job.is_made = [&](int part, const OIIO::ImageSpec& spec) {
        const auto found = parts.find(part);
        return found != parts.end() && part_fault(found->second.spec(), spec).empty();
    };
    job.write = [&](int part, const OIIO::ImageBuf&, std::string&) {
        written.push_back(part);
        return true;
    };
    VismapReport report;
    std::string error;
    ASSERT_TRUE(bake_parts(job, report, error)) << error;
    EXPECT_EQ(written, (std::vector<int> { 2, 4 }));
    VismapReport all, none;
    baked_parts(scene, params, 4, { 1, 2, 3, 4 }, 2, &all);
    EXPECT_LT(report.rays, all.rays);
    EXPECT_EQ(report.covered, all.covered);
    job.is_made = [](int, const OIIO::ImageSpec&) { return true; };
    ASSERT_TRUE(bake_parts(job, none, error)) << error;
    EXPECT_EQ(none.rays, 0);
}

TEST(MapParts, AnInterruptedBakeStops)
{
    const auto scene = part_scene(scenes::box(V3d(-1), V3d(1), true));
    PartsJob job { { scene, part_params(256, 256), 1, [](double done) { return done < 0.5; }, 0, nullptr },
                   4,
                   { 1, 2, 3, 4 },
                   {},
                   {},
                   {} };
    int written = 0;
    job.write = [&](int, const OIIO::ImageBuf&, std::string&) { return ++written > 0; };
    VismapReport report;
    std::string error;
    EXPECT_FALSE(bake_parts(job, report, error));
    EXPECT_EQ(error, "interrupted");
    EXPECT_GE(written, 1);
    EXPECT_LT(written, 4);
}

TEST(MapParts, ProgressGoesUpToOne)
{
    const auto scene = part_scene(scenes::box(V3d(-1), V3d(1), true));
    for (const char* reconstruct : { "off", "auto" }) {
        VismapParams params = part_params(256, 256);
        params.reconstruct = reconstruct;
        double last = 0;
        const Progress progress = [&](double done) {
            EXPECT_GE(done, last);
            last = done;
            return true;
        };
        PartsJob job { { scene, params, 2, progress, 0, nullptr }, 4, { 2, 3 }, {}, {}, {} };
        job.write = [](int, const OIIO::ImageBuf&, std::string&) { return true; };
        VismapReport report;
        std::string error;
        ASSERT_TRUE(bake_parts(job, report, error)) << error;
        EXPECT_EQ(last, 1);
    }
}
