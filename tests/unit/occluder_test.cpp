// SPDX-License-Identifier: Apache-2.0
#include "scenes.h"

#include <vmlight/math/sampling.h>
#include <vmlight/trace/occluder.h>
#include <vmlight/trace/surface.h>

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <memory>
#include <random>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

const float kNoLimit = std::numeric_limits<float>::infinity();

struct TracedMeshes
{
    explicit TracedMeshes(const std::vector<Mesh>& meshes, const SceneFrame& frame = {})
    {
        std::vector<const Mesh*> casters;
        for (const Mesh& mesh : meshes)
            casters.push_back(&mesh);
        std::string error;
        EXPECT_TRUE(occluder.build(casters, frame, 1, error)) << error;
    }
    bool blocked(const V3f& origin, const V3f& direction, float length = kNoLimit, bool is_near = false) const
    {
        RayFan fan(1);
        fan.x[0] = direction.x, fan.y[0] = direction.y, fan.z[0] = direction.z;
        fan.lanes[0] = 1;
        occluder.clear_blocked(fan, origin, length, is_near);
        EXPECT_EQ(fan.lanes[0] & 0xfe, 0);
        return fan.lanes[0] == 0;
    }
    Occluder occluder;
};

} // namespace

TEST(Occluder, ARayIsBlockedByWhatItMeetsFromEitherSide)
{
    const TracedMeshes scene({ floor_facing_z(1, V3d(0, 0, 2)) });
    EXPECT_TRUE(scene.blocked(V3f(0.3f, 0.2f, 0), V3f(0, 0, 1)));
    EXPECT_TRUE(scene.blocked(V3f(0.3f, 0.2f, 4), V3f(0, 0, -1)));
    EXPECT_FALSE(scene.blocked(V3f(0.3f, 0.2f, 0), V3f(0, 0, -1)));
    EXPECT_FALSE(scene.blocked(V3f(1.3f, 0.2f, 0), V3f(0, 0, 1)));
}

TEST(Occluder, LengthLimitsARay)
{
    const TracedMeshes scene({ floor_facing_z(1, V3d(0, 0, 2)) });
    EXPECT_FALSE(scene.blocked(V3f(0), V3f(0, 0, 1), 1.999f));
    EXPECT_TRUE(scene.blocked(V3f(0), V3f(0, 0, 1), 2.001f));
}

TEST(Occluder, AllMeshesCast)
{
    const TracedMeshes scene({ floor_facing_z(1, V3d(0, 0, 2)), Mesh(), floor_facing_z(1, V3d(5, 0, 2)) });
    EXPECT_TRUE(scene.blocked(V3f(0), V3f(0, 0, 1)));
    EXPECT_TRUE(scene.blocked(V3f(5, 0, 0), V3f(0, 0, 1)));
    EXPECT_FALSE(scene.blocked(V3f(3, 0, 0), V3f(0, 0, 1)));
}

// Its triangles are not copied; those of other meshes are, and may go.
TEST(Occluder, AMeshThatLastsIsMetAsAnyOther)
{
    const Mesh ball = icosphere(2);
    auto other = std::make_unique<Mesh>(floor_facing_z(1, V3d(0, 0, 2)));
    Occluder lasting, copied;
    std::string error;
    ASSERT_TRUE(
        lasting.build({ &ball, other.get() }, {}, 1, error, CutoutMode::micromaps, {}, InstanceMode::many, &ball))
        << error;
    ASSERT_TRUE(copied.build({ &ball, other.get() }, {}, 1, error)) << error;
    other.reset();
    EXPECT_EQ(lasting.triangles()[0].triangles, ball.triangles.data());
    EXPECT_NE(copied.triangles()[0].triangles, ball.triangles.data());
    std::mt19937 random(1);
    std::uniform_real_distribution<float> place(-1.5f, 1.5f);
    for (int i = 0; i < 500; ++i) {
        std::array<V3f, kPacketSize> origins, directions;
        std::array<float, kPacketSize> lengths;
        lengths.fill(kNoLimit);
        for (int k = 0; k < kPacketSize; ++k) {
            origins[k] = V3f(place(random), place(random), 3 * place(random));
            directions[k] = V3f(place(random), place(random), place(random)).normalized();
        }
        std::array<NearestHit, kPacketSize> hits, expected;
        lasting.find_nearest(origins.data(), directions.data(), lengths.data(), kPacketSize, hits.data());
        copied.find_nearest(origins.data(), directions.data(), lengths.data(), kPacketSize, expected.data());
        for (int k = 0; k < kPacketSize; ++k) {
            ASSERT_EQ(hits[k].mesh, expected[k].mesh);
            ASSERT_EQ(hits[k].triangle, expected[k].triangle);
            ASSERT_EQ(hits[k].distance, expected[k].distance);
        }
    }
}

TEST(Occluder, NothingBlocksInAnEmptyScene)
{
    EXPECT_FALSE(TracedMeshes({}).blocked(V3f(0), V3f(0, 0, 1)));
    EXPECT_FALSE(TracedMeshes({ Mesh() }).blocked(V3f(0), V3f(0, 0, 1)));
}

