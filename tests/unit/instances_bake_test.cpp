// SPDX-License-Identifier: Apache-2.0
// Maps of what instances hide, against closed forms and the same triangles on their own; scenes of instances.
#include "instance_places.h"

#include <vmlight/mesh/instances.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/trace/posed_parts.h>
#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/light_transport.h>

#include <OpenImageIO/imagebuf.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

BakeScenePointer scene_with(const Mesh& mesh, const std::vector<Mesh>& occluders, InstanceMode mode)
{
    SceneChoice choice;
    choice.instances = mode;
    const auto scene = std::make_shared<BakeScene>();
    std::string error;
    EXPECT_TRUE(scene->build(non_owning(mesh), occluders, 1, error, choice)) << error;
    return scene;
}

OIIO::ImageBuf bake_of(const BakeScenePointer& scene, const VismapParams& params)
{
    OIIO::ImageBuf map;
    EXPECT_TRUE(make_vismap(map, scene, params, nullptr, 1, {}, 0, nullptr, {})) << map.geterror();
    return map;
}

float visibility(const OIIO::ImageBuf& map, int x, int y)
{
    return map.getchannel(x, y, 0, 0);
}

VismapParams small_map(int side, int samples)
{
    VismapParams params;
    params.width = params.height = side;
    params.samples = samples;
    params.margin = 0;
    return params;
}

} // namespace

TEST(Instances, ADiscHidesItsShareOfTheSky)
{
    // Of a unit disc: radius .6, stretched to an ellipse and back by two scales, at a height of .8.
    const Mesh mesh = floor_facing_z(1);
    const Mesh occluder = with_places(disc(V3d(0), 1), { placed_at(V3d(-0.6, 0.6, 3), V3d(0, 0, 33), V3d(0, 0, 0.8)) });
    const BakeScenePointer scene = scene_with(mesh, { occluder }, InstanceMode::all);
    EXPECT_EQ(scene->occluder().instances().instances, 1);
    EXPECT_NEAR(visibility(bake_of(scene, small_map(3, 2048)), 1, 1), 1 - 0.36 / (0.36 + 0.64), 0.005);
}

// The least gap that is resolved is 2^-20 of the frame; instances take up some of it.
TEST(Instances, WhatTouchesTheSurfaceHidesIt)
{
    const Mesh floor = floor_facing_z(1);
    const Mesh block = box(V3d(-1, -1, 0), V3d(1, 1, 1), false);
    for (const double gap : { 0x1p-19, 0x1p-17, 0x1p-15, 0x1p-14, 0x1p-12, -0x1p-18, -0x1p-12 })
        for (const double turn : { 0.0, 37.0, 90.0 })
            for (const double flat : { 1.0, 0.2 }) {
                const Mesh occluder = with_places(
                    block, { placed_at(V3d(0.5, 0.5, 0.5 * flat), V3d(0, 0, turn), V3d(0.1, -0.05, gap)) });
                const auto map = bake_of(scene_with(floor, { occluder }, InstanceMode::all), small_map(9, 64));
                const auto truth = bake_of(scene_with(floor, { occluder }, InstanceMode::none), small_map(9, 64));
                EXPECT_EQ(visibility(map, 4, 4), 0) << gap << " " << turn << " " << flat;
                for (int y = 0; y < 9; ++y)
                    for (int x = 0; x < 9; ++x)
                        EXPECT_NEAR(visibility(map, x, y), visibility(truth, x, y), 1.5 / 64)
                            << x << " " << y << " " << gap << " " << turn;
            }
}

TEST(Instances, FewCopiesAreTheTrianglesThatTheyWouldBeAlone)
{
    const Mesh floor = floor_facing_z(1);
    const std::vector<M44d> places { placed_at(V3d(0.3), V3d(0), V3d(0, 0, 0.5)),
                                     placed_at(V3d(0.2, -0.3, 0.2), V3d(5), V3d(0.5, 0.2, 0.4)) };
    const Mesh ball = icosphere(2);
    const BakeScenePointer few = scene_with(floor, { with_places(ball, places) }, InstanceMode::many);
    EXPECT_EQ(few->occluder().instances().copies, 2);
    const BakeScenePointer alone
        = scene_with(floor, { placed_mesh(ball, places[0]), placed_mesh(ball, places[1]) }, {});
    const auto a = bake_of(few, small_map(32, 64)), b = bake_of(alone, small_map(32, 64));
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x)
            EXPECT_EQ(visibility(a, x, y), visibility(b, x, y));
    EXPECT_NE(few->occluder_hashes(), alone->occluder_hashes());
}

