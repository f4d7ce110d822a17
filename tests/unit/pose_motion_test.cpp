// SPDX-License-Identifier: Apache-2.0
// What of a scene moves together from one pose to another.
#include "cutout_scene.h"
#include "pose_scenes.h"

#include <vmlight/mesh/same_triangles.h>
#include <vmlight/trace/moved_boxes.h>
#include <vmlight/trace/pose_motion.h>
#include <vmlight/vismap/pose_proof.h>

#include <gmock/gmock.h>

using namespace vmlight;
using namespace vmlight::scenes;
using testing::HasSubstr;

namespace {

double distance(const Rotation& a, const Rotation& b)
{
    double most = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            most = std::max(most, std::abs(a[i][j] - b[i][j]));
    return most;
}

} // namespace

TEST(PoseMotion, AMovedMeshIsOneBody)
{
    for (const double scale : { 1e-4, 1.0, 1e5 })
        for (const V3d& shift : { V3d(0), V3d(3, -2, 1), V3d(-300, 20, 50) }) {
            const Rotation turn = rotation_from_angles(20, 50, -110);
            const Mesh mesh = placed(skin(0), scale);
            const BakeScenePointer base = scene_of(mesh), pose = scene_of(moved(mesh, turn, shift * scale));
            const PoseMotion motion(*base, *pose);
            ASSERT_EQ(motion.fault(), "");
            EXPECT_TRUE(motion.is_whole()) << scale << " " << shift.x << " " << motion.soft();
            EXPECT_LT(distance(motion.turn(5), turn), shift.length() > 100 ? 1e-5 : 1e-7);
        }
}

TEST(PoseMotion, WhatStandsStillIsABodyThatTurnsByNothing)
{
    const BakeScenePointer base = scene_of(door(0)), pose = scene_of(door(35));
    const PoseMotion motion(*base, *pose);
    ASSERT_EQ(motion.motions().size(), 2u); // and the door
    EXPECT_EQ(motion.soft(), 0);
    EXPECT_TRUE(is_straight(motion.turn(0)));
    const auto last = uint32_t(base->mesh().triangles.size() - 1);
    EXPECT_EQ(motion.body(0), 0u);
    EXPECT_EQ(motion.body(last), 1u);
    EXPECT_LT(distance(motion.turn(last), rotation_from_angles(0, -35, 0)), 1e-6);
    // What rays can meet is the same mesh again.
    EXPECT_EQ(motion.body_of_traced(last), 1u);
}

TEST(PoseMotion, AShiftTurnsByNothing)
{
    Mesh mesh = door(0), other = mesh;
    for (size_t i = mesh.positions.size() - 12; i < mesh.positions.size(); ++i)
        other.positions[i] += V3d(0.25, 0, -0.125);
    const BakeScenePointer base = scene_of(mesh), pose = scene_of(other);
    const PoseMotion motion(*base, *pose);
    ASSERT_EQ(motion.motions().size(), 2u);
    EXPECT_TRUE(is_straight(motion.motions()[1].turn));
}

TEST(PoseMotion, ClothIsNoBodyAndItsTrianglesTurnEachOnItsOwn)
{
    const BakeScenePointer base = scene_of(flag(0)), pose = scene_of(flag(0.3));
    const PoseMotion motion(*base, *pose);
    EXPECT_GT(motion.soft(), 1000);
    const auto& triangles = base->mesh().triangles;
    for (uint32_t t = 0; t < triangles.size(); ++t) {
        const V3d before = surface_normal(base->mesh(), triangles[t]);
        const V3d after = surface_normal(pose->mesh(), pose->mesh().triangles[t]);
        EXPECT_LT((rotate(motion.turn(t), before) - after).length(), 1e-5) << t;
    }
}

