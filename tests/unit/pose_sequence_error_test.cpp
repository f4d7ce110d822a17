// SPDX-License-Identifier: Apache-2.0
// Poses baked one after the other, against each baked alone: how far they are off, for how many rays.
#include "drawn_scene.h"
#include "pose_scenes.h"

#include <memory>
#include <string>

using namespace vmlight;
using namespace vmlight::scenes;

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
            ASSERT_GT(pose->pose.covered, 0) << seed; // what is beyond the error counts by it
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
