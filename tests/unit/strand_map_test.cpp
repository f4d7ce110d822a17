// SPDX-License-Identifier: Apache-2.0
#include "scenes.h"
#include "strand_bake.h"

#include <vmlight/image/channels.h>
#include <vmlight/math/harmonics.h>
#include <vmlight/math/latlong.h>
#include <vmlight/vismap/strand_map.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

using namespace vmlight;
using namespace vmlight::strand_files;
using strand_bake::rays;
using strand_bake::strand_map;

namespace {

/// V and B of a texel.
struct Seen
{
    double v;
    V3d b;
};
Seen seen(const OIIO::ImageBuf& map, int x, int y = 0)
{
    const auto at = [&](int channel) { return double(map.getchannel(x, y, 0, channel)); };
    return { at(0), V3d(at(1), at(2), at(3)) };
}

void expect_near(const Seen& texel, double v, const V3d& b, double tolerance)
{
    EXPECT_NEAR(texel.v, v, tolerance);
    EXPECT_LT((texel.b - b).length(), tolerance) << texel.b << " for " << b;
}

const Strands kAlongX = straight({ { V3d(-1, 0, 0), V3d(1, 0, 0) } }, .01);

/// A floor that is as good as infinite, `depth` below the origin.
Mesh floor_below(double depth)
{
    constexpr double kFar = 1e6;
    return scenes::quad(V3d(-kFar, -depth, kFar), V3d(kFar, -depth, kFar), V3d(kFar, -depth, -kFar),
                        V3d(-kFar, -depth, -kFar));
}

/// Walls at x = +-half from y = low to y = high, endless along z.
std::vector<Mesh> slot(double half, double low, double high)
{
    constexpr double kFar = 1e3;
    std::vector<Mesh> walls;
    for (const double x : { -half, half })
        walls.push_back(scenes::quad(V3d(x, low, -kFar), V3d(x, high, -kFar), V3d(x, high, kFar), V3d(x, low, kFar)));
    return walls;
}

} // namespace

TEST(StrandPattern, AnglesInvertTheShareOfTheSineSquared)
{
    for (const double u : { 0.0, 1e-9, 1e-4, .1, .25, .5, .7, .999, 1.0 }) {
        const double theta = strand_angle(u);
        EXPECT_NEAR((theta - std::sin(theta) * std::cos(theta)) / latlong::pi, u, 1e-9) << u;
    }
}

TEST(StrandPattern, DirectionsHaveTheMomentsOfTheSine)
{
    const Imath::V3f tangent = Imath::V3f(1, 2, -2) / 3.0f;
    for (const char* sampler : { "fibonacci", "sobol", "halton" }) {
        const StrandPattern pattern(sampler, 4096);
        RayFan fan(4096);
        pattern.directions(fan, tangent, texel_hash(3, 5, 7));
        V3d mean(0);
        double along = 0;
        for (int i = 0; i < 4096; ++i) {
            const V3d w(fan.x[i], fan.y[i], fan.z[i]);
            EXPECT_NEAR(w.length(), 1, 1e-6);
            mean += w / 4096;
            along += std::pow(w.dot(V3d(tangent)), 2) / 4096;
        }
        EXPECT_LT(mean.length(), .002) << sampler;
        EXPECT_NEAR(along, .25, .002) << sampler; // (2 / pi) Int cos^2 sin^2
        EXPECT_EQ(sum_directions(fan, tangent).rays, 4096);
    }
}

TEST(StrandMap, AnOpenStraightStrandSeesAll)
{
    for (const int samples : { 1, 7, 64 }) {
        const OIIO::ImageBuf map = strand_map(kAlongX, {}, rays(samples));
        for (int x = 0; x < 8; ++x) {
            EXPECT_EQ(seen(map, x).v, 1);
            EXPECT_EQ(seen(map, x).b, V3d(0));
            EXPECT_EQ(map.getchannel(x, 0, 0, 4), 1) << "tangent";
        }
    }
}

TEST(StrandMap, AClosedBoxShowsNothing)
{
    const Mesh box = scenes::sphere(V3d(0), 3, 8);
    const OIIO::ImageBuf map = strand_map(kAlongX, { box }, rays(64));
    for (int x = 0; x < 8; ++x) {
        EXPECT_EQ(seen(map, x).v, 0);
        EXPECT_EQ(seen(map, x).b, V3d(0));
    }
}

