// SPDX-License-Identifier: Apache-2.0
// What texels see of a disc of the sky, against closed forms.
#include "baked_map.h"
#include "scenes.h"

#include <vmlight/lightmap/sun_light.h>
#include <vmlight/vismap/sun_visibility.h>

#include <gtest/gtest.h>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

struct SunTrace
{
    std::vector<float> seen;
    int64_t rays = 0;

    SunTrace(const Mesh& mesh, const std::vector<Mesh>& occluders, const std::vector<Disc>& discs, VismapParams map,
             int nthreads = 0)
    {
        std::string error;
        auto scene = std::make_shared<BakeScene>();
        SunTracer tracer;
        EXPECT_TRUE(scene->build(non_owning(mesh), occluders, nthreads, error)) << error;
        EXPECT_TRUE(tracer.prepare(scene, map, error, nthreads)) << error;
        EXPECT_TRUE(tracer.trace(seen, discs, nthreads));
        rays = tracer.rays();
    }
    double mean() const
    {
        double sum = 0;
        for (const float t : seen)
            sum += double(t);
        return sum / double(seen.size());
    }
};

VismapParams sun_map_of(int side, int margin = 0)
{
    VismapParams map;
    map.resolution = { side, side };
    map.margin = margin;
    return map;
}

// With the rays of texels that nothing rises above.
VismapParams traced_map_of(int side, int margin = 0)
{
    VismapParams map = sun_map_of(side, margin);
    map.skip_open = false;
    return map;
}

Disc disc_at(double elevation, double half_angle, double azimuth = 0)
{
    const double e = elevation * latlong::pi / 180, a = azimuth * latlong::pi / 180;
    return { V3d(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)), half_angle * latlong::pi / 180 };
}

} // namespace

TEST(SunVisibility, AnOpenFloorSeesTheWholeDisc)
{
    for (const auto& [half_angle, probes] :
         { std::pair(0.0, 8), { 0.265, 8 }, { 2.0, 8 }, { 4.0, 16 }, { 8.0, 8 }, { 25.0, 8 } })
        for (const double elevation : { 90.0, 45.0, 27.0, 10.0 }) {
            if (elevation < half_angle)
                continue;
            const Disc disc = disc_at(elevation, half_angle, 77);
            const SunTrace traced(floor_facing_z(1), {}, { disc }, traced_map_of(16));
            for (const float t : traced.seen)
                ASSERT_NEAR(t, disc.direction.z * (1 + std::cos(disc.half_angle)) / 2, 1e-6);
            // The corners of the map have too few neighbours to agree with, and probe the disc.
            EXPECT_EQ(traced.rays, 256 + 4 * probes);
        }
}

TEST(SunVisibility, WhatIsBelowTheHorizonTracesNoRay)
{
    const SunTrace traced(floor_facing_z(1), {}, { disc_at(-1, 0.5), disc_at(-60, 5), disc_at(-0.6, 0.5) },
                          sun_map_of(16));
    EXPECT_EQ(traced.rays, 0);
    for (const float t : traced.seen)
        ASSERT_EQ(t, 0);
    // Half of a box faces away, and no side hides another.
    const Mesh box = scenes::box(V3d(-1), V3d(1), false);
    const SunTrace lit(box, {}, { disc_at(35, 0.265, 45) }, traced_map_of(64)),
        other(box, {}, { disc_at(-35, 0.265, 225) }, traced_map_of(64));
    // And eight in the corners of two sides, which have too few neighbours.
    EXPECT_EQ(lit.rays, std::count_if(lit.seen.begin(), lit.seen.end(), [](float t) { return t > 0; }) + 8 * 8);
    EXPECT_NEAR(double(lit.rays), double(other.rays), 0.1 * double(lit.rays));
    for (size_t i = 0; i < lit.seen.size(); ++i)
        ASSERT_TRUE(lit.seen[i] == 0 || other.seen[i] == 0);
}

TEST(SunVisibility, WhatNothingRisesAboveTracesNoRay)
{
    const Mesh ball = icosphere(2), box = scenes::box(V3d(-1), V3d(1), false),
               inside = scenes::box(V3d(-1), V3d(1), true);
    const std::vector<Mesh> beside { sphere(V3d(2.5, 0, 0), 0.5, 16) };
    const std::vector<Disc> discs { disc_at(20, 0.265, 10), disc_at(2, 5, 77), disc_at(80, 25) }; // the second sets
    const auto rays_of = [&](const Mesh& mesh, const std::vector<Mesh>& occluders, bool is_over_ground) {
        VismapParams all = traced_map_of(64, 3), some = sun_map_of(64, 3);
        all.ground = some.ground = is_over_ground;
        const SunTrace traced(mesh, occluders, discs, all), spared(mesh, occluders, discs, some);
        EXPECT_EQ(spared.seen, traced.seen);
        EXPECT_GT(traced.mean(), 0);
        return std::pair(spared.rays, traced.rays);
    };
    for (const bool is_over_ground : { false, true }) {
        for (const Mesh& convex : { ball, box, floor_facing_z(1) })
            EXPECT_EQ(rays_of(convex, {}, is_over_ground).first, 0);
        const auto [some, all] = rays_of(box, beside, is_over_ground);
        EXPECT_GT(some, 0);
        EXPECT_LT(some, all);
    }
    // Three sides of an open room, which all see each other.
    Mesh room = inside;
    room.triangles.resize(6);
    const auto [some, all] = rays_of(room, {}, false);
    EXPECT_GT(some, all / 4); // some of those in each other's shadow are spared
}

