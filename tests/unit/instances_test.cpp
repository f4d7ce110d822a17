// SPDX-License-Identifier: Apache-2.0
// Instances against the same triangles on their own, and closed forms.
#include "baked_map.h"
#include "cutout_scene.h"

#include <vmlight/mesh/instances.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/trace/instance_plan.h>
#include <vmlight/trace/occluder.h>
#include <vmlight/trace/posed_parts.h>
#include <vmlight/trace/surface.h>
#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/light_transport.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Imath/ImathMatrix.h>

#include <cmath>
#include <limits>
#include <random>

using namespace vmlight;
using namespace vmlight::scenes;
using Imath::M44d;

namespace {

const float kInfinite = std::numeric_limits<float>::infinity();

Mesh with_places(const Mesh& distinct, const std::vector<M44d>& places)
{
    Mesh mesh;
    mesh.name = "places";
    mesh.instances = std::make_shared<MeshInstances>();
    mesh.instances->meshes = { distinct };
    for (const M44d& place : places)
        mesh.instances->places.push_back({ 0, place });
    return mesh;
}

M44d placed_at(const V3d& scale, const V3d& degrees, const V3d& offset)
{
    const V3d radians = degrees * (M_PI / 180);
    return M44d().setScale(scale) * M44d().rotate(V3d(radians.x, 0, 0)) * M44d().rotate(V3d(0, radians.y, 0))
        * M44d().rotate(V3d(0, 0, radians.z)) * M44d().setTranslation(offset);
}

// Turned, scaled unevenly, every third mirrored.
std::vector<M44d> random_places(int count, double size)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> number(-1, 1);
    std::vector<M44d> places;
    for (int i = 0; i < count; ++i) {
        const double s = size * std::exp2(number(random));
        const V3d scale(s * (i % 3 ? 1 : -1), s * std::exp2(number(random)), s);
        const V3d turn(180 * number(random), 180 * number(random), 180 * number(random));
        places.push_back(placed_at(scale, turn, V3d(number(random), number(random), number(random))));
    }
    return places;
}

struct TracedPlaces
{
    TracedPlaces(const Mesh& mesh, InstanceMode mode)
    {
        std::string error;
        EXPECT_TRUE(occluder.build({ &mesh }, {}, 1, error, CutoutMode::micromaps, {}, mode)) << error;
    }
    // Of rays from random places, 64 from each.
    std::vector<uint8_t> open(int fans, bool is_near = false) const
    {
        std::mt19937 random(11);
        std::normal_distribution<float> normal;
        std::vector<uint8_t> lanes;
        for (int i = 0; i < fans; ++i) {
            RayFan fan(64);
            for (int k = 0; k < 64; ++k) {
                const V3f d = V3f(normal(random), normal(random), normal(random)).normalized();
                fan.x[k] = d.x, fan.y[k] = d.y, fan.z[k] = d.z;
            }
            for (uint8_t& packet : fan.lanes)
                packet = 0xff;
            occluder.clear_blocked(fan, V3f(normal(random), normal(random), normal(random)), kInfinite, is_near);
            lanes.insert(lanes.end(), fan.lanes.begin(), fan.lanes.end());
        }
        return lanes;
    }
    Occluder occluder;
};

int bits(uint8_t lanes)
{
    return __builtin_popcount(lanes);
}

// Rays that one of two scenes blocks, and those that are open in the second.
std::pair<int, int> differing(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b)
{
    int differ = 0, open = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        differ += bits(uint8_t(a[i] ^ b[i]));
        open += bits(b[i]);
    }
    return { differ, open };
}

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

// Rounding moves edges by some 1e-6. The outlines of 200 balls of radius .1 to .4 are about 300 long together, seen
// from about 2 away: a ray passes one that near with a chance of 2 x 1e-6 x 300 / (4 pi x 4), one in 80,000.
TEST(Instances, AreMetByTheRaysThatMeetTheirTriangles)
{
    const Mesh mesh = with_places(icosphere(3), random_places(200, 0.1));
    const TracedPlaces instances(mesh, InstanceMode::all), triangles(mesh, InstanceMode::none);
    EXPECT_EQ(instances.occluder.instances().instances, 200);
    EXPECT_EQ(instances.occluder.instances().distinct, 1);
    EXPECT_EQ(instances.occluder.instances().triangles, 200 * 1280);
    EXPECT_EQ(triangles.occluder.instances().copies, 200);
    for (const bool is_near : { false, true }) {
        const auto [differ, open] = differing(instances.open(2000, is_near), triangles.open(2000, is_near));
        EXPECT_LE(differ, 8) << "of 128000 rays";
        EXPECT_GT(open, 30000);
        EXPECT_LT(open, 120000);
    }
}

