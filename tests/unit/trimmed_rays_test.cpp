// SPDX-License-Identifier: Apache-2.0
// Rays that meet cut-out triangles, which are traced as smaller ones.
#include "cutout_scene.h"

#include <vmlight/trace/occluder.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <string>

using namespace vmlight;
using namespace vmlight::cutout_scene;

namespace {

constexpr float kFarthest = std::numeric_limits<float>::infinity();

// A square card of side 2 in any place, of which the middle quarter is opaque, and its rim opaque to the left if asked.
Mesh framed_card(std::mt19937& random, bool has_left_rim)
{
    std::normal_distribution<double> normal;
    const auto direction = [&] { return V3d(normal(random), normal(random), normal(random)).normalized(); };
    const V3d x = direction(), y = x.cross(direction()).normalized(), middle = direction() * 0.3;
    Mesh mesh;
    mesh.name = "card";
    scenes::add_quad(mesh, middle - x - y, middle + x - y, middle + x + y, middle - x + y, V2f(0, 0), V2f(1, 1));
    const auto alpha = [has_left_rim](int s, int t) {
        return float((s >= 16 && s < 48 && t >= 16 && t < 48) || (has_left_rim && s < 16));
    };
    return with_material(
        mesh, material(AlphaMode::mask, texture(64, 64, alpha, TextureWrap::clamp, TextureWrap::clamp, true)));
}

} // namespace

// Against the card itself, in double.
TEST(TrimmedRays, RaysAreStoppedWhereTheCardIsOpaque)
{
    std::mt19937 random(41);
    std::uniform_real_distribution<double> uniform(-1.05, 1.05);
    std::normal_distribution<double> normal;
    int64_t stopped = 0, rim = 0;
    for (int scene = 0; scene < 200; ++scene) {
        const Mesh card = framed_card(random, scene % 2);
        const V3d corner = card.positions[0], x = (card.positions[1] - corner) * 0.5;
        const V3d y = (card.positions[3] - corner) * 0.5, middle = corner + x + y;
        Occluder occluder;
        std::string error;
        ASSERT_TRUE(occluder.build({ &card }, {}, 1, error)) << error;
        for (int packet = 0; packet < 100; ++packet) {
            std::array<V3f, kPacketSize> origins, directions;
            std::array<V2d, kPacketSize> at;
            std::array<double, kPacketSize> slope;
            std::array<float, kPacketSize> lengths;
            lengths.fill(kFarthest);
            for (size_t k = 0; k < kPacketSize; ++k) {
                V2d target(uniform(random), uniform(random));
                if (k % 4 == 0)
                    target.y = target.x; // where the triangles meet
                origins[k] = V3f(V3d(normal(random), normal(random), normal(random)).normalized() * 2);
                directions[k] = V3f((middle + x * target.x + y * target.y - V3d(origins[k])).normalized());
                const V3d d(directions[k]), n = x.cross(y);
                const V3d hit = V3d(origins[k]) + d * ((middle - V3d(origins[k])).dot(n) / d.dot(n)) - middle;
                at[k] = V2d(hit.dot(x) / x.length2(), hit.dot(y) / y.length2());
                slope[k] = n.length() / std::abs(d.dot(n));
            }
            const uint8_t blocked = occluder.find_blocked(origins.data(), directions.data(), kPacketSize, kFarthest);
            std::array<NearestHit, kPacketSize> nearest;
            occluder.find_nearest(origins.data(), directions.data(), lengths.data(), kPacketSize, nearest.data());
            for (size_t k = 0; k < kPacketSize; ++k) {
                const double inner = std::max(std::abs(at[k].x), std::abs(at[k].y)) - 0.5;
                const double outer = std::max(std::abs(at[k].x), std::abs(at[k].y)) - 1, left = at[k].x + 0.5;
                const bool is_rim = scene % 2 && outer < 0 && left < 0;
                if (std::min({ std::abs(inner), std::abs(outer), std::abs(left) }) < 1e-5)
                    continue; // at a border
                EXPECT_EQ(blocked >> k & 1, inner < 0 || is_rim) << scene << ": " << at[k];
                ASSERT_EQ(nearest[k].exists(), inner < 0 || is_rim) << scene << ": " << at[k];
                stopped += inner < 0;
                rim += is_rim;
                if (!nearest[k].exists())
                    continue;
                const auto& corners = card.triangles[nearest[k].triangle];
                const double u = nearest[k].u, v = nearest[k].v;
                const V3d point = card.positions[corners[0]] * (1 - u - v) + card.positions[corners[1]] * u
                    + card.positions[corners[2]] * v;
                EXPECT_LT((point - middle - x * at[k].x - y * at[k].y).length(), 1e-5 * slope[k]) << at[k];
                EXPECT_LT((V3d(origins[k]) + V3d(directions[k]) * nearest[k].distance - point).length(),
                          1e-5 * slope[k]);
            }
        }
    }
    EXPECT_GT(stopped, 20000);
    EXPECT_GT(rim, 10000);
}