TEST(SunVisibility, SunsOfAMapTraceNoRayEither)
{
    VismapParams map = sun_map_of(32);
    map.samples = 16;
    const BakedMap plain(scenes::box(V3d(-1), V3d(1), false), {}, map);
    map.sun_directions = "1,2,3;0,0,1,5;-1,0.02,0,10";
    const BakedMap spared(scenes::box(V3d(-1), V3d(1), false), {}, map);
    map.skip_open = false;
    const BakedMap traced(scenes::box(V3d(-1), V3d(1), false), {}, map);
    EXPECT_EQ(plain.report.rays, 0);
    EXPECT_EQ(spared.report.rays, 0);
    EXPECT_GT(traced.report.rays, 0);
    const auto pixels_of = [](const BakedMap& baked) {
        std::vector<float> pixels(baked.spec().image_pixels() * size_t(baked.spec().nchannels));
        EXPECT_TRUE(baked.image().get_pixels(baked.image().roi(), OIIO::TypeFloat, pixels.data()));
        return pixels;
    };
    EXPECT_EQ(pixels_of(spared), pixels_of(traced));
}

// Where a disc is cut by the horizon, the mean of n.w above it: by quadrature.
TEST(SunVisibility, ADiscThatSetsIsCutByTheHorizon)
{
    for (const double elevation : { 3.0, 0.0, -3.0 }) {
        const Disc disc = disc_at(elevation, 5);
        double sum = 0;
        constexpr int n = 400;
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                const double cosine = 1 - (j + 0.5) / n * (1 - std::cos(disc.half_angle)),
                             turn = 2 * latlong::pi * (i + 0.5) / n;
                const double e = elevation * latlong::pi / 180;
                sum += std::max(0.0,
                                std::sin(e) * cosine + std::cos(e) * std::sqrt(1 - cosine * cosine) * std::sin(turn));
            }
        const SunTrace traced(floor_facing_z(1), {}, { disc }, sun_map_of(64));
        EXPECT_NEAR(traced.mean(), sum / (n * n), 0.01 * std::sin(disc.half_angle)) << elevation;
    }
}

TEST(SunVisibility, AWallThrowsAShadowWithAPenumbra)
{
    // From the origin the top of the wall is at 45 degrees; along it the wall has no end, so that the edge is straight.
    const Mesh wall = rectangle(V3d(1, -1e5, 0), V3d(0, 2e5, 0), V3d(0, 0, 1));
    for (const double half_angle : { 0.3, 1.0, 4.0 })
        for (const double above : { -1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5 }) { // of the middle, in half angles
            const Disc disc = disc_at(45 + above * half_angle, half_angle);
            // A circular segment, which is lit less the lower it is; discs are so small that the sphere is flat.
            const double h = std::clamp(above, -1.0, 1.0), root = std::sqrt(1 - h * h);
            const double visible = 1 - (std::acos(h) - h * root) / latlong::pi
                + disc.half_angle / std::tan((45 + above * half_angle) * latlong::pi / 180) * 2 / 3 * root * root * root
                    / latlong::pi;
            const SunTrace traced(floor_facing_z(1e-5), { wall }, { disc }, sun_map_of(64));
            const double noise = std::sqrt(visible * (1 - visible) / (4096 * disc_rays(disc.half_angle)));
            EXPECT_NEAR(traced.mean() / (disc.direction.z * disc_mean_length(disc.half_angle)), visible,
                        4 * noise + 0.03 * disc.half_angle + 1e-3)
                << half_angle << " " << above;
            // Texel by texel too: with one ray each it would be up to .5.
            double squares = 0;
            for (const float t : traced.seen)
                squares += std::pow(double(t) / (disc.direction.z * disc_mean_length(disc.half_angle)) - visible, 2);
            EXPECT_LT(std::sqrt(squares / double(traced.seen.size())), 0.12) << half_angle << " " << above;
            if (std::abs(above) > 1) {
                for (const float t : traced.seen)
                    ASSERT_EQ(t > 0, above > 0) << half_angle << " " << above;
            }
        }
}

