// SPDX-License-Identifier: Apache-2.0
// Bakes for an error or a time that was asked for.
#include "error_scenes.h"

#include <vmlight/vismap/baker.h>

#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <memory>

using namespace vmlight;
using namespace vmlight::scenes;

TEST(VismapError, AnErrorThatIsAskedForIsReachedWithAsFewRaysAsItTakes)
{
    const BakeInput scene = ball_over_floor();
    for (double target : { 0.1, 0.03, 0.006 }) {
        SCOPED_TRACE(target);
        VismapParams params = map_params(64, 64, 7);
        params.target_error = target;
        const BakedMap map(scene.mesh, scene.occluders, params);
        EXPECT_LE(map.report.error, target);
        EXPECT_EQ(map.report.error_texels, 4096);
        EXPECT_EQ(map.spec().get_string_attribute("vmlight:samples"), std::to_string(map.report.samples));
        EXPECT_EQ(map.spec().get_float_attribute("vmlight:error"), float(map.report.error));
        // The same as if the samples had been asked for.
        params = error_params(64, map.report.samples);
        const BakedMap same(scene.mesh, scene.occluders, params);
        EXPECT_TRUE(map == same);
        EXPECT_EQ(same.report.error, map.report.error);
        EXPECT_LT(true_rms(same, reference_of(scene, 64, std::min(64, map.report.samples))), (1 + kHonest) * target);
        // A third less is too few. (A few per cent less may do: some counts are better than their neighbours.)
        params.samples = params.samples * 2 / 3;
        EXPECT_GT(BakedMap(scene.mesh, scene.occluders, params).report.error, target);
    }
}

TEST(VismapError, WhereNothingScattersTheLeastCountIsChosen)
{
    VismapParams params = map_params(64, 64, 100);
    params.target_error = 0.01;
    const BakedMap map(box(V3d(-1), V3d(1), false), {}, params);
    EXPECT_EQ(map.report.samples, 1);
    EXPECT_EQ(map.report.error, 0);
    EXPECT_EQ(map.spec().get_float_attribute("vmlight:error", -1), 0);
    params.channels.push_back("error");
    const BakedMap scatter(box(V3d(-1), V3d(1), false), {}, params);
    EXPECT_EQ(scatter.report.samples, 2);
    EXPECT_EQ(channel_rms(scatter), 0);
}

TEST(VismapError, FewTexelsThatDoNotScatterTake64Rays)
{
    for (int side : { 8, 15, 16 }) {
        VismapParams params = map_params(side, side, 100);
        params.target_error = 0.01;
        const BakedMap map(floor_facing_z(1), {}, params);
        EXPECT_EQ(map.report.error, 0);
        EXPECT_EQ(map.report.samples, side < 16 ? 64 : 1) << map.report.error_texels;
    }
}

TEST(VismapError, AZeroOfFewRaysIsChanceWhereManyScatter)
{
    // A speck that one ray in ten thousand meets: a few rays a texel pass it by everywhere, both times.
    const BakeInput scene { floor_facing_z(1),
                            { rectangle(V3d(-0.015, -0.015, 2), V3d(0.03, 0, 0), V3d(0, 0.03, 0)) } };
    VismapParams params = error_params(16, 7);
    params.target_error = 0.005;
    const BakedMap map(scene.mesh, scene.occluders, params);
    EXPECT_GT(map.report.error, 0);
    EXPECT_LE(map.report.error, 0.005);
    EXPECT_LE(true_rms(map, reference_of(scene, 16, 256)), 0.005);
    EXPECT_EQ(BakedMap(scene.mesh, scene.occluders, error_params(16, 3)).report.error, 0);
}

TEST(VismapError, AnErrorOutOfReachIsRefusedWithWhatIsReached)
{
    const BakeInput scene = ball_over_floor();
    VismapParams params = map_params(8, 8, 1);
    params.target_error = 1e-9;
    OIIO::ImageBuf image;
    EXPECT_FALSE(make_vismap(image, scene.mesh, scene.occluders, params));
    const std::string error = image.geterror();
    EXPECT_EQ(error.find("target_error: 1e-09 is out of reach: 1048576 rays per texel give "), 0u) << error;
    params.target_error = -0.1;
    EXPECT_FALSE(make_vismap(image, scene.mesh, scene.occluders, params));
    EXPECT_EQ(image.geterror(), "target_error: -0.1 is not in [1e-09, 1] or \"none\"");
}

TEST(VismapError, AndTheRaysChosenAreTheSameForAnyNumberOfThreads)
{
    const BakeInput scene = spot_on_the_ground();
    VismapParams params = error_params(100, 1);
    params.target_error = 0.04;
    const BakedMap one(scene.mesh, scene.occluders, params, 1);
    EXPECT_GT(one.report.covered, 4096);
    EXPECT_EQ(one.report.error_texels, 4096);
    for (int threads : { 2, 5 }) {
        const BakedMap other(scene.mesh, scene.occluders, params, threads);
        EXPECT_EQ(one.spec().to_xml(), other.spec().to_xml());
        EXPECT_TRUE(one == other);
        EXPECT_EQ(one.report.error, other.report.error);
        EXPECT_EQ(rms(one, [&](const float* t, int x, int y) { return t[4] - other.image().getchannel(x, y, 0, 4); }),
                  0);
    }
    // Another seed, another estimate.
    params.seed = 1;
    EXPECT_NE(BakedMap(scene.mesh, scene.occluders, params).report.error, one.report.error);
}

TEST(VismapError, ATimeIsTurnedIntoRaysAndTheirErrorIsTold)
{
    const BakeInput parts = ball_over_floor();
    auto scene = std::make_shared<BakeScene>();
    std::string error;
    ASSERT_TRUE(scene->build(non_owning(parts.mesh), parts.occluders, 0, error)) << error;
    VismapReport report;
    OIIO::ImageBuf timed, plain;
    const VismapParams params = map_params(32, 32, 77);
    ASSERT_TRUE(make_vismap(timed, scene, params, &report, 0, {}, 0.05)) << timed.geterror();
    EXPECT_GT(report.samples, 1);
    EXPECT_LE(report.expected_seconds, 0.05);
    EXPECT_GT(report.error, 0);
    EXPECT_EQ(timed.spec().get_string_attribute("vmlight:samples"), std::to_string(report.samples));
    EXPECT_EQ(timed.spec().get_float_attribute("vmlight:error"), float(report.error));
    ASSERT_TRUE(make_vismap(plain, parts.mesh, parts.occluders, map_params(32, 32, report.samples)));
    for (int i = 0; i < 32 * 32; ++i)
        ASSERT_EQ(timed.getchannel(i % 32, i / 32, 0, 0), plain.getchannel(i % 32, i / 32, 0, 0));
    for (const char* basis : { "sh", "mask", "cells" }) {
        VismapParams with_basis = params;
        with_basis.basis = basis;
        ASSERT_TRUE(make_vismap(timed, scene, with_basis, &report, 0, {}, 0.05)) << timed.geterror();
        with_basis.samples = report.samples;
        ASSERT_TRUE(make_vismap(plain, parts.mesh, parts.occluders, with_basis));
        EXPECT_EQ(OIIO::ImageBufAlgo::compare(timed, plain, 0, 0).nfail, 0) << basis;
    }
    ASSERT_TRUE(make_vismap(timed, scene, params, &report, 0, {}, 1e-12)) << timed.geterror();
    EXPECT_EQ(report.samples, 1);
    EXPECT_GT(report.expected_seconds, 1e-12);
}
