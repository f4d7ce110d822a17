// SPDX-License-Identifier: Apache-2.0
// Poses baked one after the other: what is kept is what it was, and the rest is traced.
#include "drawn_scene.h"
#include "pose_scenes.h"

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

constexpr double kSequenceError = 0.01;

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

TEST(PoseSequence, ADoorThatOpensTakesAFifthOfTheRays)
{
    const VismapParams params = pose_params(256, 256);
    PoseSequence sequence(kSequenceError);
    bake_pose(sequence, scene_of(door(0)), params, "a");
    for (const double degrees : { 10, 35, 80 }) {
        const auto kept = bake_pose(sequence, scene_of(door(degrees)), params, "b");
        const auto whole = bake_alone(scene_of(door(degrees)), params);
        EXPECT_LE(kept->report.rays * 5, whole->report.rays) << degrees;
        // The same rays, but where the door turns: there two bakes differ by their noise.
        EXPECT_LE(share_beyond(*kept, *whole, kSequenceError), 0.01) << degrees;
        EXPECT_EQ(kept->report.covered, whole->report.covered);
        EXPECT_GT(kept->pose.kept, kept->pose.covered / 2);
        EXPECT_EQ(kept->pose.base, "a");
    }
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

TEST(PoseSequence, AnOccluderThatComesIntoReachIsTracedOnlyWhereItIsSeen)
{
    VismapParams params = pose_params(160, 64);
    params.max_distance = 4;
    const auto scene = [&](double x) {
        const auto built = std::make_shared<BakeScene>();
        std::string error;
        EXPECT_TRUE(built->build(std::make_shared<const Mesh>(door(0)), { placed(icosphere(1), 0.5, V3d(x, 0.6, 3)) },
                                 1, error, SceneChoice::within(params.max_distance)))
            << error;
        return built;
    };
    const BakeScenePointer near = scene(5), far = scene(20);
    ASSERT_NE(near->casters().size(), far->casters().size());
    for (const bool leaves : { false, true }) {
        const BakeScenePointer before = leaves ? near : far, after = leaves ? far : near;
        const auto whole = bake_alone(after, params);
        for (const double error : { 0.0, kSequenceError }) {
            PoseSequence sequence(error);
            bake_pose(sequence, before, params, "a");
            const auto pose = bake_pose(sequence, after, params, "b");
            EXPECT_EQ(pose->pose.base, "a") << pose->pose.why;
            EXPECT_LE(pose->report.rays * 2, whole->report.rays) << leaves << error;
            EXPECT_LE(share_beyond(*pose, *whole, error), error > 0 ? 0.01 : 0) << leaves;
            EXPECT_TRUE(error > 0 || pose->has_bytes_of(*whole));
        }
    }
}

TEST(PoseSequence, ErrorsDoNotAddUp)
{
    // Each pose is within the error of the one before; the last is far from the first.
    const VismapParams params = pose_params(128, 128);
    PoseSequence sequence(kSequenceError);
    const auto wall = [](double x) { return placed(box(V3d(-0.1, 0, -2), V3d(0.1, 2, 2), false), 1, V3d(x, 0, 0)); };
    std::unique_ptr<PoseMap> last;
    for (int i = 0; i <= 24; ++i)
        last = bake_pose(sequence, scene_of(door(0), { wall(5.5 - 0.2 * i) }), params, std::to_string(i));
    const auto whole = bake_alone(scene_of(door(0), { wall(5.5 - 0.2 * 24) }), params);
    EXPECT_LE(share_beyond(*last, *whole, kSequenceError), 0.01);
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

TEST(PoseSequence, DrawnScenesStayWithinTheError)
{
    double beyond = 0, covered = 0, kept = 0, more = 0, rays = 0, plain = 0;
    int proven = 0;
    for (uint32_t seed = 0; seed < 24; ++seed) { // all of them: the promise is of their texels together
        DrawnScene drawn(seed);
        VismapParams params = pose_params(72, 96);
        params.max_distance = drawn.params.max_distance;
        params.ground = drawn.params.ground;
        params.ground_height = drawn.params.ground_height;
        params.basis = seed % 3 ? "vector" : "sh";
        // The first occluder moves a little, or half of the mesh does.
        DrawnScene other(seed);
        const double size = 1 / SceneFrame::around(drawn.mesh).scale;
        if (!other.occluders.empty() && seed % 2)
            other.occluders[0] = placed(other.occluders[0], 1, V3d(0.1, 0.05, -0.1) * size);
        else
            for (size_t t = 0; t < other.mesh.triangles.size() / 2; ++t)
                for (const uint32_t corner : other.mesh.triangles[t])
                    other.mesh.positions[corner]
                        = drawn.mesh.positions[corner] * (seed % 4 ? 1.01 : 1.0) + V3d(0.02, 0, 0) * size;
        // Nothing else moves the frame.
        const V3d centre = SceneFrame::around(drawn.mesh).centre;
        for (Mesh* mesh : { &drawn.mesh, &other.mesh })
            for (const double far : { -1.9, 1.9 }) {
                const V3d p = centre + V3d(far) * size;
                add_quad(*mesh, p, p + V3d(1e-3, 0, 0) * size, p + V3d(1e-3, 1e-3, 0) * size,
                         p + V3d(0, 1e-3, 0) * size);
            }
        const BakeScenePointer before = scene_of(drawn.mesh, drawn.occluders),
                               after = scene_of(other.mesh, other.occluders);
        const auto whole = bake_alone(after, params);
        for (const double error : { 0.0, kSequenceError }) {
            PoseSequence sequence(error);
            bake_pose(sequence, before, params, "a");
            const auto pose = bake_pose(sequence, after, params, "b");
            const double off = share_beyond(*pose, *whole, error == 0 ? 0 : kSequenceError + 1e-6);
            if (error == 0) {
                more += off * double(pose->pose.covered);
                proven += pose->pose.kept > 0;
                continue;
            }
            beyond += off * double(pose->pose.covered);
            covered += double(pose->pose.covered);
            kept += double(pose->pose.kept);
            rays += double(pose->report.rays);
            plain += double(whole->report.rays);
        }
    }
    EXPECT_LE(beyond, 0.01 * covered);
    EXPECT_EQ(more, 0); // what is proven has the same rays
    EXPECT_GT(kept, 0.1 * covered);
    EXPECT_GT(proven, 2);
    RecordProperty("rays", std::to_string(rays / plain));
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
