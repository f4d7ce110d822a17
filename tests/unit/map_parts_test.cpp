// SPDX-License-Identifier: Apache-2.0
// Maps that are baked in parts.
#include "cutout_scene.h"
#include "drawn_map.h"
#include "scenes.h"

#include <vmlight/base/part_number.h>
#include <vmlight/mesh/opacity_hash.h>
#include <vmlight/vismap/bake_parts.h>
#include <vmlight/vismap/join_parts.h>
#include <vmlight/vismap/map_part.h>
#include <vmlight/vismap/tile_shares.h>
#include <vmlight/vismap/vismap.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <numeric>
#include <random>
#include <string>
#include <vector>

using namespace vmlight;
using Imath::V2f;
using Imath::V3d;
using testing::HasSubstr;

namespace {

using Parts = std::map<int, OIIO::ImageBuf>;

// As one machine bakes them.
Parts baked_parts(const BakeScenePointer& scene, const VismapParams& params, int count, const std::vector<int>& which,
                  int threads = 2, VismapReport* report = nullptr)
{
    Parts parts;
    PartsJob job { { scene, params, threads, {}, 0, nullptr }, count, which, {}, {}, {} };
    job.write = [&](int part, const OIIO::ImageBuf& image, std::string&) {
        parts[part].copy(image);
        return true;
    };
    VismapReport counts;
    std::string error;
    EXPECT_TRUE(bake_parts(job, counts, error)) << error;
    if (report)
        *report = counts;
    return parts;
}

std::string join_fault(OIIO::ImageBuf& dst, const Parts& parts, int count)
{
    JoinReport report;
    std::string error;
    const auto read = [&](OIIO::ImageBuf& part, int index, std::string&) { return part.copy(parts.at(index)); };
    return join_parts(rows_into(dst), count, read, report, error) ? "" : error;
}

} // namespace

