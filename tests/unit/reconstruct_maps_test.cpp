// SPDX-License-Identifier: Apache-2.0
// Maps whose texels take from their neighbours: how much less their error is, and which maps they are.
#include "error_scenes.h"
#include "pose_scenes.h"

#include <vmlight/math/longest_direction.h>
#include <vmlight/stage/bake_switches.h>
#include <vmlight/stage/recipe/chain.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/stage/recipe/recipe_effects.h>
#include <vmlight/stage/recipe/unused_flags.h>
#include <vmlight/vismap/reconstruct.h>

#include <gmock/gmock.h>

#include <utility>
#include <vector>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

bool are_equal_maps(const BakedMap& a, const BakedMap& b)
{
    std::vector<float> left(size_t(a.spec().image_pixels()) * size_t(a.spec().nchannels)), right(left.size());
    a.image().get_pixels(a.image().roi(), OIIO::TypeFloat, left.data());
    return b.spec().nchannels == a.spec().nchannels
        && b.image().get_pixels(b.image().roi(), OIIO::TypeFloat, right.data()) && left == right;
}

BakeInput three_boxes()
{
    BakeInput scene { floor_facing_z(1), {} };
    for (double x : { -0.7, 0.0, 0.7 })
        scene.occluders.push_back(box(V3d(x - 0.2, -0.8, 0), V3d(x + 0.2, 0.7, 0.6), false));
    return scene;
}

} // namespace

TEST(Reconstruct, OpenTexelsStayOpenAndClosedOnesClosed)
{
    for (const char* basis : { "vector", "sh" }) {
        VismapParams params = map_params(64, 64, 16);
        params.basis = basis;
        VismapParams with = params;
        with.reconstruct = "auto";
        const BakeInput open { floor_facing_z(1), {} }, closed { floor_facing_z(0.3), { sphere(V3d(0), 1, 24, true) } };
        for (const auto& [scene, visibility] : { std::pair(open, 1.0f), { closed, 0.0f } }) {
            const BakedMap plain(scene.mesh, scene.occluders, params), map(scene.mesh, scene.occluders, with);
            EXPECT_TRUE(are_equal_maps(map, plain));
            EXPECT_EQ(map.at(32, 32).visibility, visibility);
        }
    }
}

TEST(Reconstruct, TheErrorOfVisibilityAndDirectionFalls)
{
    for (const BakeInput& scene : { ball_over_floor(), three_boxes(), spot_on_the_ground() })
        for (const int samples : { 16, 64 }) {
            VismapParams params = error_params(96, samples), with = reconstruct_params(96, samples);
            const BakedMap reference = reference_of(scene, 96, samples);
            const BakedMap plain(scene.mesh, scene.occluders, params), map(scene.mesh, scene.occluders, with);
            const auto direction_rms = [&](const BakedMap& of) {
                return rms(of, [&](const float* texel, int x, int y) {
                    return double((V3f(texel[1], texel[2], texel[3]) - reference.at(x, y).direction).length());
                });
            };
            EXPECT_LT(true_rms(map, reference), true_rms(plain, reference) / 1.3) << samples;
            EXPECT_LT(direction_rms(map), direction_rms(plain) / 1.3) << samples;
        }
}

TEST(Reconstruct, DirectionsAreNoLongerThanASurfaceCanSee)
{
    const BakeInput scene = spot_on_the_ground();
    const BakedMap map(scene.mesh, scene.occluders, reconstruct_params(96, 8));
    map.each([](const Texel& t, int x, int y) {
        ASSERT_GE(t.visibility, 0) << x << " " << y;
        ASSERT_LE(t.visibility, 1) << x << " " << y;
        ASSERT_LE(double(t.direction.length()), longest_direction(t.visibility) * (1 + 2e-6)) << x << " " << y;
    });
}

TEST(Reconstruct, TheErrorThatIsSaidIsThatOfTheReconstructedMap)
{
    int number = 0;
    for (const BakeInput& scene : { ball_over_floor(), three_boxes(), spot_on_the_ground() }) {
        SCOPED_TRACE(number++);
        for (const auto& [samples, side] : { std::pair(16, 128), { 64, 96 } }) {
            const BakedMap reference = reference_of(scene, side, samples);
            const BakedMap map(scene.mesh, scene.occluders, reconstruct_params(side, samples));
            const double truth = true_rms(map, reference);
            EXPECT_NEAR(map.report.error / truth, 1, 0.25) << samples;
            EXPECT_NEAR(channel_rms(map) / truth, 1, 0.25) << samples;
        }
    }
}

TEST(Reconstruct, ATargetErrorTakesFewerRays)
{
    const BakeInput scene = ball_over_floor();
    VismapParams plain = error_params(96, 1), with = reconstruct_params(96, 1);
    plain.target_error = with.target_error = 0.005;
    const BakedMap before(scene.mesh, scene.occluders, plain), after(scene.mesh, scene.occluders, with);
    EXPECT_LT(after.report.samples * 1.5, before.report.samples);
    EXPECT_LE(after.report.error, 0.005);
}

