// SPDX-License-Identifier: Apache-2.0
// By how much a map changes from pose to pose: the bound that is said before the bake holds for 99 of 100 texels.
#include "cases.h"
#include "pose_scenes.h"

#include <vmlight/vismap/pose_plan.h>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

PoseChange change_between(const Mesh& a, const Mesh& b, const VismapParams& params, double error = 0.01)
{
    const PosedMap base { scene_of(a), nullptr }, pose { scene_of(b), nullptr };
    const PoseMotion motion(*base.scene, *pose.scene);
    VismapBaker baker;
    PoseChange change;
    std::string reason;
    EXPECT_EQ(motion.fault(), "");
    EXPECT_TRUE(baker.prepare(pose.scene, params, reason)) << reason;
    EXPECT_TRUE(measure_change(change, { base, pose, motion, baker }, error, 0, {}));
    return change;
}

} // namespace

TEST(PoseBound, HoldsForNinetyNineOfAHundredTexels)
{
    struct Case
    {
        const char* what;
        Mesh base, pose;
    };
    const VismapParams few = pose_params(80, 128), many = pose_params(80, 1024);
    const Case all[] = { { "flag", flag(0), flag(0.15) },
                         { "door", door(0), door(25) },
                         { "skin", skin(0), skin(0.004) },
                         { "skin", skin(0), skin(0.03) } };
    for (int k = 0; k < cases(4, 1); ++k) {
        const Case& c = all[k];
        const PoseChange change = change_between(c.base, c.pose, few);
        const auto before = bake_alone(scene_of(c.base), many), after = bake_alone(scene_of(c.pose), many);
        // The truth has noise of its own, where texels turn.
        EXPECT_LE(share_beyond(*before, *after, change.bound + 0.005), 0.01) << c.what << " " << change.bound;
        EXPECT_LE(change.bound, change.most) << c.what;
        EXPECT_GT(change.probes, 60) << c.what;
        EXPECT_GT(change.rays, 0) << c.what;
    }
}

TEST(PoseBound, MinorDeformationsAreForgivableAndLargeOnesAreNot)
{
    const VismapParams params = pose_params(160, 128);
    const PoseChange still = change_between(skin(0), skin(0), params);
    EXPECT_EQ(still.bound, 0);
    EXPECT_EQ(still.most, 0);
    EXPECT_EQ(still.above, 0);
    const PoseChange minor = change_between(skin(0), skin(0.004), params);
    const PoseChange major = change_between(skin(0), skin(0.1), params);
    EXPECT_LT(minor.bound, 0.1);
    EXPECT_GT(minor.bound, 0);
    EXPECT_GT(major.bound, 2 * minor.bound);
    EXPECT_GT(major.above, minor.above);
}

TEST(PoseBound, ATurnedMeshDoesNotChange)
{
    const PoseChange change
        = change_between(skin(0), moved(skin(0), rotation_from_angles(10, 70, 5), V3d(1, 2, 3)), pose_params(96, 128));
    // Rays that graze an edge may round to its other side.
    EXPECT_LT(change.bound, 0.02);
    EXPECT_LT(change.above, 0.02);
}

// The base alone is traced until the error is what was asked for.
TEST(PoseBound, APoseSaysHowManyRaysItHasAndNoErrorThatWasAskedFor)
{
    VismapParams params = pose_params(96, 128);
    params.target_error = 0.03;
    PoseSequence sequence(0.02);
    const auto base = bake_pose(sequence, scene_of(door(0)), params, "a");
    const auto pose = bake_pose(sequence, scene_of(door(20)), params, "b");
    EXPECT_EQ(pose->pose.base, "a");
    EXPECT_GT(pose->pose.kept, 0);
    EXPECT_FLOAT_EQ(base->image.spec().get_float_attribute("vmlight:target_error"), 0.03f);
    EXPECT_EQ(pose->image.spec().get_float_attribute("vmlight:target_error"), 0);
    EXPECT_EQ(pose->image.spec().get_int_attribute("vmlight:samples"), base->report.samples);
}