TEST(TrimmedRays, MicromapsChangeNoBitOfASpot)
{
    // Pieces are so small that the rounding of their places counts.
    std::mt19937 random(8);
    std::normal_distribution<double> normal;
    int blocked = 0;
    for (int scene = 0; scene < 20; ++scene) {
        const int side = 1024, at = 100 + int(random() % 800), other = 100 + int(random() % 800);
        const auto spot = [&](int s, int t) { return float(std::hypot(s - at, t - other) < 6); };
        const Mesh mesh
            = with_material(card(1, 0), material(AlphaMode::mask, texture(side, side, spot, TextureWrap::clamp)));
        Occluder fast, slow;
        std::string error;
        ASSERT_TRUE(fast.build({ &mesh }, {}, 1, error)) << error;
        ASSERT_TRUE(slow.build({ &mesh }, {}, 1, error, CutoutMode::every_hit)) << error;
        const V3d middle(2 * (at + 0.5) / side - 1, 1 - 2 * (other + 0.5) / side, 0); // row 0 is the top
        for (int packet = 0; packet < 800; ++packet) {
            std::array<V3f, kPacketSize> origins, directions;
            for (size_t k = 0; k < kPacketSize; ++k) {
                const V3d target = middle + V3d(normal(random), normal(random), 0) * 0.01;
                origins[k] = V3f(normal(random), normal(random), 1);
                directions[k] = V3f((target - V3d(origins[k])).normalized());
            }
            const uint8_t a = fast.find_blocked(origins.data(), directions.data(), kPacketSize, kFarthest);
            const uint8_t b = slow.find_blocked(origins.data(), directions.data(), kPacketSize, kFarthest);
            EXPECT_EQ(a, b) << scene;
            blocked += __builtin_popcount(b);
        }
        EXPECT_LT(fast.cutout_work().lookups, fast.cutout_work().hits);
    }
    EXPECT_GT(blocked, 20000);
}

TEST(TrimmedRays, RaysThroughAnEmptyRimMeetNothing)
{
    std::mt19937 random(1);
    const Mesh card = framed_card(random, false);
    const V3d corner = card.positions[0], x = (card.positions[1] - corner) * 0.5;
    const V3d y = (card.positions[3] - corner) * 0.5, middle = corner + x + y, away = x.cross(y).normalized();
    Occluder occluder;
    std::string error;
    ASSERT_TRUE(occluder.build({ &card }, {}, 1, error)) << error;
    const auto is_blocked = [&](double s, double t) {
        std::array<V3f, kPacketSize> origins, directions;
        origins.fill(V3f(middle + x * s + y * t + away));
        directions.fill(V3f(-away));
        return occluder.find_blocked(origins.data(), directions.data(), 1, kFarthest) != 0;
    };
    for (int i = 0; i < 100; ++i) {
        const double along = -0.99 + 0.0198 * i;
        for (const double rim : { -0.9, -0.7, 0.7, 0.9 }) {
            EXPECT_FALSE(is_blocked(rim, along));
            EXPECT_FALSE(is_blocked(along, rim));
        }
    }
    EXPECT_EQ(occluder.cutout_work().hits, 0);
    EXPECT_TRUE(is_blocked(0.3, 0.3));
    EXPECT_TRUE(is_blocked(-0.3, 0.4));
    EXPECT_EQ(occluder.cutout_work().hits, 2);
}

TEST(TrimmedRays, NoRaySlipsThroughBesideAnOpaqueNeighbour)
{
    // A sheet whose right half is a cut-out: opaque where they meet, open to the right. With vertices of their own, and
    // shared, where no ray slips through however it grazes the sheet.
    for (const bool are_shared : { false, true }) {
        Mesh sheet;
        sheet.name = "sheet";
        scenes::add_quad(sheet, V3d(-1.1, -1, 0.3), V3d(0.1, -1, 0.2), V3d(0.1, 1, 0.2), V3d(-1.1, 1, 0.3), V2f(-1, 0),
                         V2f(0, 1));
        scenes::add_quad(sheet, V3d(0.1, -1, 0.2), V3d(1.1, -1, 0.3), V3d(1.1, 1, 0.3), V3d(0.1, 1, 0.2), V2f(0, 0),
                         V2f(1, 1));
        sheet = with_material(sheet, material(AlphaMode::mask, nullptr));
        auto opacity = std::make_shared<MeshOpacity>();
        opacity->materials = { MaterialOpacity(),
                               material(AlphaMode::mask,
                                        texture(
                                            64, 64, [](int s, int) { return float(s < 16); }, TextureWrap::clamp,
                                            TextureWrap::clamp)) };
        sheet.opacity = opacity;
        for (const size_t triangle : { 2, 3 }) {
            sheet.triangle_materials.set(triangle, 1);
            for (uint32_t& vertex : sheet.triangles[triangle])
                if (are_shared)
                    vertex = vertex == 4 ? 1 : vertex == 7 ? 2 : vertex;
        }
        Occluder occluder;
        std::string error;
        ASSERT_TRUE(occluder.build({ &sheet }, {}, 1, error)) << error;
        ASSERT_EQ(occluder.cutouts().mixed, 2);
        std::mt19937 random(3);
        std::uniform_real_distribution<double> uniform(-0.99, 0.99);
        int open = 0;
        for (int packet = 0; packet < 50000; ++packet) {
            std::array<V3f, kPacketSize> origins, directions;
            for (size_t k = 0; k < kPacketSize; ++k) {
                const double below = are_shared ? std::pow(10, -1.5 + 1.5 * uniform(random)) : 0.8;
                origins[k] = V3f(V3d(uniform(random), uniform(random), 0.2 - below));
                directions[k] = V3f((V3d(0.1, uniform(random), 0.2) - V3d(origins[k])).normalized());
            }
            open += __builtin_popcount(~occluder.find_blocked(origins.data(), directions.data(), kPacketSize, kFarthest)
                                       & 0xff);
        }
        EXPECT_EQ(open, 0) << are_shared;
    }
}