TEST(Reconstruct, TheSameBytesForAnyThreads)
{
    const BakeInput scene = spot_on_the_ground();
    VismapParams params = reconstruct_params(160, 8);
    params.basis = "sh";
    const BakedMap one(scene.mesh, scene.occluders, params, 1), many(scene.mesh, scene.occluders, params, 5);
    EXPECT_TRUE(are_equal_maps(one, many));
    EXPECT_EQ(one.report.error, many.report.error);
}

TEST(Reconstruct, ItIsOnUnlessSwitchedOffAndTheMapSaysWhether)
{
    const BakeInput scene = ball_over_floor();
    VismapParams params = map_params(64, 64, 16);
    params.reconstruct = "off";
    EXPECT_FALSE(BakedMap(scene.mesh, scene.occluders, params).spec().find_attribute("vmlight:reconstruct"));
    params.reconstruct = VismapParams().reconstruct;
    EXPECT_EQ(BakedMap(scene.mesh, scene.occluders, params).spec().get_string_attribute("vmlight:reconstruct"), "auto");
    // Where it cannot be, the map is what it was.
    params.basis = "mask";
    VismapParams plain = params;
    plain.reconstruct = "off";
    const BakedMap map(scene.mesh, scene.occluders, params);
    EXPECT_TRUE(are_equal_maps(map, BakedMap(scene.mesh, scene.occluders, plain)));
    EXPECT_FALSE(map.spec().find_attribute("vmlight:reconstruct"));
}

TEST(Reconstruct, AFlagThatCannotChangeThePictureIsRefusedWithTheReason)
{
    VismapRecipe recipe;
    EXPECT_EQ(unused_reason(recipe, "reconstruct"), "");
    recipe.vismap_params.reconstruct = "auto";
    EXPECT_EQ(unused_reason(recipe, "reconstruct"), "");
    recipe.vismap_params.basis = "cells";
    EXPECT_EQ(unused_reason(recipe, "reconstruct"), "what the basis cells packs of each ray has no mean");
    recipe.vismap_params.basis = "sh";
    EXPECT_EQ(unused_reason(recipe, "reconstruct"), "");
    recipe.vismap_params.measure = "uniform";
    EXPECT_EQ(unused_reason(recipe, "reconstruct"), "with the measure uniform, B is not a mean over rays");
    recipe.vismap_params.measure = "cosine";
    recipe.vismap_params.samples = 1;
    EXPECT_EQ(unused_reason(recipe, "reconstruct"), "it needs at least 2 rays per texel");
    recipe.vismap_params.samples = 2;
    EXPECT_EQ(unused_reason(recipe, "reconstruct"), "");
    recipe.normal_map = "bumps.png";
    EXPECT_EQ(unused_reason(recipe, "reconstruct"), "with a normal map, neighbouring texels have normals of their own");
    recipe.vismap_params.reconstruct = "off";
    EXPECT_EQ(unused_reason(recipe, "reconstruct"), "") << "what is off can be said to be";
}

TEST(Reconstruct, ARecipeThatCannotHaveItIsBakedWithout)
{
    VismapRecipe recipe;
    recipe.mesh = "hero.obj";
    recipe.vismap_params.reconstruct = "auto";
    EXPECT_EQ(why_not_reconstructed(recipe), "");
    for (const char* basis : { "mask", "cells" }) {
        recipe.vismap_params.basis = basis;
        EXPECT_EQ(recipe_fault(recipe, {}), "");
        EXPECT_FALSE(is_reconstructed(with_switches(recipe).vismap_params));
        EXPECT_THAT(why_not_reconstructed(recipe), testing::HasSubstr(basis));
    }
    recipe.vismap_params = {};
    recipe.vismap_params.reconstruct = "auto";
    recipe.normal_map = "bumps.png";
    EXPECT_EQ(recipe_fault(recipe, {}), "");
    EXPECT_FALSE(is_reconstructed(with_switches(recipe).vismap_params));
    EXPECT_NE(why_not_reconstructed(recipe), "");
    // What is switched off cannot stand in the way.
    recipe.effects = "-normal-map";
    EXPECT_TRUE(is_reconstructed(with_switches(recipe).vismap_params));
    EXPECT_EQ(why_not_reconstructed(recipe), "");
    recipe.effects = "-normal-map,-reconstruction";
    EXPECT_FALSE(is_reconstructed(with_switches(recipe).vismap_params));
    recipe.vismap_params.reconstruct = "off";
    EXPECT_EQ(why_not_reconstructed(recipe), "reconstruct is off");
}

TEST(Reconstruct, APoseThatChangesNothingHasTheBytesOfItsBase)
{
    VismapParams params = pose_params(128, 32);
    params.reconstruct = "auto";
    PoseSequence sequence(0);
    const auto base = bake_pose(sequence, scene_of(door(20)), params, "a");
    const auto same = bake_pose(sequence, scene_of(door(20)), params, "b");
    EXPECT_EQ(same->pose.base, "a");
    EXPECT_EQ(same->report.rays, 0);
    EXPECT_TRUE(same->has_bytes_of(*base));
    const auto moved = bake_pose(sequence, scene_of(door(40)), params, "c");
    EXPECT_TRUE(moved->has_bytes_of(*bake_alone(scene_of(door(40)), params)));
}
