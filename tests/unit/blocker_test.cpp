// SPDX-License-Identifier: Apache-2.0
// What has blocked a ray is tried before the next is traced: the same bits, with fewer rays.
#include "cutout_scene.h"
#include "scenes.h"

#include <vmlight/trace/blocker.h>
#include <vmlight/vismap/sun_visibility.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

constexpr float kAnyLength = std::numeric_limits<float>::infinity();

struct SunsTraced
{
    std::vector<float> seen;
    int64_t rays = 0;

    double mean() const { return std::accumulate(seen.begin(), seen.end(), 0.0) / double(seen.size()); }
};

SunsTraced trace_suns(const Mesh& mesh, const std::vector<Mesh>& occluders, const std::vector<Disc>& discs, bool spares,
                      VismapParams map = {}, int nthreads = 0)
{
    map.resolution = { 64, 64 };
    map.margin = 0;
    map.skip_open = spares;
    std::string error;
    auto scene = std::make_shared<BakeScene>();
    SunTracer tracer;
    SunsTraced traced;
    EXPECT_TRUE(scene->build(non_owning(mesh), occluders, nthreads, error)) << error;
    EXPECT_TRUE(tracer.prepare(scene, map, error, nthreads)) << error;
    EXPECT_TRUE(tracer.trace(traced.seen, discs, nthreads));
    traced.rays = tracer.rays();
    return traced;
}

Mesh lid(double height)
{
    return quad(V3d(-90, -90, height), V3d(90, -90, height), V3d(90, 90, height), V3d(-90, 90, height));
}

Disc sun(double x, double y, double z, double half_angle = 0.265)
{
    return { V3d(x, y, z).normalized(), half_angle * latlong::pi / 180 };
}

} // namespace

TEST(Blocker, BlocksWhatPassesThroughItsInside)
{
    const Blocker triangle(V3f(0, 0, 1), V3f(1, 0, 1), V3f(0, 1, 1)), rewound(V3f(0, 0, 1), V3f(0, 1, 1), V3f(1, 0, 1));
    for (const Blocker& blocker : { triangle, rewound }) {
        const V3f up(0, 0, 1);
        EXPECT_TRUE(blocker.surely_blocks(V3f(0.25f, 0.25f, 0), up, kAnyLength));
        EXPECT_TRUE(blocker.surely_blocks(V3f(0.25f, 0.25f, 2), -up, kAnyLength));
        EXPECT_TRUE(blocker.surely_blocks(V3f(0.25f, 0.25f, 0), up, 1.01f));
        EXPECT_FALSE(blocker.surely_blocks(V3f(0.25f, 0.25f, 0), up, 0.99f)) << "too far";
        EXPECT_FALSE(blocker.surely_blocks(V3f(0.25f, 0.25f, 0), -up, kAnyLength)) << "behind";
        EXPECT_FALSE(blocker.surely_blocks(V3f(0.25f, 0.25f, 1), up, kAnyLength)) << "in its plane";
        EXPECT_FALSE(blocker.surely_blocks(V3f(-0.25f, 0.25f, 0), up, kAnyLength)) << "beside it";
        EXPECT_FALSE(blocker.surely_blocks(V3f(0.75f, 0.75f, 0), up, kAnyLength)) << "beside it";
        EXPECT_FALSE(blocker.surely_blocks(V3f(0.25f, 0, 0), up, kAnyLength)) << "on an edge";
        EXPECT_FALSE(blocker.surely_blocks(V3f(0, 0, 0), up, kAnyLength)) << "on a corner";
        EXPECT_FALSE(blocker.surely_blocks(V3f(-1, 0.25f, 1), V3f(1, 0, 0), kAnyLength)) << "edge-on";
    }
    EXPECT_FALSE(Blocker().exists());
    EXPECT_FALSE(Blocker().surely_blocks(V3f(0), V3f(0, 0, 1), kAnyLength));
    const Blocker point(V3f(1), V3f(1), V3f(1)), line(V3f(0, 0, 1), V3f(1, 0, 1), V3f(2, 0, 1));
    EXPECT_FALSE(point.exists());
    EXPECT_FALSE(line.surely_blocks(V3f(0.5f, 0, 0), V3f(0, 0, 1), kAnyLength));
}

// Triangles of all shapes and distances, and rays close to their edges: it is never sure where Embree says otherwise.
TEST(Blocker, IsSureOnlyOfWhatEmbreeFinds)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto point = [&] { return V3d(unit(random), unit(random), unit(random)); };
    int sure = 0, blocked = 0;
    for (int i = 0; i < 300; ++i) {
        const double size = std::pow(10.0, 3 * unit(random) - 2), thin = std::pow(10.0, 3 * unit(random) - 3);
        const V3d a = point() * std::pow(10.0, unit(random)), b = a + point() * size,
                  c = a + (b - a) * unit(random) + point() * size * thin;
        Mesh mesh = rectangle(a, b - a, c - a);
        mesh.triangles.resize(1);
        Occluder occluder;
        std::string error;
        ASSERT_TRUE(occluder.build({ &mesh }, {}, 1, error)) << error;
        const TracedTriangles traced = occluder.triangles()[0];
        const Blocker blocker(traced.corner(0, 0), traced.corner(0, 1), traced.corner(0, 2));
        for (int k = 0; k < 200; ++k) {
            const double u = k % 2 ? std::pow(10.0, 4 * unit(random) - 4) * (k % 4 == 1 ? 1 : -1) : unit(random),
                         v = (1 + unit(random)) / 2;
            const V3d target
                = V3d(traced.corner(0, 0)) * (1 - u - v) + V3d(traced.corner(0, 1)) * u + V3d(traced.corner(0, 2)) * v;
            const V3f origin(point());
            const V3d to = target - V3d(origin);
            const V3f direction((to * (k % 16 ? 1 : -1)).normalized());
            const auto length = float(k % 8 == 3 ? to.length() * (1 + 1e-6 * unit(random)) : kAnyLength);
            std::array<V3f, kPacketSize> origins, directions; // those of all lanes are read
            origins.fill(origin);
            directions.fill(direction);
            const bool is_blocked = occluder.find_blocked(origins.data(), directions.data(), 1, length, false) != 0;
            const bool is_sure = blocker.surely_blocks(origin, direction, length);
            ASSERT_LE(is_sure, is_blocked) << i << " " << k;
            sure += is_sure;
            blocked += is_blocked;
        }
    }
    EXPECT_GT(blocked, 10000);
    EXPECT_GT(sure, 2000); // most are aimed at edges and slivers
}

