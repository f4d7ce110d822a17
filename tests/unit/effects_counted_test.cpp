// SPDX-License-Identifier: Apache-2.0
// What a scene does not call for costs nothing, counted: rays, callbacks, texture lookups, tangents, texels of the
// margin, large allocations. For each effect also a scene that calls for it.
#include "allocations.h"
#include "baked_map.h"
#include "cutout_scene.h"

#include <vmlight/base/work_counts.h>
#include <vmlight/effects/bake_facts.h>
#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/normal_map.h>

#include <OpenImageIO/imagebufalgo.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <utility>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

// What a bake is given.
struct BakeInputs
{
    Mesh mesh;
    std::vector<Mesh> occluders;
    VismapParams params = map_params(48, 48, 16);
    OIIO::ImageBuf normal_map;
};

struct CountedBake
{
    int64_t rays, hits, lookups, tangents, margin, allocations, casters;

    bool operator==(const CountedBake& other) const
    {
        return rays == other.rays && hits == other.hits && lookups == other.lookups && tangents == other.tangents
            && margin == other.margin && allocations == other.allocations && casters == other.casters;
    }
};

std::ostream& operator<<(std::ostream& out, const CountedBake& work)
{
    return out << work.rays << " rays, " << work.hits << " callbacks, " << work.lookups << " texture lookups, "
               << work.tangents << " tangents, " << work.margin << " texels of margin, " << work.allocations
               << " large allocations, " << work.casters << " casters";
}

// A wall on a floor: both see half of the sky or less.
BakeInputs plain()
{
    BakeInputs inputs;
    inputs.mesh = floor_facing_z(1);
    inputs.mesh.uvs = { { 0, 0 }, { 0.45f, 0 }, { 0.45f, 1 }, { 0, 1 } };
    add_quad(inputs.mesh, V3d(0, -1, 0), V3d(0, 1, 0), V3d(0, 1, 1), V3d(0, -1, 1), V2f(0.55f, 0), V2f(1, 1));
    inputs.params.skip_open = true;
    return inputs;
}

NormalMapPointer normals_of(const BakeInputs& inputs)
{
    if (!inputs.normal_map.initialized())
        return nullptr;
    auto map = std::make_shared<NormalMap>();
    std::vector<std::string> warnings;
    std::string error;
    EXPECT_TRUE(map->decode(inputs.normal_map, {}, inputs.params.size(), 1, warnings, error)) << error;
    if (map->is_flat())
        return nullptr;
    map->attach(non_owning(inputs.mesh));
    return map;
}

CountedBake work_of(const BakeInputs& inputs, OIIO::ImageBuf& map)
{
    const auto scene = std::make_shared<BakeScene>();
    std::string error;
    const int64_t tangents = work_counts().tangents_made, margin = work_counts().margin_texels;
    const NormalMapPointer normals = normals_of(inputs); // decoded, as a file is read: the input's own buffers
    const LargeAllocations allocations;
    EXPECT_TRUE(scene->build(non_owning(inputs.mesh), inputs.occluders, 1, error,
                             SceneChoice::within(inputs.params.max_distance)))
        << error;
    VismapReport report;
    EXPECT_TRUE(make_vismap(map, scene, inputs.params, &report, 1, {}, 0, normals)) << map.geterror();
    const CutoutWork cutouts = scene->occluder().cutout_work();
    return { report.rays,
             cutouts.hits,
             cutouts.lookups,
             work_counts().tangents_made - tangents,
             work_counts().margin_texels - margin,
             allocations.count(),
             int64_t(scene->occluder().triangles().size()) };
}

OIIO::ImageBuf one_normal(float x, float y, float z)
{
    OIIO::ImageBuf image(OIIO::ImageSpec(4, 4, 3, OIIO::TypeFloat));
    OIIO::ImageBufAlgo::fill(image, { x, y, z });
    return image;
}

Mesh with_alpha(const Mesh& mesh, float alpha)
{
    return cutout_scene::with_material(
        mesh, cutout_scene::material(AlphaMode::mask, cutout_scene::texture(4, 4, [&](int, int) { return alpha; })));
}

struct IdleCase
{
    const char* name;
    std::function<void(BakeInputs&)> idle, called;
    // What the second costs more of.
    int64_t CountedBake::*more;
};

const Mesh& ball()
{
    static const Mesh mesh = placed(icosphere(1), 0.3);
    return mesh;
}

std::vector<IdleCase> idle_cases()
{
    return {
        { "an occluder behind every horizon", [](auto& in) { in.occluders = { placed(ball(), 1, V3d(-0.5, 0, -2)) }; },
          [](auto& in) { in.occluders = { placed(ball(), 1, V3d(0.5, 0, 2)) }; }, &CountedBake::casters },
        { "an occluder out of reach",
          [](auto& in) {
              in.params.max_distance = 100;
              in.occluders = { placed(ball(), 40, V3d(0, 0, 200)) };
          },
          [](auto& in) {
              in.params.max_distance = 100;
              in.occluders = { placed(ball(), 40, V3d(0, 0, 50)) };
          },
          &CountedBake::casters },
        { "cut-outs", [](auto& in) { in.mesh = with_alpha(in.mesh, 1); },
          [](auto& in) {
              in.mesh = cutout_scene::with_material(in.mesh,
                                                    cutout_scene::material(AlphaMode::mask, cutout_scene::checker(4)));
          },
          &CountedBake::hits },
        { "a normal map", [](auto& in) { in.normal_map = one_normal(0.5f, 0.5f, 1); },
          [](auto& in) { in.normal_map = one_normal(0.8f, 0.5f, 0.9f); }, &CountedBake::tangents },
        { "a margin", [](auto& in) { in.params.margin = 0; }, [](auto& in) { in.params.margin = 2; },
          &CountedBake::margin },
        { "a maximum distance", [](auto& in) { in.params.max_distance = 100; }, nullptr, nullptr },
        { "the first UDIM tile", [](auto& in) { in.params.udim = 1001; }, nullptr, nullptr },
    };
}

} // namespace