TEST(SunVisibility, ASphereIsLitByItsNormalAlone)
{
    const Mesh ball = sphere(V3d(3, 4, 5), 2, 64);
    const Disc disc = disc_at(20, 0.265, 200);
    const int side = 128;
    const SunTrace traced(ball, {}, { disc }, sun_map_of(side));
    for (int y = 2; y < side - 2; ++y) // at the poles, half of the texels are covered
        for (int x = 0; x < side; ++x) {
            const double theta = latlong::pi * (y + 0.5) / side, phi = 2 * latlong::pi * (x + 0.5) / side;
            const V3d n(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
            // Facets of 3 degrees: the terminator may be a facet off.
            const double facing = n.dot(disc.direction), seen = double(traced.seen[size_t(y) * side + size_t(x)]);
            if (std::abs(facing) > 0.06) {
                ASSERT_NEAR(seen, std::max(0.0, facing), 2e-3) << x << " " << y;
            }
        }
}

TEST(SunVisibility, SameBitsForAnyNumberOfThreadsAndSuns)
{
    const Mesh ball = sphere(V3d(0), 1, 16);
    const std::vector<Mesh> occluders { sphere(V3d(1.5, 0, 0.5), 0.5, 16) };
    const std::vector<Disc> discs { disc_at(20, 0.265, 10), disc_at(30, 6, 20), disc_at(-80, 1) };
    const VismapParams map = sun_map_of(150, 3);
    const SunTrace one(ball, occluders, discs, map, 1), four(ball, occluders, discs, map, 4);
    EXPECT_EQ(one.seen, four.seen);
    EXPECT_EQ(one.rays, four.rays);
    const SunTrace second(ball, occluders, { discs[1] }, map, 2);
    for (size_t i = 0; i < second.seen.size(); ++i)
        ASSERT_EQ(second.seen[i], one.seen[3 * i + 1]);
    VismapParams other = map;
    other.seed = 1;
    EXPECT_NE(SunTrace(ball, occluders, discs, other).seen, one.seen);
}

TEST(SunVisibility, FarOccludersAreLeftOut)
{
    const Mesh lid = quad(V3d(-9, -9, 1), V3d(9, -9, 1), V3d(9, 9, 1), V3d(-9, 9, 1));
    VismapParams map = sun_map_of(8);
    EXPECT_EQ(SunTrace(floor_facing_z(1), { lid }, { disc_at(60, 0.3) }, map).mean(), 0);
    map.max_distance = 0.9;
    EXPECT_GT(SunTrace(floor_facing_z(1), { lid }, { disc_at(60, 0.3) }, map).mean(), 0.5);
}

TEST(SunVisibility, TheMarginHasTheMeanOfItsNeighbours)
{
    Mesh floor = floor_facing_z(1);
    for (V2f& uv : floor.uvs)
        uv = uv * 0.5f + V2f(0.25f);
    const Disc disc = disc_at(30, 0.3);
    const SunTrace traced(floor, {}, { disc }, sun_map_of(32, 4));
    int lit = 0;
    for (const float t : traced.seen) {
        lit += t > 0;
        ASSERT_TRUE(t == 0 || std::abs(double(t) - 0.5) < 1e-5) << t;
    }
    EXPECT_EQ(lit, 24 * 24);
}

TEST(SunVisibility, RaysGrowWithTheDisc)
{
    EXPECT_EQ(disc_rays(0), 16);
    EXPECT_EQ(disc_rays(0.265 * latlong::pi / 180), 16);
    EXPECT_EQ(disc_rays(2.5 * latlong::pi / 180), 32);
    EXPECT_EQ(disc_rays(5.9 * latlong::pi / 180), 32);
    EXPECT_EQ(disc_rays(6.1 * latlong::pi / 180), 16);
    EXPECT_EQ(disc_rays(40 * latlong::pi / 180), 16);
}

TEST(SunVisibility, DirectionsFillTheDiscEvenly)
{
    for (const double half_angle : { 0.01, 0.3 })
        for (const V3d& axis : { V3d(0, 1, 0), V3d(0.6, 0, -0.8) }) {
            const DiscSamples samples({ axis, half_angle });
            for (const int rays : { 64, int(DiscSamples::kCount) })
                for (const uint32_t hash : { 0u, 12345u, 0xffffffffu }) {
                    V3d sum(0);
                    for (int ray = 0; ray < rays; ++ray) {
                        const V3d d(samples.at(hash, ray, rays));
                        ASSERT_LT((d - axis).length(), 2 * std::sin(0.5 * half_angle) + 1e-6);
                        sum += d / rays;
                    }
                    EXPECT_LT((sum - axis * disc_mean_length(half_angle)).length(), 0.06 * half_angle) << rays;
                }
        }
    for (const double half_angle : { 1e-4, 0.0047, 0.5, latlong::pi / 2 }) {
        EXPECT_NEAR(disc_half_angle(disc_mean_length(half_angle)) / half_angle, 1, 1e-7);
        EXPECT_NEAR(disc_solid_angle(half_angle) / (2 * latlong::pi * (1 - std::cos(half_angle))), 1, 1e-6);
    }
}