TEST(Instances, NearestHitsAreThoseOfTheirTriangles)
{
    const Mesh mesh = with_places(icosphere(2), random_places(60, 0.2));
    const TracedPlaces instances(mesh, InstanceMode::all), triangles(mesh, InstanceMode::none);
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    int met = 0, differ = 0;
    for (int i = 0; i < 500; ++i) {
        V3f origins[kPacketSize], directions[kPacketSize];
        float lengths[kPacketSize];
        NearestHit a[kPacketSize], b[kPacketSize];
        for (int k = 0; k < kPacketSize; ++k) {
            origins[k] = V3f(normal(random), normal(random), normal(random));
            directions[k] = V3f(normal(random), normal(random), normal(random)).normalized();
            lengths[k] = kInfinite;
        }
        instances.occluder.find_nearest(origins, directions, lengths, kPacketSize, a);
        triangles.occluder.find_nearest(origins, directions, lengths, kPacketSize, b);
        for (int k = 0; k < kPacketSize; ++k) {
            if (a[k].exists() != b[k].exists() || std::abs(a[k].distance - b[k].distance) > 1e-3f) {
                ++differ;
                continue;
            }
            if (!a[k].exists())
                continue;
            ++met;
            EXPECT_EQ(a[k].mesh, 0u);
            EXPECT_EQ(b[k].mesh, 0u);
            // Of the same length and side, mirrored places included; but for the neighbour across an edge.
            differ += (a[k].normal - b[k].normal).length() > 1e-4f * b[k].normal.length();
        }
    }
    EXPECT_GT(met, 1000);
    EXPECT_LE(differ, 3);
}

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

TEST(Instances, CutOutsAreWhereTheyAreOnTheirTriangles)
{
    using namespace cutout_scene;
    const Mesh leaf_quad = with_material(floor_facing_z(1), material(AlphaMode::mask, leaf(64)));
    const Mesh veil = with_material(floor_facing_z(1), material(AlphaMode::blend, nullptr, 0.4));
    const auto count_open = [](const std::vector<uint8_t>& lanes) {
        int sum = 0;
        for (const uint8_t packet : lanes)
            sum += bits(packet);
        return sum;
    };
    const Mesh leaves = with_places(leaf_quad, random_places(150, 0.2));
    const auto [differ, open] = differing(TracedPlaces(leaves, InstanceMode::all).open(2000),
                                          TracedPlaces(leaves, InstanceMode::none).open(2000));
    EXPECT_LE(differ, 16);
    EXPECT_GT(open, 20000);
    Mesh opaque = leaves;
    opaque.instances = std::make_shared<MeshInstances>(*leaves.instances);
    opaque.instances->meshes[0].opacity = nullptr;
    EXPECT_GT(open, count_open(TracedPlaces(opaque, InstanceMode::all).open(2000)) + 5000) << "there are holes";
    // Chance is of its own in each place: two sheets above each other pass .6 x .6.
    const Mesh sheets
        = with_places(veil, { placed_at(V3d(3), V3d(0), V3d(0, 0, 1)), placed_at(V3d(3), V3d(0), V3d(0, 0, 2)) });
    for (const InstanceMode mode : { InstanceMode::all, InstanceMode::none }) {
        const TracedPlaces scene(sheets, mode);
        std::mt19937 random(2);
        std::uniform_real_distribution<float> number(-0.5f, 0.5f);
        int passed = 0;
        for (int i = 0; i < 1000; ++i) {
            RayFan fan(8);
            for (int k = 0; k < 8; ++k) {
                const V3f d = V3f(number(random), number(random), 1).normalized();
                fan.x[k] = d.x, fan.y[k] = d.y, fan.z[k] = d.z;
            }
            fan.lanes[0] = 0xff;
            scene.occluder.clear_blocked(fan, V3f(0), kInfinite);
            passed += bits(fan.lanes[0]);
        }
        EXPECT_NEAR(passed / 8000.0, 0.36, 5 * std::sqrt(0.36 * 0.64 / 8000));
    }
}

TEST(Instances, WhatFloatsWouldMoveTooFarIsTriangles)
{
    const SceneFrame unit;
    InstanceTransform transform;
    const auto is_instance = [&](const V3d& scale) {
        return instance_transform(transform, placed_at(scale, V3d(10, 20, 30), V3d(1, 2, 3)), unit, unit);
    };
    EXPECT_TRUE(is_instance(V3d(1)));
    EXPECT_TRUE(is_instance(V3d(-7, 1, 1)));
    EXPECT_TRUE(is_instance(V3d(1e-6)));
    EXPECT_FALSE(is_instance(V3d(9, 1, 1))) << "uneven";
    EXPECT_FALSE(is_instance(V3d(9))) << "larger than what is baked";
    EXPECT_FALSE(is_instance(V3d(1, 1, 0)));
    EXPECT_FALSE(is_instance(V3d(1e-12)));
    EXPECT_FALSE(is_instance(V3d(1e30, 1, 1)));
    const Mesh wall = with_places(
        icosphere(1), { placed_at(V3d(100, 1, 1), V3d(0), V3d(0)), placed_at(V3d(0.2), V3d(0), V3d(3, 0, 0)) });
    const TracedPlaces scene(wall, InstanceMode::all);
    EXPECT_EQ(scene.occluder.instances().copies, 1);
    EXPECT_EQ(scene.occluder.instances().instances, 1);
    const V3f up(0, 0, 1), origins[kPacketSize] = { V3f(40, 0, -5), V3f(3, 0, -5), V3f(3, 3, -5) };
    const V3f directions[kPacketSize] = { up, up, up, up, up, up, up, up };
    EXPECT_EQ(scene.occluder.find_blocked(origins, directions, 3, kInfinite), 3);
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
