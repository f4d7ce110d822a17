// SPDX-License-Identifier: Apache-2.0
// The error that a bake says it has, against the one it has. Errors that are asked for: vismap_target_test.cpp.
#include "cases.h"
#include "error_scenes.h"

#include <vmlight/vismap/pilot.h>
#include <vmlight/vismap/visibility_integrator.h>

#include <algorithm>
#include <array>
#include <utility>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

BakeInput low_wall()
{
    return { floor_facing_z(1), { rectangle(V3d(-0.3, -5, 0), V3d(1, 10, 0), V3d(0, 0, 0.5)) } };
}

BakeInput disc_overhead()
{
    return { floor_facing_z(1), { disc(V3d(0.1, 0, 0.5), 0.6, 200) } };
}

BakeInput boxes_in_a_row()
{
    BakeInput scene { floor_facing_z(1), {} };
    for (double x : { -0.7, 0.0, 0.7 })
        scene.occluders.push_back(box(V3d(x - 0.2, -0.8, 0), V3d(x + 0.2, 0.7, 0.6), false));
    return scene;
}

BakeInput pit()
{
    return { floor_facing_z(0.6), { tube(1, 1.2, 100) } };
}

BakeInput gazebo()
{
    return { test_mesh("gazebo.obj"), {} };
}

void expect_honest(const BakeInput& scene)
{
    constexpr std::pair<int, int> kSizes[] = { { 16, 100 }, { 64, 64 }, { 256, 40 } };
    for (int k = 0; k < cases(3, 1); ++k) {
        const auto [samples, side] = kSizes[k];
        const BakedMap reference = reference_of(scene, side, samples);
        for (const char* sampler : { "fibonacci", "sobol", "halton" }) {
            SCOPED_TRACE(testing::Message() << sampler << ", " << samples << " rays");
            const BakedMap map(scene.mesh, scene.occluders, error_params(side, samples, sampler));
            const double truth = true_rms(map, reference);
            EXPECT_GT(truth, 0);
            EXPECT_NEAR(map.report.error / truth, 1, kHonest);
            EXPECT_NEAR(channel_rms(map) / truth, 1, kHonest);
        }
    }
}

} // namespace

TEST(VismapError, IsHonestUnderABall)
{
    expect_honest(ball_over_floor());
}

TEST(VismapError, IsHonestByALowWall)
{
    expect_honest(low_wall());
}

TEST(VismapError, IsHonestUnderADisc)
{
    expect_honest(disc_overhead());
}

TEST(VismapError, IsHonestBetweenBoxes)
{
    expect_honest(boxes_in_a_row());
}

TEST(VismapError, IsHonestInAPit)
{
    expect_honest(pit());
}

TEST(VismapError, IsHonestOnACow)
{
    expect_honest(spot());
}

TEST(VismapError, IsHonestOnABuilding)
{
    expect_honest(gazebo());
}

TEST(VismapError, IsHonestOnACowOnTheGround)
{
    expect_honest(spot_on_the_ground());
}

TEST(VismapError, OfAFewRaysIsHonestToo)
{
    const BakeInput scene = ball_over_floor();
    const BakedMap reference = reference_of(scene, 64, 32);
    for (int samples : { 2, 5, 8, 9, 15 }) {
        const BakedMap map(scene.mesh, scene.occluders, error_params(64, samples));
        const double truth = true_rms(map, reference);
        EXPECT_NEAR(map.report.error / truth, 1, kHonest) << samples;
        EXPECT_NEAR(channel_rms(map) / truth, 1, kHonest) << samples;
    }
}

TEST(VismapError, OfUniformDirectionsIsHonestToo)
{
    const BakeInput scene = boxes_in_a_row();
    VismapParams params = map_params(64, 64, 64 * 32);
    params.measure = "uniform";
    params.seed = 9;
    const BakedMap reference(scene.mesh, scene.occluders, params);
    params = error_params(64, 32);
    params.measure = "uniform";
    const BakedMap map(scene.mesh, scene.occluders, params);
    EXPECT_NEAR(map.report.error / true_rms(map, reference), 1, kHonest);
}

TEST(VismapError, OneRayDoesNotScatter)
{
    OIIO::ImageBuf image;
    EXPECT_FALSE(make_vismap(image, floor_facing_z(1), {}, error_params(8, 1)));
    EXPECT_EQ(image.geterror(), "samples: 1 is too few for the channel error, which needs 2");
}

TEST(VismapError, OfATexelIsItsRaysScatter)
{
    const std::vector<uint8_t> all { 0xff, 0xff };
    // Lanes 0 to 3 see by both rays, the others by none: V = 1/2, each lane is 1 of 2 off.
    EXPECT_DOUBLE_EQ(lane_scatter(all, { 0x0f, 0x0f }), std::sqrt(8 * 8 / 7.0) / 16);
    // Each lane sees by one of two.
    EXPECT_EQ(lane_scatter(all, { 0x0f, 0xf0 }), 0);
    EXPECT_EQ(lane_scatter(all, all), 0);
    EXPECT_EQ(lane_scatter(all, { 0, 0 }), 0);
    // Dead lanes say nothing: two rays, of which one sees.
    EXPECT_DOUBLE_EQ(lane_scatter({ 0x03 }, { 0x01 }), std::sqrt(0.5 * 2) / 2);
    EXPECT_EQ(lane_scatter({ 0x01 }, { 0x01 }), 0);
    EXPECT_EQ(lane_scatter({ 0 }, { 0 }), 0);
}

