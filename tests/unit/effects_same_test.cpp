// SPDX-License-Identifier: Apache-2.0
// What cannot change a picture is left out, and the bytes stay: `auto` against `all`.
#include "baked_map.h"
#include "drawn_scene.h"

#include <vmlight/stage/bake_switches.h>
#include <vmlight/vismap/baker.h>

#include <cstring>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

struct Bake
{
    std::vector<float> pixels;
    VismapReport report;
    size_t traced_casters = 0;
};

Bake bake(const DrawnScene& drawn, const char* effects)
{
    VismapRecipe recipe;
    recipe.vismap_params = drawn.params;
    recipe.occluder.resize(drawn.occluders.size());
    recipe.effects = effects;
    const VismapRecipe switched = with_switches(recipe);
    const auto scene = std::make_shared<BakeScene>();
    std::string error;
    OIIO::ImageBuf image;
    Bake result;
    EXPECT_TRUE(scene->build(non_owning(drawn.mesh), drawn.occluders, 1, error, scene_choice(switched))) << error;
    EXPECT_TRUE(make_vismap(image, scene, switched.vismap_params, &result.report, 1, {})) << image.geterror();
    result.pixels.resize(size_t(image.spec().image_pixels()) * size_t(image.spec().nchannels));
    EXPECT_TRUE(image.get_pixels(OIIO::ROI::All(), OIIO::TypeFloat, result.pixels.data()));
    for (const CasterReach& caster : scene->reach())
        result.traced_casters += caster.is_traced(scene->choice());
    return result;
}

VismapParams proving(int side, int samples)
{
    VismapParams params = map_params(side, side, samples);
    params.skip_open = true;
    return params;
}

bool is_same(const DrawnScene& drawn)
{
    const Bake a = bake(drawn, "auto"), b = bake(drawn, "all");
    return a.pixels.size() == b.pixels.size()
        && std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(float)) == 0;
}

// Takes away what the failure does not need, and says what is left.
std::string shrunk(DrawnScene drawn)
{
    const auto fails_without = [&](auto&& change) {
        DrawnScene less = drawn;
        change(less);
        if (!is_same(less))
            drawn = less;
    };
    for (size_t i = drawn.occluders.size(); i-- > 0;)
        fails_without([&](DrawnScene& less) { less.occluders.erase(less.occluders.begin() + long(i)); });
    fails_without([](DrawnScene& less) { less.params.ground = false; });
    fails_without([](DrawnScene& less) { less.params.max_distance = std::numeric_limits<double>::infinity(); });
    fails_without([](DrawnScene& less) { less.params.channels.clear(); });
    fails_without([](DrawnScene& less) { less.params.basis = "vector"; });
    fails_without([](DrawnScene& less) { less.params.margin = 0; });
    for (size_t i = drawn.mesh.triangles.size(); i-- > 1;)
        fails_without([&](DrawnScene& less) { less.mesh.triangles.erase(less.mesh.triangles.begin() + long(i)); });
    std::string text = drawn.mesh.name + " of " + std::to_string(drawn.mesh.triangles.size()) + " triangles";
    for (const Mesh& occluder : drawn.occluders)
        text += ", " + occluder.name + " (" + std::to_string(occluder.triangles.size()) + " triangles)";
    return text + (drawn.params.ground ? ", ground" : "") + ", basis " + drawn.params.basis + ", "
        + std::to_string(drawn.params.samples) + " rays, distance " + std::to_string(drawn.params.max_distance);
}

} // namespace

TEST(EffectsSame, AutoAndAllHaveTheSameBytesOnTwoHundredScenes)
{
    int64_t open = 0, covered = 0, culled = 0, fewer = 0, grounds = 0;
    for (uint32_t seed = 0; seed < 200; ++seed) {
        const DrawnScene drawn(seed);
        const Bake a = bake(drawn, "auto"), b = bake(drawn, "all");
        ASSERT_TRUE(is_same(drawn)) << "seed " << seed << ": " << shrunk(drawn);
        EXPECT_EQ(b.report.open, 0);
        EXPECT_LE(a.report.rays, b.report.rays);
        EXPECT_EQ(b.traced_casters, drawn.occluders.size());
        open += a.report.open;
        covered += a.report.covered;
        culled += int64_t(b.traced_casters - a.traced_casters);
        fewer += a.report.rays < b.report.rays;
        grounds += drawn.params.ground;
    }
    // The scenes are of all kinds.
    EXPECT_GT(open, covered / 20);
    EXPECT_LT(open, covered / 2);
    EXPECT_GT(culled, 10);
    EXPECT_GT(fewer, 40);
    EXPECT_GT(grounds, 40);
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