TEST(StrandMap, AFloorHidesHalfWhateverTheTangent)
{
    // Level: B = 8 / (3 pi^2). Upright: 2 / (3 pi).
    expect_near(seen(strand_map(kAlongX, { floor_below(.5) }, rays(4096)), 3), .5,
                V3d(0, 8 / (3 * latlong::pi * latlong::pi), 0), .003);
    const Strands upright = straight({ { V3d(0), V3d(0, 1, 0) } }, .01);
    expect_near(seen(strand_map(upright, { floor_below(.5) }, rays(4096)), 3), .5, V3d(0, 2 / (3 * latlong::pi), 0),
                .003);
    const Strands oblique = straight({ { V3d(0), V3d(1, 1, 0) } }, .01);
    EXPECT_NEAR(seen(strand_map(oblique, { floor_below(.5) }, rays(4096)), 3).v, .5, .003);
}

TEST(StrandMap, BetweenTwoWallsTheOpenAngleCounts)
{
    const Strands along_z = straight({ { V3d(0, 0, -1), V3d(0, 0, 1) } }, .01);
    const double alpha = std::atan2(1.0, 2.0); // from the axis to the upper edge of a wall
    expect_near(seen(strand_map(along_z, slot(1, -2, 2), rays(4096)), 4), 2 * alpha / latlong::pi, V3d(0), .004);
    std::vector<Mesh> trench = slot(1, -2, 2);
    trench.push_back(floor_below(2));
    expect_near(seen(strand_map(along_z, trench, rays(4096)), 4), alpha / latlong::pi,
                V3d(0, 8 * std::sin(alpha) / (3 * latlong::pi * latlong::pi), 0), .004);
}

TEST(StrandMap, AParallelStrandHidesTheAngleOfItsWidth)
{
    // As good as endless, so that the closed form holds in the middle.
    const Strands pair = straight({ { V3d(0, 0, -1), V3d(0, 0, 1) }, { V3d(.1, 0, -1e3), V3d(.1, 0, 1e3) } }, .02, 65);
    const OIIO::ImageBuf map = strand_map(pair, {}, rays(16384), 9);
    const double width = .02 / .1;
    expect_near(seen(map, 4), 1 - std::asin(width) / latlong::pi,
                V3d(-8 * width / (3 * latlong::pi * latlong::pi), 0, 0), .002);
}

TEST(StrandMap, NothingBeyondTheMaximumDistanceHides)
{
    VismapParams params = rays(64);
    params.max_distance = .4;
    EXPECT_EQ(seen(strand_map(kAlongX, { floor_below(.5) }, params), 3).v, 1);
    params.max_distance = .6;
    EXPECT_LT(seen(strand_map(kAlongX, { floor_below(.5) }, params), 3).v, 1);
}

TEST(StrandMap, ScaleAndPlaceChangeNothing)
{
    const auto bake = [](double scale, const V3d& offset) {
        Strands strands = straight({ { V3d(-1, 0, 0), V3d(1, 0, 0) }, { V3d(0, .5, -1), V3d(0, .5, 1) } }, .05);
        for (V3d& p : strands.points)
            p = p * scale + offset;
        for (double& radius : strands.radii)
            radius *= scale;
        return strand_map(strands, {}, rays(64));
    };
    const OIIO::ImageBuf one = bake(1, V3d(0));
    EXPECT_LT(seen(one, 3).v, 1);
    for (const double scale : { 1e-6, 1e6 })
        for (int x = 0; x < 8; ++x)
            EXPECT_NEAR(seen(bake(scale, V3d(3e4 * scale)), x).v, seen(one, x).v, 1.5 / 64) << scale << " " << x;
}

TEST(StrandMap, HarmonicsOfAnOpenStrandAreThoseOfItsTangent)
{
    VismapParams params = rays(16);
    params.basis = "sh";
    params.order = 4;
    const Strands oblique = straight({ { V3d(0), V3d(1, 2, 2) } }, .01);
    const OIIO::ImageBuf map = strand_map(oblique, {}, params);
    ASSERT_EQ(map.nchannels(), 7 + 12);
    const Harmonics harmonics(4);
    std::vector<float> values(16 * Harmonics::kLanes);
    std::array<float, Harmonics::kLanes> x {}, y {}, z {};
    x[0] = 1 / 3.f, y[0] = 2 / 3.f, z[0] = 2 / 3.f;
    harmonics.evaluate(x.data(), y.data(), z.data(), values.data());
    for (int k = 4; k < 16; ++k)
        EXPECT_NEAR(map.getchannel(2, 0, 0, 7 + k - 4),
                    (k < 9 ? sine_eigenvalue(2) : 0) * values[size_t(k) * Harmonics::kLanes], 1e-6)
            << k;
}