TEST(Instances, ManyAreInstancesAndCountedOnce)
{
    const Mesh floor = floor_facing_z(1);
    const BakeScenePointer scene
        = scene_with(floor, { with_places(icosphere(3), random_places(100, 0.05)) }, InstanceMode::many);
    EXPECT_EQ(scene->occluder().instances().instances, 100);
    EXPECT_EQ(scene->triangle_count(), 2 + 1280);
    ASSERT_EQ(scene->reach().size(), 1u);
    EXPECT_EQ(scene->reach()[0].triangles, 128000);
    EXPECT_EQ(scene->reach()[0].verdict, CasterReach::reaches);
}

TEST(Instances, WhatNoRayCanMeetIsLeftOut)
{
    const Mesh floor = floor_facing_z(1);
    const auto verdict = [&](double height, double reach) {
        const Mesh below = with_places(
            icosphere(1),
            { placed_at(V3d(0.3), V3d(0), V3d(0, 0, height)), placed_at(V3d(0.3), V3d(0), V3d(5, 0, height)) });
        SceneChoice choice = SceneChoice::within(reach);
        BakeScene scene;
        std::string error;
        EXPECT_TRUE(scene.build(non_owning(floor), { below }, 1, error, choice)) << error;
        return scene.reach()[0].verdict;
    };
    EXPECT_EQ(verdict(-0.5, INFINITY), CasterReach::below_horizon);
    EXPECT_EQ(verdict(-0.2, INFINITY), CasterReach::reaches) << "they rise above it";
    EXPECT_EQ(verdict(3, 1), CasterReach::too_far);
    EXPECT_EQ(verdict(3, 3), CasterReach::reaches);
}

TEST(Instances, PlacesThatCannotBeTracedAreRefused)
{
    const Mesh floor = floor_facing_z(1);
    const auto said = [&](Mesh mesh) {
        BakeScene scene;
        std::string error;
        EXPECT_FALSE(scene.build(non_owning(floor), { std::move(mesh) }, 1, error));
        return error;
    };
    M44d bad;
    bad[3][0] = NAN;
    EXPECT_EQ(said(with_places(icosphere(0), { M44d(), bad })),
              "\"places\": instance 1 has a transform that is not finite");
    Mesh missing = with_places(icosphere(0), { M44d() });
    missing.instances->places[0].mesh = 1;
    EXPECT_EQ(said(missing), "\"places\": instance 0 has a mesh that does not exist");
    EXPECT_THAT(said(with_places(icosphere(0), { placed_at(V3d(1), V3d(0), V3d(1e19, 0, 0)) })),
                testing::HasSubstr("instance 0 is 1e+19 times the size of the baked mesh away"));
}

TEST(Instances, PlacedMeshesKeepTheirOutside)
{
    const Mesh ball = icosphere(2);
    const Mesh mirrored = placed_mesh(ball, placed_at(V3d(-1, 2, 1), V3d(10), V3d(1, 2, 3)));
    for (const auto& triangle : mirrored.triangles) {
        const V3d normal = triangle_area_normal(mirrored, triangle);
        EXPECT_GT(normal.dot(mirrored.positions[triangle[0]] - V3d(1, 2, 3)), 0);
        EXPECT_GT(normal.dot(V3d(mirrored.normals[triangle[0]])), 0);
    }
}

TEST(Instances, WhatCannotBeDoneWithThemIsSaid)
{
    const Mesh floor = floor_facing_z(1);
    const Mesh balls = with_places(icosphere(1), { placed_at(V3d(0.3), V3d(0), V3d(0, 0, 1)) });
    for (const InstanceMode mode : { InstanceMode::all, InstanceMode::none }) {
        const BakeScenePointer scene = scene_with(floor, { balls }, mode);
        LightTransport transport;
        std::string error;
        EXPECT_FALSE(transport.prepare(scene, small_map(8, 4), {}, {}, error));
        EXPECT_THAT(error, testing::HasSubstr("an occluder has instances, whose light is not traced"));
        std::string fault;
        EXPECT_TRUE(match_parts(*scene, *scene, fault).empty());
        EXPECT_EQ(fault, "instances are not compared");
    }
}
