// SPDX-License-Identifier: Apache-2.0
// Rays and bakes through cut-outs.
#include "baked_map.h"
#include "cutout_scene.h"

#include <vmlight/trace/bake_scene.h>
#include <vmlight/trace/occluder.h>
#include <vmlight/vismap/baker.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace vmlight;
using namespace vmlight::cutout_scene;
using scenes::floor_facing_z;

namespace {

constexpr double kPointLike = 1e-4; // half the side of a floor all of whose texels see the same

// The cosine-weighted share of the hemisphere that a square of side 2 `half` takes, seen from below its middle at
// distance 1.
double share_of_square(double half)
{
    const double r = std::sqrt(1 + half * half);
    return 4 / M_PI * half / r * std::atan(half / r);
}

double mean_visibility(const BakedMap& map)
{
    double sum = 0;
    map.each([&](const Texel& texel, int, int) { sum += texel.visibility; });
    return sum / (double(map.spec().width) * map.spec().height);
}

// Three standard errors of `rays` independent rays.
double three_sigma(double visibility, double rays)
{
    return 3 * std::sqrt(visibility * (1 - visibility) / rays);
}

struct CutTrace
{
    CutTrace(const Mesh& mesh, CutoutMode mode = CutoutMode::micromaps, int nthreads = 1)
    {
        std::string error;
        EXPECT_TRUE(occluder.build({ &mesh }, {}, nthreads, error, mode)) << error;
    }
    // The open ones of rays from random places, seen near and far.
    std::vector<uint8_t> open(int fans, float length = std::numeric_limits<float>::infinity()) const
    {
        std::mt19937 random(11);
        std::normal_distribution<float> normal;
        std::vector<uint8_t> result;
        for (int i = 0; i < fans; ++i) {
            RayFan fan(64);
            for (int k = 0; k < 64; ++k) {
                const V3f d = V3f(normal(random), normal(random), normal(random)).normalized();
                fan.x[k] = d.x, fan.y[k] = d.y, fan.z[k] = d.z;
            }
            fan.lanes.assign(fan.lanes.size(), 0xff);
            const V3f origin(normal(random) * 0.5f, normal(random) * 0.5f, 0.6f + normal(random) * 0.5f);
            occluder.clear_blocked(fan, origin, length, i % 3 == 0);
            result.insert(result.end(), fan.lanes.begin(), fan.lanes.end());
        }
        return result;
    }
    Occluder occluder;
};

} // namespace

TEST(Cutouts, ALeafCardHalfOpenInACheckerHidesHalfOfWhatItWould)
{
    // A quarter turn changes open and closed fields, half a turn none: V and the height of B are those of half a card.
    const double hidden = share_of_square(2) / 2;
    for (int fields : { 2, 8, 64 }) {
        const Mesh leaf_card = with_material(card(2, 1), material(AlphaMode::mask, checker(fields)));
        for (int samples : { 256, 1024 }) {
            const BakedMap map(floor_facing_z(kPointLike), { leaf_card }, map_params(8, 8, samples));
            const double sigma = three_sigma(1 - hidden, samples);
            EXPECT_NEAR(mean_visibility(map), 1 - hidden, sigma / 8) << fields << ", " << samples;
            map.each([&](const Texel& texel, int, int) {
                EXPECT_NEAR(texel.visibility, 1 - hidden, sigma * 4 / 3) << fields << ", " << samples; // of 64
            });
        }
    }
}

TEST(Cutouts, ABlendStopsItsShareLayerByLayer)
{
    const double share = share_of_square(2);
    const MaterialOpacity glass = material(AlphaMode::blend, nullptr, 0.3);
    const Mesh near = with_material(card(2, 1), glass), far = with_material(card(4, 2), glass);
    const int samples = 1024;
    for (const auto& [panes, passed] :
         { std::pair(std::vector<Mesh> { near }, 0.7), { { near, far }, 0.49 }, { { far, near }, 0.49 } }) {
        const BakedMap map(floor_facing_z(kPointLike), panes, map_params(8, 8, samples));
        const double wanted = 1 - share * (1 - passed);
        EXPECT_NEAR(mean_visibility(map), wanted, three_sigma(wanted, samples * 64.0)) << panes.size();
    }
}