TEST(MapParts, JoinedTheyAreTheWholeMapWhateverTheMeshAndTheirNumber)
{
    std::mt19937 random(7);
    for (int turn = 0; turn < 24; ++turn) {
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

TEST(MapParts, WhatDoesNotFitIsRefused)
{
    const Mesh mesh = scenes::box(V3d(-1), V3d(1), true);
    const VismapParams params = part_params(130, 70);
    const auto scene = part_scene(mesh);
    const Parts good = baked_parts(scene, params, 3, { 1, 2, 3 });
    OIIO::ImageBuf map;
    EXPECT_EQ(join_fault(map, good, 3), "");
    const auto with_second = [&](const Mesh& other, const VismapParams& changed) {
        Parts parts = baked_parts(part_scene(other), changed, 3, { 2 });
        for (const int index : { 1, 3 })
            parts[index].copy(good.at(index));
        OIIO::ImageBuf joined;
        return join_fault(joined, parts, 3);
    };
    VismapParams changed = params;
    changed.seed = 1;
    EXPECT_EQ(with_second(mesh, changed), "its seed is 1, not 0");
    changed = params;
    changed.max_distance = 2;
    EXPECT_EQ(with_second(mesh, changed), "its max_distance is 2, not infinite");
    changed = params;
    changed.channels = { "normal" };
    EXPECT_THAT(with_second(mesh, changed), HasSubstr("its channels is normal, not none"));
    Mesh moved = mesh;
    moved.positions[0].x -= 1e-6;
    EXPECT_THAT(with_second(moved, params), HasSubstr("its meshHash is "));
    Mesh leafy = mesh;
    auto opacity = std::make_shared<MeshOpacity>();
    opacity->materials = { cutout_scene::material(AlphaMode::mask, cutout_scene::checker(4)) };
    leafy.opacity = opacity;
    EXPECT_THAT(with_second(leafy, params), HasSubstr("its hash of the textures is "));

    Parts swapped = good;
    swapped.at(1).swap(swapped.at(2));
    EXPECT_EQ(join_fault(map, swapped, 3), "it is part 2/3, not 1/3");
    EXPECT_EQ(join_fault(map, good, 2), "it is part 1/3, not 1/2");
    Parts whole;
    ASSERT_TRUE(make_vismap(whole[1], scene, params, nullptr, 2, {}));
    EXPECT_EQ(join_fault(map, whole, 1), "not a part of a visibility map: its vmlight:stage is \"vismap\"");
}

TEST(MapParts, DamagedMetadataAreRefused)
{
    const auto scene = part_scene(scenes::box(V3d(-1), V3d(1), true));
    const Parts good = baked_parts(scene, part_params(130, 70), 2, { 1, 2 });
    const std::pair<const char*, const char*> damages[]
        = { { "vmlight:part", "0/2" },
            { "vmlight:part", "1-2/2" },
            { "vmlight:part", "1" },
            { "vmlight:partTiles", "0-6" },
            { "vmlight:partTiles", "5-0" },
            { "vmlight:partTiles", "0" },
            { "vmlight:partTiles", "-1-0" },
            { "vmlight:partTiles", "0-99999999999" },
            { "vmlight:partChannels", "" },
            { "vmlight:partChannels", "visibility,direction.x" },
            { "vmlight:partChannels", "direction.x,visibility,direction.y,direction.z" },
            { "vmlight:partChannels", "visibility,direction.x,direction.y,direction.z,none" } };
    for (const auto& [name, value] : damages) {
        Parts parts = good;
        for (auto& [index, part] : parts)
            part.specmod().attribute(name, value);
        OIIO::ImageBuf map;
        EXPECT_EQ(join_fault(map, parts, 2),
                  "a damaged part of a visibility map: its metadata, size and channels do not fit together")
            << name << " " << value;
    }
    Parts parts = good;
    for (auto& [index, part] : parts)
        part.specmod().attribute("vmlight:margin", "wide");
    OIIO::ImageBuf map;
    EXPECT_THAT(join_fault(map, parts, 2), HasSubstr("margin"));
    parts = good;
    parts.at(2).specmod().attribute("vmlight:partTiles", "");
    EXPECT_EQ(join_fault(map, parts, 2), "the parts have 1 of 6 tiles");
    parts = good;
    parts.at(1).specmod().attribute("vmlight:partTiles", "");
    EXPECT_EQ(join_fault(map, parts, 2), "its tiles begin with 1, not 0: it is of a map that was divided differently");
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

TEST(MapParts, OpacityIsHashedAsItIsSeen)
{
    using namespace cutout_scene;
    const auto hash = [](const MaterialOpacity& material, const std::vector<uint32_t>& which = { 0, 0 }) {
        Mesh mesh = scenes::floor_facing_z(1);
        auto opacity = std::make_shared<MeshOpacity>();
        opacity->materials = { material };
        mesh.opacity = opacity;
        mesh.triangle_materials = which;
        return opacity_hash(mesh);
    };
    const auto alpha = checker(4);
    EXPECT_EQ(opacity_hash(scenes::floor_facing_z(1)), "");
    EXPECT_EQ(hash(material(AlphaMode::mask, alpha)), hash(material(AlphaMode::mask, checker(4))));
    MaterialOpacity turned = material(AlphaMode::mask, alpha), other_set = turned;
    turned.textures[0].uv_transform[0][1] = 1;
    other_set.textures[0].uv_set = 1;
    std::vector<std::string> hashes { hash(material(AlphaMode::mask, alpha)),
                                      hash(material(AlphaMode::mask, alpha), { 0, 1 }),
                                      hash(material(AlphaMode::blend, alpha)),
                                      hash(material(AlphaMode::mask, alpha, 0.9)),
                                      hash(material(AlphaMode::mask, alpha, 1, 0.4)),
                                      hash(material(AlphaMode::mask, leaf(4))),
                                      hash(material(AlphaMode::mask, nullptr)),
                                      hash(turned),
                                      hash(other_set) };
    std::sort(hashes.begin(), hashes.end());
    EXPECT_EQ(std::unique(hashes.begin(), hashes.end()), hashes.end());
}

TEST(PartNumbers, AreReadAndWritten)
{
    std::vector<int> parts;
    int count = 0;
    std::string error;
    ASSERT_TRUE(parse_parts(parts, count, "3/16", error)) << error;
    EXPECT_EQ(parts, (std::vector<int> { 3 }));
    EXPECT_EQ(count, 16);
    ASSERT_TRUE(parse_parts(parts, count, "7,1-4,3/9999", error)) << error;
    EXPECT_EQ(parts, (std::vector<int> { 1, 2, 3, 4, 7 }));
    EXPECT_EQ(count, 9999);
    for (const char* text : { "", "3", "/16", "3/", "3/x", "3/16/2", "1-9x2/16", "3/1-4", "a/b", "1,2", "3 / 16" })
        EXPECT_FALSE(parse_parts(parts, count, text, error)) << text;
    EXPECT_THAT(error, HasSubstr("is not a part; expected something like 3/16 or 1-4,7/16"));
    for (const char* text : { "0/16", "17/16", "1-17/16" }) {
        EXPECT_FALSE(parse_parts(parts, count, text, error)) << text;
        EXPECT_THAT(error, HasSubstr("parts are numbered from 1 to 16"));
    }
    EXPECT_FALSE(parse_parts(parts, count, "1/10000", error));
    EXPECT_THAT(error, HasSubstr("a map has 1 to 9999 parts"));
    EXPECT_EQ(part_path("a.b/hero.exr", "part", { 3, 16 }), "a.b/hero.part03of16.exr");
    EXPECT_EQ(part_path("hero.1001.exr", "part", { 3, 9 }), "hero.1001.part3of9.exr");
    EXPECT_EQ(part_path("a.b/hero", "part", { 12, 100 }), "a.b/hero.part012of100");
    EXPECT_EQ(ranges_text({ 1, 2, 3, 7, 9, 10 }), "1-3, 7, 9-10");
}