TEST(PoseMotion, OccludersAreBodiesToo)
{
    const Mesh mesh = door(0);
    const auto ball = [](double x) { return placed(icosphere(1), 0.5, V3d(x, 2, 0)); };
    const BakeScenePointer base = scene_of(mesh, { ball(0) }), pose = scene_of(mesh, { ball(1) });
    const PoseMotion motion(*base, *pose);
    EXPECT_FALSE(motion.is_whole());
    EXPECT_EQ(motion.motions().size(), 2u);
    EXPECT_EQ(motion.body_of_traced(mesh.triangles.size() + 3), 1u);
    EXPECT_EQ(motion.body(uint32_t(mesh.triangles.size() - 1)), 0u);
    const BakeScenePointer none = scene_of(mesh);
    EXPECT_THAT(PoseMotion(*base, *none).fault(), HasSubstr("0 occluders are given, and 1 in the other pose"));
}

TEST(PoseMotion, AnOccluderMayBeOutOfReachInOnePose)
{
    const Mesh mesh = placed(icosphere(1), 1);
    const auto ball = [](double x) { return placed(icosphere(1), 0.5, V3d(x, 0, 0)); };
    const auto scene = [&](double x) {
        const auto built = std::make_shared<BakeScene>();
        std::string error;
        EXPECT_TRUE(
            built->build(std::make_shared<const Mesh>(mesh), { ball(x), ball(-2) }, 1, error, SceneChoice::within(3)))
            << error;
        return built;
    };
    const auto near = scene(2), far = scene(20);
    ASSERT_EQ(far->casters().size(), 2u);
    const size_t first = mesh.triangles.size();
    for (const bool leaves : { false, true }) {
        const PoseMotion motion(leaves ? *near : *far, leaves ? *far : *near);
        ASSERT_EQ(motion.fault(), "");
        EXPECT_FALSE(motion.is_whole());
        EXPECT_EQ(motion.body_of_traced(0), 0u);
        EXPECT_EQ(motion.body_of_traced(first), PoseMotion::kAway);
        EXPECT_EQ(motion.body_of_traced(2 * first), 0u); // the other occluder
        EXPECT_EQ(motion.soft(), 0);
    }
}

TEST(PoseMotion, OtherCutOutsAreAnotherMesh)
{
    const auto card = [](float low, const V2f& shift) {
        Mesh mesh;
        add_quad(mesh, V3d(0, 2, 0), V3d(1, 2, 0), V3d(1, 3, 0), V3d(0, 3, 0), V2f(0, 0), V2f(1, 1));
        for (V2f& uv : mesh.uvs)
            uv += shift;
        const auto alpha = cutout_scene::texture(
            4, 4, [low](int x, int y) { return (x + y) % 2 ? low : 1.0f; }, TextureWrap::periodic,
            TextureWrap::periodic);
        return scene_of(door(0),
                        { cutout_scene::with_material(mesh, cutout_scene::material(AlphaMode::blend, alpha)) });
    };
    const BakeScenePointer base = card(0, V2f(0));
    EXPECT_EQ(PoseMotion(*base, *card(0, V2f(0))).fault(), "");
    for (const BakeScenePointer& other : { card(0.5f, V2f(0)), card(0, V2f(0.25f)) })
        EXPECT_EQ(PoseMotion(*base, *other).fault(), "other parts of occluder 1 are cut out");
}

TEST(PoseMotion, AWidePlaneThatRisesDoesNotMoveWithTheRest)
{
    const auto water = [](double height, double slope) {
        Mesh mesh;
        add_quad(mesh, V3d(-5e3, height - slope * 5e3, 5e3), V3d(5e3, height + slope * 5e3, 5e3),
                 V3d(5e3, height + slope * 5e3, -5e3), V3d(-5e3, height - slope * 5e3, -5e3), V2f(0, 0), V2f(1, 1));
        return mesh;
    };
    const Mesh mesh = placed(icosphere(1), 1);
    for (const double slope : { 0.0, 1.0 })
        for (const double degrees : { 0.0, 10.0 })
            for (const V3d& shift : { V3d(0), V3d(3, 0, 0) }) {
                const Rotation turn = rotation_from_angles(0, degrees, 0);
                const auto bodies = [&](double rise) {
                    const BakeScenePointer base = scene_of(mesh, { water(-0.5, slope) });
                    const BakeScenePointer pose
                        = scene_of(moved(mesh, turn, shift), { moved(water(-0.5 + rise, slope), turn, shift) });
                    const PoseMotion motion(*base, *pose);
                    EXPECT_EQ(motion.fault(), "");
                    return std::pair(motion.body_of_traced(0), motion.body_of_traced(mesh.triangles.size()));
                };
                const auto [ball, risen] = bodies(0.001);
                EXPECT_EQ(ball, 0u);
                EXPECT_NE(risen, 0u) << slope << " " << degrees << " " << shift.x;
                // Turned on a slope, its corners round to as much.
                EXPECT_TRUE(bodies(0).second == 0 || (slope > 0 && degrees > 0))
                    << slope << " " << degrees << " " << shift.x;
            }
}