TEST(EffectsCounted, WhatChangesNothingCostsNothingInABake)
{
    OIIO::ImageBuf without, with;
    const CountedBake least = work_of(plain(), without);
    EXPECT_GT(least.rays, 0);
    EXPECT_EQ(least.hits + least.lookups + least.tangents + least.margin, 0);
    for (const IdleCase& one : idle_cases()) {
        BakeInputs idle = plain(), called = plain();
        one.idle(idle);
        EXPECT_EQ(work_of(idle, with), least) << one.name;
        EXPECT_EQ(std::memcmp(with.localpixels(), without.localpixels(), size_t(without.spec().image_bytes())), 0)
            << one.name;
        if (!one.called)
            continue;
        one.called(called);
        EXPECT_GT(work_of(called, with).*one.more, least.*one.more) << one.name;
        EXPECT_NE(std::memcmp(with.localpixels(), without.localpixels(), size_t(without.spec().image_bytes())), 0)
            << one.name;
    }
}

TEST(EffectsCounted, AGroundTracesNoRayAndSavesThoseThatItBlocks)
{
    BakeInputs inputs = plain();
    OIIO::ImageBuf map;
    const CountedBake without = work_of(inputs, map);
    const int64_t blocked = work_counts().directions_below_ground;
    inputs.params.ground = true;
    inputs.params.ground_height = -5;
    const CountedBake with = work_of(inputs, map);
    EXPECT_LT(with.rays, without.rays);
    EXPECT_EQ(with.casters, without.casters);
    EXPECT_EQ(work_counts().directions_below_ground - blocked, without.rays - with.rays);
    inputs.params.max_distance = 3; // out of reach
    EXPECT_EQ(work_of(inputs, map), without);
}

TEST(EffectsCounted, DecidingIsUnderAHundredthOfTheBakeOrATenthOfWhatItSaves)
{
    // Boxes that a ray is compared with on its way: twice the depth of the tree, at least.
    const auto boxes_of = [](const BakeScene& scene) { return 2 * std::log2(2.0 + double(scene.triangle_count())); };
    const std::pair<Mesh, std::vector<Mesh>> scenes[] {
        { plain().mesh, { ball() } },
        { icosphere(5), {} },
        { box(V3d(-1, 0, -1), V3d(1, 0.1, 1), false), { placed(icosphere(4), 0.3, V3d(0, -1, 0)) } },
        { sphere(V3d(0), 1, 40, true), {} },
        { box(V3d(-3, -3, -3), V3d(3, 3, 3), true), { icosphere(5), placed(icosphere(4), 1, V3d(0, -9, 0)) } },
    };
    for (const auto& [mesh, occluders] : scenes) {
        const auto scene = std::make_shared<BakeScene>();
        std::string error;
        ASSERT_TRUE(scene->build(non_owning(mesh), occluders, 1, error)) << error;
        VismapParams params = map_params(512, 512, 64);
        params.skip_open = true;
        VismapBaker baker;
        ASSERT_TRUE(baker.prepare(scene, params, error, 1)) << error;
        int64_t covered = 0;
        const VismapBaker::ScratchPointer scratch = baker.scratch();
        for (int tile = 0; tile < baker.tiles_across() * baker.tiles_down(); ++tile) {
            TileBits bits;
            baker.cover_tile(tile, *scratch, bits);
            for (const uint64_t row : bits)
                covered += __builtin_popcountll(row);
        }
        // What would be traced if nothing had been decided; and of it, what is not.
        const double bake = double(covered) * params.samples * boxes_of(*scene);
        const BakeFacts facts = bake_facts(*scene, baker, covered);
        EXPECT_GT(facts.tests, 0) << mesh.name;
        EXPECT_LT(double(facts.tests), 0.01 * bake + 0.1 * bake * facts.open_share) << mesh.name;
    }
}

TEST(EffectsCounted, TransparentEverywhereIsNotThere)
{
    BakeInputs inputs = plain();
    inputs.occluders = { with_alpha(placed(ball(), 1, V3d(0.5, 0, 2)), 0) };
    OIIO::ImageBuf map, plain_map;
    const CountedBake with = work_of(inputs, map), without = work_of(plain(), plain_map);
    EXPECT_EQ(with.hits, 0);
    EXPECT_EQ(with.rays, without.rays);
    EXPECT_EQ(std::memcmp(map.localpixels(), plain_map.localpixels(), size_t(map.spec().image_bytes())), 0);
}
