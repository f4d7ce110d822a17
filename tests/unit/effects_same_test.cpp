// SPDX-License-Identifier: Apache-2.0
// What cannot change a picture is left out, and the bytes stay: `auto` against `all`.
#include "baked_map.h"
#include "cases.h"
#include "drawn_failure.h"

#include <vmlight/stage/light_forecast.h>
#include <vmlight/vismap/baker.h>

#include <gmock/gmock.h>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

VismapParams proving(int side, int samples)
{
    VismapParams params = map_params(side, side, samples);
    params.skip_open = true;
    return params;
}

} // namespace

TEST(EffectsSame, AutoAndAllHaveTheSameBytesOnTwoHundredScenes)
{
    constexpr int kScenes = cases(200, 40);
    int64_t open = 0, covered = 0, culled = 0, fewer = 0, grounds = 0, mixed = 0, transparent = 0, bumpy = 0, suns = 0,
            bounces = 0, poses = 0, new_bases = 0, one_color = 0, ones = 0, lookups = 0, all_lookups = 0;
    for (uint32_t seed = 0; seed < kScenes; ++seed) {
        const Drawn drawn(seed);
        const LightWork start = LightWork::so_far();
        const DrawnPicture a(drawn, "auto");
        const LightWork middle = LightWork::so_far();
        const DrawnPicture b(drawn, "all");
        const LightWork end = LightWork::so_far();
        ASSERT_EQ(a.difference(b), "") << "seed " << seed << ", and so does " << shrunk(drawn, [](const Drawn& less) {
            return !DrawnPicture(less, "auto").difference(DrawnPicture(less, "all")).empty();
        });
        EXPECT_EQ(b.report.open, 0);
        EXPECT_LE(a.report.rays, b.report.rays);
        EXPECT_EQ(b.traced_casters, drawn.scene.occluders.size());
        lookups += a.cutout_work.lookups;
        all_lookups += b.cutout_work.lookups;
        open += a.report.open;
        covered += a.report.covered;
        culled += int64_t(b.traced_casters - a.traced_casters);
        fewer += a.report.rays < b.report.rays;
        grounds += drawn.scene.params.ground;
        mixed += a.cutouts.mixed > 0;
        transparent += a.cutouts.transparent > 0;
        bumpy += drawn.scene.normal_map.initialized();
        suns += a.suns > 0;
        bounces += a.bounce_rays > 0;
        EXPECT_EQ(a.bounce_rays, b.bounce_rays);
        poses += a.kept > 0;
        EXPECT_EQ(b.kept, 0);
        new_bases += a.is_based_anew;
        one_color += middle.filter_passes - start.filter_passes < end.filter_passes - middle.filter_passes;
        ones += middle.multiplied - start.multiplied < end.multiplied - middle.multiplied;
    }
    // The scenes are of all kinds.
    EXPECT_GT(open, covered / 20);
    EXPECT_LT(open, covered / 2);
    const auto share_of = [](int count) { return count * kScenes / 200; };
    EXPECT_GT(culled, share_of(10));
    EXPECT_GT(fewer, share_of(40));
    EXPECT_GT(grounds, share_of(40));
    EXPECT_GT(mixed, share_of(30));
    EXPECT_LT(2 * lookups, all_lookups); // micromaps know most
    EXPECT_GT(transparent, share_of(30));
    EXPECT_GT(bumpy, share_of(40));
    EXPECT_GT(suns, share_of(5));
    EXPECT_GT(bounces, share_of(30));
    EXPECT_GT(poses, share_of(15));
    EXPECT_GT(new_bases, share_of(1));
    EXPECT_GT(one_color, share_of(40));
    EXPECT_GT(ones, share_of(20));
}

TEST(EffectsSame, AFailingSceneIsShrunk)
{
    int used = 0;
    for (uint32_t seed = 0; seed < 50; ++seed) {
        const Drawn drawn(seed);
        if (!drawn.scene.params.ground || !drawn.light.albedo.initialized())
            continue;
        ++used;
        const std::string least = shrunk(drawn, [](const Drawn& less) {
            return less.scene.params.ground && less.light.albedo.initialized() && less.scene.mesh.triangles.size() > 1;
        });
        EXPECT_THAT(least, testing::HasSubstr("of 2 triangles, ground, basis vector, 1 rays, distance inf, margin 0"));
        EXPECT_THAT(least, testing::HasSubstr("environment 1x1"));
        EXPECT_THAT(least, testing::HasSubstr("model auto, exposure 0"));
    }
    EXPECT_GE(used, 5);
}

