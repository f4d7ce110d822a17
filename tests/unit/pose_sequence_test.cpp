// SPDX-License-Identifier: Apache-2.0
// Poses baked one after the other: what is kept is what it was, and the rest is traced.
#include "pose_scenes.h"

#include <OpenImageIO/imagebuf.h>

#include <limits>
#include <memory>
#include <string>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

V3d direction_of(const float* texel)
{
    return V3d(texel[1], texel[2], texel[3]);
}

} // namespace

TEST(PoseSequence, ARigidMoveTracesNoRay)
{
    const Mesh ball = placed(icosphere(1), 0.4, V3d(0.5, 1.6, 0.2));
    for (const double error : { 0.0, kSequenceError }) {
        const Rotation turn = rotation_from_angles(20, 50, -110);
        const V3d shift(3, -2, 1);
        PoseSequence sequence(error);
        const auto base = bake_pose(sequence, scene_of(skin(0), { ball }), pose_params(96, 64), "a");
        const auto pose = bake_pose(sequence, scene_of(moved(skin(0), turn, shift), { moved(ball, turn, shift) }),
                                    pose_params(96, 64), "b");
        EXPECT_GT(base->report.rays, 0);
        EXPECT_EQ(pose->report.rays, 0);
        EXPECT_TRUE(pose->pose.is_rigid);
        EXPECT_EQ(pose->pose.base, "a");
        EXPECT_EQ(pose->pose.kept, pose->report.covered - pose->report.open);
        base->each_covered([&](int x, int y) {
            const float *a = base->at(x, y), *b = pose->at(x, y);
            ASSERT_EQ(a[0], b[0]) << x << " " << y;
            ASSERT_LT((direction_of(b) - rotate(turn, direction_of(a))).length(), 1e-6) << x << " " << y;
        });
        EXPECT_EQ(pose->image.spec().get_string_attribute("vmlight:pose_base"), "a");
        EXPECT_EQ(base->image.spec().get_string_attribute("vmlight:pose_base"), "");
    }
}

TEST(PoseSequence, WhatStandsStillOnTheGroundIsNotWhatTurnsOnIt)
{
    VismapParams params = pose_params(64, 32);
    params.ground = true;
    const auto rays = [&](const Rotation& turn, V3d shift) {
        PoseSequence sequence(0);
        bake_pose(sequence, scene_of(skin(0)), params, "a");
        return bake_pose(sequence, scene_of(moved(skin(0), turn, shift)), params, "b")->report.rays;
    };
    EXPECT_EQ(rays(rotation_from_angles(0, 40, 0), V3d(5, 0, 2)), 0);
    EXPECT_GT(rays(rotation_from_angles(3, 0, 0), V3d(0)), 0);
    // The ground moves with the lowest point; one at a height does not. Without end it hides the same, from any height.
    EXPECT_EQ(rays(Rotation(), V3d(0, 1, 0)), 0);
    params.ground_height = -3;
    EXPECT_EQ(rays(Rotation(), V3d(0, 1, 0)), 0);
    params.max_distance = 5;
    EXPECT_GT(rays(Rotation(), V3d(0, 1, 0)), 0);
}

TEST(PoseSequence, ProvenTexelsHaveTheBytesOfAPlainBake)
{
    VismapParams params = pose_params(128, 64);
    params.channels = { "normal", "error" }; // each map scales its errors
    PoseSequence sequence(0);
    // A tower whose top floor turns: the sides below do not see it, and what it covers is traced.
    const auto tower = [](double degrees) {
        Mesh mesh = box(V3d(-1, 0, -1), V3d(1, 4, 1), false);
        for (V2f& uv : mesh.uvs)
            uv.y *= 0.75f;
        const auto boards = uint32_t(mesh.positions.size());
        add_quad(mesh, V3d(-0.6, 4.5, 0.6), V3d(0.6, 4.5, 0.6), V3d(0.6, 4.5, -0.6), V3d(-0.6, 4.5, -0.6),
                 V2f(0.01f, 0.8f), V2f(0.2f, 0.99f));
        add_quad(mesh, V3d(3, 0, 1), V3d(3, 1, 1), V3d(3, 1, -1), V3d(3, 0, -1), V2f(0.3f, 0.8f), V2f(0.4f, 0.85f));
        add_quad(mesh, V3d(-3, 0, -1), V3d(-3, 1, -1), V3d(-3, 1, 1), V3d(-3, 0, 1), V2f(0.5f, 0.8f), V2f(0.6f, 0.85f));
        for (uint32_t i = boards; i < boards + 4; ++i)
            mesh.positions[i] = rotate(rotation_from_angles(0, degrees, 0), mesh.positions[i]);
        return mesh;
    };
    const auto base = bake_pose(sequence, scene_of(tower(0)), params, "a");
    const auto kept = bake_pose(sequence, scene_of(tower(30)), params, "b");
    const auto whole = bake_alone(scene_of(tower(30)), params);
    EXPECT_TRUE(kept->has_bytes_of(*whole));
    EXPECT_FALSE(kept->has_bytes_of(*base));
    EXPECT_LT(kept->report.rays, whole->report.rays);
    EXPECT_GT(kept->report.rays, 0);
    EXPECT_EQ(kept->pose.change.probes, 0);
}