TEST(VismapError, OfIndependentRaysIsThatOfAShare)
{
    EXPECT_DOUBLE_EQ(independent_error(4, 16), std::sqrt(0.25 * 0.75 / 16));
    EXPECT_DOUBLE_EQ(independent_error(12, 16), independent_error(4, 16));
    for (const auto& [open, traced] : { std::pair(0, 16), { 16, 16 }, { 1, 1 }, { 0, 1 }, { 0, 0 } })
        EXPECT_EQ(independent_error(open, traced), 0) << open << " of " << traced;
}

TEST(VismapError, OfAPatternIsThatOfIndependentRaysWhereFewAreBlockedAndNoMoreThanTheLargest)
{
    EXPECT_EQ(pattern_variance(0, 0.1), 0);
    EXPECT_EQ(pattern_variance(0.1, 0), 0);
    EXPECT_NEAR(pattern_variance(1e-6, 0.1), 1e-6, 1e-9);
    EXPECT_NEAR(pattern_variance(1, 0.1), 0.01, 1e-4);
    EXPECT_DOUBLE_EQ(pattern_variance(0.01, 0.1), 0.005) << "half of either";
}

TEST(VismapError, OfAPatternIsTheUsualOneWhereFewTexelsTellIt)
{
    PilotError measured;
    measured.samples = 64;
    measured.pattern = 0.05;
    const double usual = pattern_error(measured, 0);
    EXPECT_NEAR(usual * 64, 1.1, 1e-12) << "rays";
    EXPECT_NEAR(pattern_error(measured, 1 << 20), 0.05, 1e-5);
    EXPECT_GT(pattern_error(measured, 16), usual);
    EXPECT_LT(pattern_error(measured, 16), 0.05);
}

// Measured: 0.5 on the cow, 0.4 on the building.
TEST(VismapError, OfTexelsTellsWhereItIsLarge)
{
    for (const BakeInput& scene : { spot(), gazebo() }) {
        const BakedMap reference = reference_of(scene, 64, 64);
        const BakedMap map(scene.mesh, scene.occluders, error_params(64, 64));
        std::vector<std::pair<double, double>> said_and_true;
        rms(map, [&](const float* texel, int x, int y) {
            said_and_true.emplace_back(texel[4], std::pow(texel[0] - reference.at(x, y).visibility, 2));
            return 0;
        });
        std::sort(said_and_true.begin(), said_and_true.end());
        std::array<double, 2> half {};
        for (size_t i = 0; i < said_and_true.size(); ++i)
            half[2 * i / said_and_true.size()] += said_and_true[i].second;
        EXPECT_LT(std::sqrt(half[0] / half[1]), 0.67);
    }
}

TEST(VismapError, IsZeroWhereAllRaysAgreeAndLargeAtAnEdge)
{
    const BakeInput scene { floor_facing_z(1), { rectangle(V3d(0.5, -1e4, 0.1), V3d(1e4, 0, 0), V3d(0, 2e4, 0)) } };
    const BakedMap map(scene.mesh, scene.occluders, error_params(64, 64));
    float open[6], edge[6];
    map.image().getpixel(0, 32, 0, open, 6);
    map.image().getpixel(47, 32, 0, edge, 6);
    EXPECT_LT(open[4], map.report.error);
    EXPECT_GT(edge[4], map.report.error / 2);
    const BakedMap bare(scene.mesh, {}, error_params(16, 16));
    EXPECT_EQ(channel_rms(bare), 0);
}

TEST(VismapError, OfTheMarginIsFilledLikeV)
{
    BakeInput scene = ball_over_floor();
    for (V2f& uv : scene.mesh.uvs)
        uv = V2f(0.25f, 0.25f) + uv * 0.5f;
    VismapParams params = error_params(32, 16);
    params.margin = 2;
    const BakedMap map(scene.mesh, scene.occluders, params);
    EXPECT_EQ(
        map.spec().channelnames,
        (std::vector<std::string> { "visibility", "direction.x", "direction.y", "direction.z", "error", "coverage" }));
    EXPECT_EQ(map.spec().get_string_attribute("vmlight:channels"), "coverage,error");
    float margin[6], outside[6];
    map.image().getpixel(7, 16, 0, margin, 6);
    map.image().getpixel(5, 16, 0, outside, 6);
    EXPECT_EQ(margin[5], 0);
    EXPECT_GT(margin[4], 0);
    EXPECT_EQ(outside[4], 0);
}

TEST(VismapError, NothingPaysForItUnasked)
{
    const BakedMap map(floor_facing_z(1), {}, map_params(8, 8, 4));
    EXPECT_EQ(map.report.error_texels, 0);
    EXPECT_EQ(map.spec().find_attribute("vmlight:error"), nullptr);
    EXPECT_EQ(map.spec().get_string_attribute("vmlight:target_error"), "none");
    EXPECT_EQ(map.report.samples, 4);
}

TEST(VismapError, OfAnEmptyMapIsNone)
{
    Mesh mesh = floor_facing_z(1);
    for (V2f& uv : mesh.uvs)
        uv.x += 1;
    VismapParams params = error_params(16, 4);
    params.target_error = 0.01;
    const BakedMap map(mesh, {}, params);
    EXPECT_EQ(map.report.covered, 0);
    EXPECT_EQ(map.report.error_texels, 0);
    EXPECT_EQ(map.report.samples, 2);
}

TEST(VismapError, MeasuringItIsInterruptedLikeABake)
{
    const BakeInput scene = ball_over_floor();
    int calls = 0;
    OIIO::ImageBuf image;
    EXPECT_FALSE(make_vismap(image, scene.mesh, scene.occluders, error_params(64, 512), nullptr, 2, [&](double done) {
        EXPECT_EQ(done, 0);
        return ++calls < 3;
    }));
    EXPECT_EQ(image.geterror(), "interrupted");
    EXPECT_EQ(calls, 3);
}