TEST(Occluder, DeadLanesStayDeadAndLiveOnesAreAskedAloneOrTogether)
{
    const TracedMeshes scene({ floor_facing_z(1, V3d(0, 0, 2)) });
    std::mt19937 random(1);
    RayFan fan(40);
    for (int i = 0; i < 40; ++i) {
        const bool up = i % 3 == 0;
        fan.x[i] = 0, fan.y[i] = 0, fan.z[i] = up ? 1.0f : -1.0f;
    }
    for (int run = 0; run < 50; ++run) {
        std::vector<uint8_t> asked;
        for (uint8_t& lanes : fan.lanes) {
            lanes = uint8_t(random());
            asked.push_back(lanes);
        }
        scene.occluder.clear_blocked(fan, V3f(0), kNoLimit);
        for (int i = 0; i < 40; ++i)
            EXPECT_EQ(fan.lanes[size_t(i / 8)] >> i % 8 & 1, (asked[size_t(i / 8)] >> i % 8 & 1) && i % 3 != 0) << i;
    }
}

TEST(Occluder, NoRayLeaksThroughTheSidesAndCornersOfABall)
{
    const Mesh ball = icosphere(3);
    const TracedMeshes scene({ ball });
    const auto expect_closed = [&](const V3d& target) {
        for (const V3d& origin : { V3d(0), V3d(0.3, -0.2, 0.1) })
            ASSERT_TRUE(scene.blocked(V3f(origin), V3f((target - origin).normalized()))) << target;
    };
    for (const auto& t : ball.triangles)
        for (int k = 0; k < 3; ++k) {
            const V3d &a = ball.positions[t[k]], &b = ball.positions[t[(k + 1) % 3]];
            expect_closed(a);
            for (double along : { 0.5, 0.25, 1.0 / 3, 0.01 })
                expect_closed(a + (b - a) * along);
        }
}

TEST(Occluder, TheFrameFillsMinusOneToOneByAPowerOfTwo)
{
    for (double size : { 1e-6, 0.3, 1.0, 2.0, 777.0, 1e6 })
        for (double offset : { 0.0, 1e4 }) {
            const Mesh mesh = placed(box(V3d(-1, -0.5, -0.1), V3d(1, 0.5, 0.1), false), size, V3d(offset * size));
            const SceneFrame frame = SceneFrame::around(mesh);
            float reach = 0;
            for (const V3d& p : mesh.positions) {
                const V3f s = frame.to_scene(p);
                reach = std::max({ reach, std::abs(s.x), std::abs(s.y), std::abs(s.z) });
            }
            EXPECT_LE(reach, 1 + 1e-7f) << size;
            EXPECT_GT(reach, 0.5f - 1e-7f) << size;
            int exponent = 0;
            EXPECT_EQ(std::frexp(frame.scale, &exponent), 0.5) << size;
        }
}

TEST(Occluder, VerticesThatNoTriangleUsesDoNotStretchTheFrame)
{
    Mesh mesh = floor_facing_z(1);
    mesh.positions.push_back(V3d(1e20));
    mesh.positions.push_back(V3d(NAN));
    const SceneFrame frame = SceneFrame::around(mesh);
    EXPECT_EQ(frame.scale, 1);
    EXPECT_EQ(frame.centre, V3d(0));
}

TEST(Occluder, TheFrameOfAPointOrOfNothingIsFinite)
{
    Mesh point = floor_facing_z(0, V3d(3, 4, 5));
    EXPECT_EQ(SceneFrame::around(point).to_scene(V3d(3, 4, 5)), V3f(0));
    EXPECT_EQ(SceneFrame::around(Mesh()).scale, 1);
}

TEST(Occluder, OriginsAreOffTheSurfaceByWhatTheirNamesSay)
{
    std::mt19937 random(2);
    std::uniform_real_distribution<double> in(-1, 1);
    for (int run = 0; run < 2000; ++run) {
        Mesh mesh;
        V3d corners[3];
        for (V3d& corner : corners)
            corner = V3d(in(random), in(random), in(random)) * (run % 5 == 0 ? 1e-3 : 1);
        add_quad(mesh, corners[0], corners[1], corners[2], corners[0]);
        const SceneFrame frame;
        const SurfacePoint point = Surface(mesh, frame).at(0, 0.3f, 0.6f);
        const V3d normal(point.geometric_normal), foot(frame.to_scene(corners[0]));
        EXPECT_NEAR((V3d(point.origin) - foot).dot(normal), kRayOffset, 3e-7);
        EXPECT_NEAR((V3d(point.near_origin) - foot).dot(normal), kNearRayOffset,
                    3e-7); // a coordinate's rounding is 6e-8
    }
}

TEST(Occluder, NearASurfaceTheSideOfItIsWorkedOutInDouble)
{
    // Long slivers, whose plane is mostly rounding in float, and rays of all directions.
    std::mt19937 random(5);
    const auto any = [&random] { // a loop, since compilers differ in which argument they see to first
        std::uniform_real_distribution<double> in(-1, 1);
        V3d v;
        for (int axis = 0; axis < 3; ++axis)
            v[axis] = in(random);
        return v;
    };
    int wrong_in_float = 0;
    for (int run = 0; run < 3000; ++run) {
        Mesh mesh;
        const V3d a = any(), b = any(), side = any();
        add_quad(mesh, a, b, b + side * std::pow(10.0, -7 * std::abs(any().x)), a);
        const SceneFrame frame;
        const SurfacePoint point = Surface(mesh, frame).at(0, 0.3f, 0.6f);
        const TracedMeshes scene({ mesh }, frame);
        for (int ray = 0; ray < 8; ++ray) {
            V3f direction(any().normalized());
            if (direction.dot(point.geometric_normal) < 0)
                direction = -direction;
            EXPECT_FALSE(scene.blocked(point.near_origin, direction, kNoLimit, true)) << run;
            wrong_in_float += scene.blocked(point.near_origin, direction);
            EXPECT_FALSE(scene.blocked(point.origin, direction)) << run;
        }
    }
    EXPECT_GT(wrong_in_float, 0);
}
