// SPDX-License-Identifier: Apache-2.0
// Parts that are not of one map or damaged are refused; hashes and numbers by which they are known.
#include "baked_parts.h"
#include "cutout_scene.h"
#include "drawn_map.h"
#include "scenes.h"

#include <vmlight/base/part_number.h>
#include <vmlight/mesh/opacity_hash.h>
#include <vmlight/vismap/vismap.h>

#include <OpenImageIO/imagebuf.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

using namespace vmlight;
using Imath::V3d;
using testing::HasSubstr;

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
    EXPECT_EQ(with_second(mesh, changed), "seed is 1, not 0");
    changed = params;
    changed.max_distance = 2;
    EXPECT_EQ(with_second(mesh, changed), "max_distance is 2, not infinite");
    changed = params;
    changed.channels = { "normal" };
    EXPECT_THAT(with_second(mesh, changed), HasSubstr("channels is normal, not none"));
    Mesh moved = mesh;
    moved.positions[0].x -= 1e-6;
    EXPECT_THAT(with_second(moved, params), HasSubstr("meshHash is "));
    Mesh leafy = mesh;
    auto opacity = std::make_shared<MeshOpacity>();
    opacity->materials = { cutout_scene::material(AlphaMode::mask, cutout_scene::checker(4)) };
    leafy.opacity = opacity;
    EXPECT_THAT(with_second(leafy, params), HasSubstr("hash of the textures is "));

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
    for (const char* text : { "", "3", "/16", "3/", "3/x", "3/16/2", "1-9x2/16", "3/1-4", "a/b", "1,2", "3 / 16" }) {
        EXPECT_FALSE(parse_parts(parts, count, text, error)) << text;
        EXPECT_THAT(error, HasSubstr("is not a part; expected something like 3/16 or 1-4,7/16")) << text;
    }
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