TEST(PoseSequence, TheSameBytesForAnyThreads)
{
    const VismapParams params = pose_params(128, 32);
    std::unique_ptr<PoseMap> maps[3];
    const int threads[3] = { 1, 2, 5 };
    for (int i = 0; i < 3; ++i) {
        PoseSequence sequence(kSequenceError);
        bake_pose(sequence, scene_of(flag(0)), params, "a", threads[i]);
        maps[i] = bake_pose(sequence, scene_of(flag(0.2)), params, "b", threads[i]);
        EXPECT_TRUE(maps[i]->has_bytes_of(*maps[0])) << threads[i];
        EXPECT_EQ(maps[i]->report.rays, maps[0]->report.rays);
        EXPECT_EQ(maps[i]->pose.kept, maps[0]->pose.kept);
        EXPECT_EQ(maps[i]->pose.change.bound, maps[0]->pose.change.bound);
    }
}

TEST(PoseSequence, WhatMostlyChangesIsTheNextBase)
{
    const VismapParams params = pose_params(96, 32);
    PoseSequence sequence(kSequenceError);
    bake_pose(sequence, scene_of(skin(0)), params, "shallow");
    const auto deep = bake_pose(sequence, scene_of(skin(0.2)), params, "deep");
    EXPECT_EQ(deep->pose.base, "");
    EXPECT_EQ(deep->pose.why, "most of it changes");
    EXPECT_TRUE(deep->has_bytes_of(*bake_alone(scene_of(skin(0.2)), params)));
    const auto again = bake_pose(sequence, scene_of(skin(0.2)), params, "again");
    EXPECT_EQ(again->pose.base, "deep");
    EXPECT_EQ(again->report.rays, 0);
}

TEST(PoseSequence, OfTexelsThatStandStillOnlyRaysAreTracedThatMayMeetWhatMoves)
{
    for (const char* basis : { "vector", "sh", "cells" })
        for (const bool ground : { false, true }) {
            VismapParams params = pose_params(112, 64);
            params.basis = basis;
            params.ground = ground;
            params.ground_height = -0.5;
            params.max_distance = ground ? 9 : std::numeric_limits<double>::infinity();
            PoseSequence sequence(0);
            bake_pose(sequence, scene_of(door(0)), params, "a");
            const auto pose = bake_pose(sequence, scene_of(door(40)), params, "b");
            const auto whole = bake_alone(scene_of(door(40)), params);
            EXPECT_TRUE(pose->has_bytes_of(*whole)) << basis << ground;
            EXPECT_LE(pose->report.rays * 5, whole->report.rays) << basis << ground;
        }
}

TEST(PoseSequence, AnotherMeshIsBakedWholeAndSaysWhy)
{
    const VismapParams params = pose_params(64, 16);
    PoseSequence sequence(kSequenceError);
    bake_pose(sequence, scene_of(door(0)), params, "a");
    Mesh other = door(0);
    other.triangles.pop_back();
    const auto fewer = bake_pose(sequence, scene_of(other), params, "b");
    EXPECT_NE(fewer->pose.why.find("has 375 triangles"), std::string::npos) << fewer->pose.why;
    EXPECT_TRUE(fewer->has_bytes_of(*bake_alone(scene_of(other), params)));
    // A triangle that has no area in one pose leaves its texels to others.
    Mesh flat = other;
    flat.positions[flat.triangles[3][2]] = flat.positions[flat.triangles[3][0]];
    const auto without = bake_pose(sequence, scene_of(flat), params, "c");
    EXPECT_NE(without->pose.why.find("has an area in one pose only"), std::string::npos) << without->pose.why;
    EXPECT_TRUE(without->has_bytes_of(*bake_alone(scene_of(flat), params)));
}

TEST(PoseSequence, ConvexThingsNeedNoProbe)
{
    PoseSequence sequence(kSequenceError);
    const VismapParams params = pose_params(96, 64);
    bake_pose(sequence, scene_of(placed(icosphere(3), 1)), params, "a");
    Mesh egg = icosphere(3);
    for (V3d& p : egg.positions)
        p.y *= 1.2;
    const auto pose = bake_pose(sequence, scene_of(egg), params, "b");
    EXPECT_EQ(pose->report.rays, 0);
    EXPECT_EQ(pose->report.open, pose->report.covered);
}

TEST(PoseSequence, AnInterruptedBaseLeavesTheLastOne)
{
    const VismapParams params = pose_params(64, 32);
    const BakeScenePointer before = scene_of(door(0)), after = scene_of(door(35));
    PoseSequence sequence(0);
    OIIO::ImageBuf map, whole;
    ASSERT_TRUE(sequence.bake(map, { before, params, 1, {}, 0, nullptr }, "a", nullptr));
    const Progress stop = [](double done) { return done < 0.3; };
    OIIO::ImageBuf stopped;
    ASSERT_FALSE(sequence.bake(stopped, { scene_of(skin(0)), params, 1, stop, 0, nullptr }, "b", nullptr));
    ASSERT_TRUE(sequence.bake(map, { after, params, 1, {}, 0, nullptr }, "c", nullptr));
    EXPECT_EQ(sequence.last().base, "a");
    ASSERT_TRUE(make_vismap(whole, after, params, nullptr, 1, {}, 0, nullptr)) << whole.geterror();
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            ASSERT_EQ(map.getchannel(x, y, 0, 0), whole.getchannel(x, y, 0, 0)) << x << " " << y;
}