TEST(Cutouts, ChanceDependsOnTheRayAlone)
{
    const Mesh crown = with_material(foliage(60, 3), material(AlphaMode::blend, leaf(32), 0.6));
    VismapParams params = map_params(70, 70, 32);
    const BakedMap one(floor_facing_z(1), { crown }, params, 1);
    EXPECT_TRUE(one == BakedMap(floor_facing_z(1), { crown }, params, 2));
    // A tile alone has the bits of the whole.
    const Mesh floor = floor_facing_z(1);
    VismapBaker baker;
    std::string error;
    ASSERT_TRUE(baker.prepare(floor, { crown }, params, 1, error)) << error;
    const size_t pitch = size_t(kTileSize) * size_t(baker.channels());
    std::vector<float> texels(pitch * kTileSize);
    TileBits covered;
    baker.bake_tile(3, *baker.scratch(), texels.data(), pitch, covered);
    EXPECT_EQ(texels[0], one.at(kTileSize, kTileSize).visibility);
    params.seed = 1;
    EXPECT_FALSE(one == BakedMap(floor_facing_z(1), { crown }, params, 1));
}

TEST(Cutouts, MicromapsChangeNoBitOfWhatTheTextureSaysAtEveryHit)
{
    for (AlphaMode mode : { AlphaMode::mask, AlphaMode::blend })
        for (const auto& [alpha, is_leaf] : { std::pair(leaf(256), true), { checker(16), false } }) {
            const Mesh crown = with_material(foliage(150, 7), material(mode, alpha));
            const CutTrace fast(crown), slow(crown, CutoutMode::every_hit), threaded(crown, CutoutMode::micromaps, 2);
            const std::vector<uint8_t> open = slow.open(300);
            EXPECT_EQ(fast.open(300), open);
            EXPECT_EQ(threaded.open(300), open);
            const CutoutWork work = fast.occluder.cutout_work(), every = slow.occluder.cutout_work();
            EXPECT_EQ(every.lookups, every.hits);
            EXPECT_GT(every.hits, 1000);
            EXPECT_LE(work.lookups, is_leaf ? work.hits / 5 : work.hits); // a checker is all borders
        }
}

// Where Embree's own weights of hits are the least exact.
TEST(Cutouts, MicromapsChangeNoBitOfSliversFarAwayAndFromTheSide)
{
    std::mt19937 random(23);
    std::uniform_real_distribution<double> exponent(-3, 0);
    std::normal_distribution<double> normal;
    const auto direction = [&] { return V3d(normal(random), normal(random), normal(random)).normalized(); };
    Mesh slivers = foliage(400, 9);
    for (size_t quad = 0; quad < slivers.triangles.size() / 2; ++quad) {
        const V3d along = direction();
        const double shrink = 1 - std::pow(10, exponent(random)), size = std::pow(10, exponent(random));
        const V3d place = direction() * 3;
        for (size_t k = 0; k < 4; ++k) { // four vertices a quad
            const V3d p(slivers.positions[4 * quad + k] - slivers.positions[4 * quad]);
            slivers.positions[4 * quad + k] = V3f(place + (p - along * along.dot(p) * shrink) * size);
        }
    }
    const Mesh crown = with_material(std::move(slivers), material(AlphaMode::mask, leaf(256)));
    const CutTrace fast(crown), slow(crown, CutoutMode::every_hit);
    int blocked = 0, differing = 0;
    for (int packet = 0; packet < 20000; ++packet) {
        std::array<V3f, kPacketSize> origins, directions;
        for (size_t lane = 0; lane < kPacketSize; ++lane) {
            const auto& corners = crown.triangles[random() % crown.triangles.size()];
            const double u = std::abs(normal(random)) * 0.3, v = std::abs(normal(random)) * 0.3;
            const V3d a(crown.positions[corners[0]]), b(crown.positions[corners[1]]), c(crown.positions[corners[2]]);
            const V3d target = a + (b - a) * u + (c - a) * v, away = direction() * std::pow(10, 1 + exponent(random));
            origins[lane] = V3f(target + away);
            directions[lane] = V3f((target - V3d(origins[lane])).normalized());
        }
        const float length = std::numeric_limits<float>::infinity();
        const uint8_t a = fast.occluder.find_blocked(origins.data(), directions.data(), kPacketSize, length);
        const uint8_t b = slow.occluder.find_blocked(origins.data(), directions.data(), kPacketSize, length);
        blocked += __builtin_popcount(b);
        differing += __builtin_popcount(a ^ b);
    }
    EXPECT_GT(blocked, 40000);
    EXPECT_EQ(differing, 0);
    EXPECT_LT(fast.occluder.cutout_work().lookups, slow.occluder.cutout_work().lookups / 2);
}