TEST(StrandMap, ThreadsAndTilesChangeNoBit)
{
    std::vector<std::pair<V3d, V3d>> ends;
    for (int i = 0; i < 150; ++i) {
        const V3d root(.1 * (i % 12), 0, .1 * (i / 12));
        ends.emplace_back(root, root + V3d(.05 * (i % 3), 1, .02 * (i % 7)));
    }
    const Strands tuft = straight(ends, .01);
    const VismapParams params = rays(16);
    const OIIO::ImageBuf one = strand_map(tuft, {}, params, 8, 1), many = strand_map(tuft, {}, params, 8, 3);
    const size_t bytes = one.spec().image_bytes();
    ASSERT_EQ(bytes, many.spec().image_bytes());
    EXPECT_EQ(std::memcmp(one.localpixels(), many.localpixels(), bytes), 0);

    StrandScene scene;
    StrandLayout layout;
    std::string error;
    ASSERT_TRUE(scene.build(tuft, {}, 1, error)) << error;
    ASSERT_TRUE(StrandLayout::make(layout, tuft.count(), 8, error)) << error;
    const StrandBaker baker(tuft, scene, layout, params);
    const OIIO::ROI part(3, 14, 20, 50, 0, 1, 0, one.nchannels());
    std::vector<float> baked(size_t(part.npixels()) * size_t(one.nchannels())), whole(baked.size());
    baker.bake(part, baked.data());
    ASSERT_TRUE(one.get_pixels(part, OIIO::TypeFloat, whole.data()));
    EXPECT_EQ(baked, whole);
}

TEST(StrandLayout, MapsAreAboutSquareAndEachStrandHasItsTexels)
{
    StrandLayout layout;
    std::string error;
    ASSERT_TRUE(StrandLayout::make(layout, 50000, 28, error)) << error;
    EXPECT_EQ(layout.size().height, 1216);
    EXPECT_EQ(layout.size().width, 42 * 28);
    ASSERT_TRUE(StrandLayout::make(layout, 3, 16, error)) << error;
    EXPECT_EQ(layout.size().width, 16);
    EXPECT_EQ(layout.size().height, 3);
    ASSERT_TRUE(StrandLayout::make(layout, 150, 8, error)) << error;
    EXPECT_EQ(layout.size().width, 24);
    EXPECT_EQ(layout.size().height, 64);
    EXPECT_EQ(layout.strand_at(0, 1), 1);
    EXPECT_EQ(layout.strand_at(8, 1), 65);
    EXPECT_EQ(layout.strand_at(16, 21), 149);
    EXPECT_EQ(layout.strand_at(16, 22), 150) << "no strand";
    // The lookup of a strand's own texel centres gives them back.
    const Imath::V2d uv = layout.uv(65, layout.share_at(10));
    EXPECT_NEAR(uv.x * 24, 10.5, 1e-12);
    EXPECT_NEAR((1 - uv.y) * 64, 1.5, 1e-12);
    EXPECT_NEAR(layout.uv(65, 0).x * 24, 8.5, 1e-12) << "not the strand to the left";
    EXPECT_FALSE(StrandLayout::make(layout, 1000000000, 4096, error));
    EXPECT_NE(error.find("strand_texels: "), std::string::npos);
}

TEST(StrandLayout, EachPointHasTheUvOfItsPlaceInTheMap)
{
    const Strands strands = straight({ { V3d(0), V3d(0, 3, 0) }, { V3d(1, 0, 0), V3d(1, 6, 0) } }, 0.1);
    StrandLayout layout;
    std::string error;
    ASSERT_TRUE(StrandLayout::make(layout, 2, 8, error)) << error;
    const std::vector<Imath::V2f> uvs = strand_uvs(strands, layout);
    ASSERT_EQ(uvs.size(), strands.points.size());
    for (size_t i = 0; i < uvs.size(); ++i) {
        // The spline of evenly spaced points passes through them; the ends are the centres of the outer texels.
        const double expected[] = { .5 / 8, 1. / 3, 2. / 3, 7.5 / 8 };
        EXPECT_NEAR(uvs[i].x, expected[i % 4], 1e-6) << i;
        EXPECT_NEAR(uvs[i].y, i < 4 ? .75 : .25, 1e-6) << i;
    }
}

TEST(StrandScene, StrandsTooThinToBeMetAreRefused)
{
    Strands thin = kAlongX;
    for (double& radius : thin.radii)
        radius = 1e-12;
    StrandScene scene;
    std::string error;
    EXPECT_FALSE(scene.build(thin, {}, 1, error));
    EXPECT_NE(error.find("rays would miss it"), std::string::npos) << error;
    // Cut, and so as wide as it is.
    const Strands needle
        = straight({ { V3d(0, 0, -1), V3d(0, 0, 1) }, { V3d(1e-3, 0, -1), V3d(1e-3, 0, 1) } }, 1e-4, 2);
    ASSERT_TRUE(scene.build(needle, {}, 1, error)) << error;
    EXPECT_GT(scene.span_count(), 2);
}
