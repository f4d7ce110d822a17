// SPDX-License-Identifier: Apache-2.0
// Rays that meet instances, against those that meet the same triangles on their own.
#include "cutout_scene.h"
#include "instance_places.h"

#include <vmlight/mesh/instances.h>
#include <vmlight/trace/instance_plan.h>
#include <vmlight/trace/occluder.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

const float kInfinite = std::numeric_limits<float>::infinity();

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