TEST(Cutouts, TrianglesThatAreOneOrTheOtherAreNeverAskedAbout)
{
    const auto flat = [](float value) { return texture(16, 16, [value](int, int) { return value; }); };
    const Mesh plain = foliage(50, 5);
    const std::vector<uint8_t> opaque = CutTrace(plain).open(100);
    const CutTrace ones(with_material(plain, material(AlphaMode::mask, flat(0.8f))));
    EXPECT_EQ(ones.open(100), opaque);
    const CutTrace none(with_material(plain, material(AlphaMode::mask, flat(0.2f))));
    EXPECT_EQ(none.open(100), std::vector<uint8_t>(800, 0xff));
    for (const CutTrace* trace : { &ones, &none }) {
        EXPECT_EQ(trace->occluder.cutout_work().hits, 0);
        EXPECT_EQ(trace->occluder.cutout_work().lookups, 0);
        EXPECT_EQ(trace->occluder.cutouts().triangles, 100);
        EXPECT_EQ(trace->occluder.cutouts().mixed, 0);
    }
    const CutTrace without(plain);
    without.open(10);
    EXPECT_EQ(without.occluder.cutouts().triangles, 0);
    EXPECT_EQ(without.occluder.cutouts().bytes, 0u);
    EXPECT_EQ(without.occluder.cutout_work().hits, 0);
}

TEST(Cutouts, LeavesOfOneKindShareAMicromap)
{
    const MaterialOpacity rule = material(AlphaMode::mask, leaf(256));
    const Mesh few = with_material(foliage(2, 5), rule), many = with_material(foliage(200, 5), rule);
    const CutoutCounts one = CutTrace(few).occluder.cutouts(), all = CutTrace(many).occluder.cutouts();
    EXPECT_EQ(all.mixed, 400);
    EXPECT_EQ(all.cells, 100 * one.cells);
    EXPECT_LT(all.bytes - one.bytes, 400 * 100u) << "a few numbers for each triangle, and no cells";
}

TEST(Cutouts, WhatIsAroundAHoleStaysTight)
{
    // The middle of a sheet is one material, its border another: along their common edges no ray leaks.
    Mesh sheet;
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i)
            scenes::add_quad(sheet, V3d(i, j, 1), V3d(i + 1, j, 1), V3d(i + 1, j + 1, 1), V3d(i, j + 1, 1),
                             V2f(float(i), float(j)), V2f(float(i + 1), float(j + 1)));
    sheet.name = "sheet";
    sheet = with_material(sheet, material(AlphaMode::mask, nullptr, 1));
    auto opacity = std::make_shared<MeshOpacity>();
    // Opaque but for one texel in the middle of the middle.
    opacity->materials
        = { MaterialOpacity(),
            material(AlphaMode::mask, texture(9, 9, [](int x, int y) { return x == 4 && y == 4 ? 0.0f : 1.0f; })) };
    sheet.opacity = opacity;
    for (const size_t triangle : { 8, 9 })
        sheet.triangle_materials.set(triangle, 1);
    const CutTrace trace(sheet);
    EXPECT_EQ(trace.occluder.cutouts().triangles, 2);
    EXPECT_EQ(trace.occluder.cutouts().mixed, 2);
    const auto is_open = [&](double x, double y) {
        RayFan fan(1);
        const V3d d = (V3d(x, y, 1) - V3d(1.4, 1.3, 0)).normalized();
        fan.x[0] = float(d.x), fan.y[0] = float(d.y), fan.z[0] = float(d.z);
        fan.lanes[0] = 1;
        trace.occluder.clear_blocked(fan, V3f(1.4f, 1.3f, 0), std::numeric_limits<float>::infinity());
        return fan.lanes[0] == 1;
    };
    for (int i = 0; i <= 1000; ++i) {
        const double along = 0.01 + 2.98 * i / 1000;
        for (double edge : { 1.0, 2.0 }) {
            EXPECT_FALSE(is_open(along, edge)) << along;
            EXPECT_FALSE(is_open(edge, along)) << along;
        }
    }
    EXPECT_TRUE(is_open(1.5, 1.5));
    EXPECT_FALSE(is_open(1.3, 1.5));
}

TEST(Cutouts, MaterialsThatAreNotThereAreOpaque)
{
    Mesh mesh = with_material(foliage(10, 5), material(AlphaMode::mask, nullptr, 0));
    mesh.triangle_materials.assign(mesh.triangles.size(), 7);
    EXPECT_EQ(CutTrace(mesh).open(50), CutTrace(foliage(10, 5)).open(50));
    mesh.triangle_materials.clear();
    EXPECT_EQ(CutTrace(mesh).open(50), CutTrace(foliage(10, 5)).open(50));
}

TEST(Cutouts, ABakedCardStillHasTexelsWhereItIsOpen)
{
    const Mesh open = with_material(floor_facing_z(1), material(AlphaMode::mask, nullptr, 0));
    BakedMap(open, {}, map_params(8, 8, 16)).each([](const Texel& texel, int, int) { EXPECT_EQ(texel.visibility, 1); });
}