TEST(Blocker, AFloorUnderALidTracesAPacketOrTwo)
{
    const std::vector<Disc> discs { sun(1, 2, 3) };
    const SunsTraced all = trace_suns(floor_facing_z(1), { lid(1) }, discs, false),
                     some = trace_suns(floor_facing_z(1), { lid(1) }, discs, true);
    EXPECT_EQ(all.rays, 64 * 64 + 4 * 8);
    EXPECT_EQ(all.mean(), 0);
    EXPECT_EQ(some.seen, all.seen);
    // The first packet of the looks, that of the corners' probes, and a few at the diagonal between two triangles.
    EXPECT_LT(some.rays, 64);
    EXPECT_GE(some.rays, 8 + 8);
}

TEST(Blocker, NothingIsTriedWhereNothingIsInTheWay)
{
    // A small lid beside the sun's way.
    const Mesh beside = quad(V3d(-9, -9, 1), V3d(-8, -9, 1), V3d(-8, -8, 1), V3d(-9, -8, 1));
    EXPECT_EQ(trace_suns(floor_facing_z(1), { beside }, { sun(0, 0, 1) }, true).rays,
              trace_suns(floor_facing_z(1), { beside }, { sun(0, 0, 1) }, false).rays);
}

TEST(Blocker, WhatLightPassesThroughIsNotOne)
{
    const SunsTraced none = trace_suns(floor_facing_z(1), {}, { sun(0, 0, 1) }, false);
    for (const AlphaMode mode : { AlphaMode::mask, AlphaMode::blend }) {
        const Mesh card = cutout_scene::with_material(cutout_scene::card(2, 1, 4),
                                                      cutout_scene::material(mode, cutout_scene::checker(8)));
        const SunsTraced all = trace_suns(floor_facing_z(1), { card }, { sun(0, 0, 1) }, false),
                         some = trace_suns(floor_facing_z(1), { card }, { sun(0, 0, 1) }, true);
        EXPECT_NEAR(all.mean(), none.mean() / 2, 0.1);
        EXPECT_EQ(some.seen, all.seen);
        EXPECT_EQ(some.rays, all.rays);
    }
}

TEST(Blocker, NothingIsTriedWhereShadowsOfTrianglesAreSmall)
{
    // 64 texels for each triangle, two of them the floor's, and fewer.
    const auto rays_of = [](int across, bool spares) {
        std::vector<Mesh> lids;
        for (int i = 0; i < across; ++i)
            lids.push_back(rectangle(V3d(2.0 * i / across - 1, -9, 1), V3d(2.0 / across, 0, 0), V3d(0, 18, 0)));
        return trace_suns(floor_facing_z(1), lids, { sun(0, 0, 1) }, spares).rays;
    };
    EXPECT_LT(rays_of(31, true), rays_of(31, false));
    EXPECT_EQ(rays_of(32, true), rays_of(32, false));
}

// Thin walls, sheets, folds and what is close to the floor.
TEST(Blocker, TheSameBitsAsWithEveryRay)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto point = [&] { return V3d(unit(random), unit(random), unit(random)); };
    int64_t some_rays = 0, all_rays = 0;
    for (int i = 0; i < 30; ++i) {
        std::vector<Mesh> occluders;
        for (int k = 0; k < 8; ++k)
            occluders.push_back(rectangle(point() * (k % 2 ? 1 : 0.1), point(), point() * (k % 3 ? 1 : 1e-3)));
        if (i % 3 == 0)
            occluders.push_back(placed(floor_facing_z(1), 0.5, V3d(0, 0, std::pow(10.0, -3 - i % 4))));
        const std::vector<Disc> discs { sun(unit(random), unit(random), 1), sun(0, 0, 1, 0), sun(1, 0, 0.02, 1),
                                        sun(unit(random), 1, 1, 8), sun(1, 1, 1, 40) };
        const Mesh mesh = i % 2 ? floor_facing_z(1) : sphere(V3d(0), 1, 4);
        VismapParams map;
        map.ground = i % 5 == 0;
        map.max_distance = i % 4 == 0 ? 0.7 : map.max_distance;
        const SunsTraced all = trace_suns(mesh, occluders, discs, false, map),
                         some = trace_suns(mesh, occluders, discs, true, map, 1 + i % 3);
        ASSERT_EQ(some.seen, all.seen) << i;
        EXPECT_LE(some.rays, all.rays);
        some_rays += some.rays;
        all_rays += all.rays;
    }
    EXPECT_LT(double(some_rays), double(all_rays) * 0.95);
}