TEST(EffectsSame, APoseThatFailsMovesNoMoreThanItMust)
{
    int used = 0;
    for (uint32_t seed = 0; seed < 60; ++seed) {
        const Drawn drawn(seed);
        if (drawn.pose.kind != DrawnPose::both || drawn.scene.occluders.empty())
            continue;
        ++used;
        EXPECT_THAT(shrunk(drawn, [](const Drawn& less) { return less.pose.kind != DrawnPose::none; }),
                    testing::EndsWith("; the same again"));
        EXPECT_THAT(shrunk(drawn, [](const Drawn& less) { return less.pose.kind >= DrawnPose::mesh; }),
                    testing::EndsWith("; its vertices move"));
    }
    EXPECT_GE(used, 2);
}

TEST(EffectsSame, AConvexMeshTracesNoRay)
{
    for (int cuts = 0; cuts < 5; ++cuts)
        for (const double scale : { 1e-6, 1.0, 1e6 }) {
            const BakedMap map(placed(icosphere(cuts), scale, V3d(3, -2, 1) * scale), {}, proving(64, 512));
            EXPECT_EQ(map.report.rays, 0) << cuts << " " << scale;
            EXPECT_EQ(map.report.open, map.report.covered);
            map.each_covered([](const Texel& t, int, int) { EXPECT_EQ(t.visibility, 1); });
        }
}

TEST(EffectsSame, AnInwardMeshTracesAllItsRays)
{
    Mesh mesh = icosphere(2);
    for (V3f& normal : mesh.normals)
        normal = -normal;
    const BakedMap map(mesh, {}, proving(64, 16));
    EXPECT_EQ(map.report.open, 0);
    EXPECT_GT(map.report.rays, map.report.covered * 15);
}

TEST(EffectsSame, OnlyWhatSomethingRisesAboveIsTraced)
{
    // A table: its top sees all, its underside and what is below it do not.
    Mesh mesh = box(V3d(-1, 0, -1), V3d(1, 0.1, 1), false);
    const BakedMap alone(mesh, {}, proving(64, 16));
    EXPECT_EQ(alone.report.rays, 0);
    const BakedMap below(mesh, { placed(icosphere(1), 0.3, V3d(0, -1, 0)) }, proving(64, 16));
    EXPECT_GT(below.report.open, 0);
    EXPECT_LT(below.report.open, below.report.covered);
    EXPECT_EQ(below.report.rays, (below.report.covered - below.report.open) * 16);
}

TEST(EffectsSame, WhatIsBelowEveryHorizonOrOutOfReachIsNotBuilt)
{
    const Mesh floor = floor_facing_z(1);
    const Mesh under = placed(icosphere(2), 0.5, V3d(0, 0, -0.6)), over = placed(icosphere(2), 0.5, V3d(0, 0, 5));
    const auto verdict = [&](const Mesh& occluder, double reach) {
        BakeScene scene;
        std::string error;
        EXPECT_TRUE(scene.build(non_owning(floor), { occluder }, 1, error, SceneChoice::within(reach))) << error;
        const size_t casters = scene.occluder().triangles().size();
        EXPECT_EQ(casters, scene.reach()[0].verdict == CasterReach::reaches ? 2u : 1u);
        return scene.reach()[0].verdict;
    };
    const double endless = std::numeric_limits<double>::infinity();
    EXPECT_EQ(verdict(under, endless), CasterReach::below_horizon);
    EXPECT_EQ(verdict(over, endless), CasterReach::reaches);
    EXPECT_EQ(verdict(over, 4.6), CasterReach::reaches);
    EXPECT_EQ(verdict(over, 4.4), CasterReach::too_far);
    EXPECT_EQ(verdict(floor, endless), CasterReach::below_horizon) << "a copy in the same place";
    EXPECT_EQ(verdict(placed(floor, 1, V3d(0, 0, 1e-5)), endless), CasterReach::reaches) << "just above it";
}

TEST(EffectsSame, ASceneThatWasBuiltForShortRaysRefusesLongOnes)
{
    const Mesh floor = floor_facing_z(1);
    const auto scene = std::make_shared<BakeScene>();
    std::string error;
    ASSERT_TRUE(scene->build(non_owning(floor), {}, 1, error, SceneChoice::within(1)));
    VismapParams params = proving(4, 1);
    VismapBaker baker;
    EXPECT_FALSE(baker.prepare(scene, params, error));
    EXPECT_NE(error.find("max_distance"), std::string::npos) << error;
    params.max_distance = 1;
    EXPECT_TRUE(baker.prepare(scene, params, error)) << error;
}