TEST(PoseMotion, AFacetThatMovedALittleIsNotStill)
{
    Mesh mesh = door(0), other = mesh;
    const uint32_t corner = mesh.triangles[20][0];
    other.positions[corner].y += 1e-6;
    const BakeScenePointer base = scene_of(mesh), pose = scene_of(other);
    const std::vector<uint8_t> still = find_still(PoseMotion(*base, *pose), VismapParams());
    EXPECT_EQ(still[20], 0);
    EXPECT_EQ(still.back(), 1);
}

TEST(PoseMotion, WhatIsTracedElsewhereIsNotStill)
{
    // By less than rays tell apart, but a ray may tell.
    Mesh mesh = door(0), other = mesh;
    other.positions[other.triangles[20][0]].y += 1e-6;
    const BakeScenePointer base = scene_of(mesh), pose = scene_of(other);
    const PoseMotion motion(*base, *pose);
    EXPECT_TRUE(motion.stands_still());
    EXPECT_NE(motion.body_of_traced(20), 0u);
    EXPECT_EQ(motion.body_of_traced(mesh.triangles.size() - 1), 0u);
    EXPECT_FALSE(MovedBoxes(motion).empty());
}

TEST(PoseMotion, NormalsThatDifferAreNotProvenToStandStill)
{
    Mesh mesh = door(0), other = mesh;
    const uint32_t corner = mesh.triangles[20][0];
    other.normals[corner] = (other.normals[corner] + V3f(1e-4f, 0, 0)).normalized();
    const BakeScenePointer base = scene_of(mesh), pose = scene_of(other);
    const std::vector<uint8_t> same = prove_same_view(PoseMotion(*base, *pose), VismapParams(), true, 1);
    EXPECT_EQ(same[20], 0);
    EXPECT_EQ(same.back(), 1);
    // Files round the normals of what turns.
    const Rotation turn = rotation_from_angles(20, 50, -110);
    const BakeScenePointer turned = scene_of(moved(other, turn, V3d(0)));
    EXPECT_EQ(prove_same_view(PoseMotion(*base, *turned), VismapParams(), true, 1)[20], 1);
}

TEST(PoseMotion, OtherTrianglesOrTextureCoordinatesAreNoPose)
{
    const Mesh mesh = door(0);
    EXPECT_EQ(triangles_fault(mesh, door(40)), "");
    Mesh fewer = mesh;
    fewer.triangles.pop_back();
    EXPECT_EQ(triangles_fault(mesh, fewer),
              "\"door\" has 375 triangles, and \"door\" has 376: poses have the same triangles");
    Mesh other = mesh;
    other.uvs[mesh.triangles[7][1]].x = 0.5f;
    EXPECT_THAT(triangles_fault(mesh, other), HasSubstr(" of \"door\" has the texture coordinates (0.5, "));
    // Vertices in another order are the same mesh; so are those without texture coordinates.
    Mesh shuffled = mesh;
    std::swap(shuffled.positions[0], shuffled.positions[1]);
    std::swap(shuffled.normals[0], shuffled.normals[1]);
    std::swap(shuffled.uvs[0], shuffled.uvs[1]);
    for (auto& triangle : shuffled.triangles)
        for (uint32_t& corner : triangle)
            corner = corner == 0 ? 1 : corner == 1 ? 0 : corner;
    EXPECT_EQ(triangles_fault(mesh, shuffled), "");
    Mesh half = mesh, also = mesh;
    half.uvs[mesh.triangles[0][0]] = also.uvs[mesh.triangles[0][0]] = V2f(NAN);
    EXPECT_EQ(triangles_fault(half, also), "");
    EXPECT_NE(triangles_fault(half, mesh), "");
}
