// SPDX-License-Identifier: Apache-2.0
// Cut-out triangles that are traced as smaller ones: what is left of them, and the rays that meet it.
#include "cutout_scene.h"

#include <vmlight/trace/occluder.h>
#include <vmlight/trace/trimmed_pieces.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

using namespace vmlight;
using namespace vmlight::cutout_scene;

namespace {

using Corners = std::array<V3f, 3>;

constexpr float kFarthest = std::numeric_limits<float>::infinity();

V3d point_of(const Corners& corners, double u, double v)
{
    return V3d(corners[0]) * (1 - u - v) + V3d(corners[1]) * u + V3d(corners[2]) * v;
}

// The weights of a point of a triangle's plane.
V2d weights_at(const Corners& corners, const V3d& point)
{
    const V3d a(corners[0]), x = V3d(corners[1]) - a, y = V3d(corners[2]) - a, normal = x.cross(y);
    return { (point - a).cross(y).dot(normal) / normal.length2(), x.cross(point - a).dot(normal) / normal.length2() };
}

double depth(const V2d& weights)
{
    return std::min({ weights.x, weights.y, 1 - weights.x - weights.y });
}

// A card and the pieces in place of its two triangles, of which a square part of the card stops light.
struct Pieces
{
    Pieces(const std::array<V3f, 4>& card, double low, double high, int turn = 0)
    {
        // With each corner of a triangle first, in turn.
        const std::array<uint32_t, 3> a { 0, 1, 2 }, b { 0, 2, 3 };
        const std::array<V2d, 4> st { V2d(0, 0), V2d(1, 0), V2d(1, 1), V2d(0, 1) };
        for (const auto& triangle : { a, b }) {
            std::array<uint32_t, 3> turned;
            Corners corners;
            WeightRange range { { 1, 1, 1 }, { 0, 0, 0 } };
            for (size_t k = 0; k < 3; ++k) {
                turned[k] = triangle[(k + size_t(turn)) % 3];
                corners[k] = card[turned[k]];
            }
            for (int i = 0; i <= 64; ++i)
                for (int j = 0; i + j <= 64; ++j) {
                    const std::array<double, 3> weights { 1 - (i + j) / 64.0, i / 64.0, j / 64.0 };
                    V2d at(0);
                    for (size_t k = 0; k < 3; ++k)
                        at += st[turned[k]] * weights[k];
                    if (std::min(at.x, at.y) < low || std::max(at.x, at.y) > high)
                        continue;
                    for (size_t k = 0; k < 3; ++k) {
                        range.least[k] = std::min(range.least[k], float(weights[k]));
                        range.most[k] = std::max(range.most[k], float(weights[k]));
                    }
                }
            triangles.push_back(turned);
            whole.push_back(corners);
            ranges.push_back(range);
        }
        trim();
    }

    void trim()
    {
        std::vector<uint8_t> uses(16, 0);
        for (const auto& triangle : triangles)
            for (const uint32_t vertex : triangle)
                ++uses[vertex];
        trimmed = whole;
        pieces = trim_triangles(trimmed.data(), triangles, uses, [this](size_t i) { return ranges[i]; });
    }

    // The area of both pieces, of the triangles' area.
    double share() const
    {
        double all = 0, left = 0;
        for (size_t i = 0; i < 2; ++i) {
            all += (whole[i][1] - whole[i][0]).cross(whole[i][2] - whole[i][0]).length();
            left += (trimmed[i][1] - trimmed[i][0]).cross(trimmed[i][2] - trimmed[i][0]).length();
        }
        return left / all;
    }

    std::vector<std::array<uint32_t, 3>> triangles;
    std::vector<Corners> whole, trimmed;
    std::vector<WeightRange> ranges;
    std::vector<TrimmedPiece> pieces;
};

const std::array<V3f, 4> kCard { V3f(-0.5f, -0.2f, 0.1f), V3f(0.3f, -0.3f, 0.2f), V3f(0.4f, 0.4f, -0.1f),
                                 V3f(-0.4f, 0.5f, -0.2f) }; // a parallelogram

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

TEST(TrimmedPieces, KnowWhereTheyAreInTheirTriangles)
{
    for (int turn = 0; turn < 3; ++turn)
        for (const auto& [low, high] : { std::pair(0.25, 0.75), { 0.0, 0.75 }, { 0.25, 1.0 }, { 0.6, 0.7 } }) {
            const Pieces all(kCard, low, high, turn);
            for (size_t i = 0; i < 2; ++i) {
                const TrimmedPiece& piece = all.pieces[i];
                ASSERT_TRUE(piece.is_trimmed) << turn << ", " << low;
                ASSERT_EQ(piece.partner, 1 - i) << turn << ", " << low;
                for (const V2f& at : { V2f(0, 0), V2f(1, 0), V2f(0, 1), V2f(0.3f, 0.2f) }) {
                    const V3d point = point_of(all.trimmed[i], at.x, at.y);
                    const V2f own = piece.own.at(at.x, at.y), beside = piece.of_partner.at(at.x, at.y);
                    EXPECT_LT((point_of(all.whole[i], own.x, own.y) - point).length(), 1e-6) << turn;
                    EXPECT_LT((point_of(all.whole[1 - i], beside.x, beside.y) - point).length(), 1e-6) << turn;
                    const auto [triangle, weights] = piece.whole(uint32_t(i), at.x, at.y);
                    EXPECT_LT((point_of(all.whole[triangle], weights.x, weights.y) - point).length(), 1e-5) << turn;
                }
            }
            EXPECT_NEAR(all.share(), (high - low) * (high - low), 0.01) << low << ", " << high;
        }
}

TEST(TrimmedPieces, HaveAllThatStopsLight)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform;
    for (int turn = 0; turn < 3; ++turn)
        for (int i = 0; i < 300; ++i) {
            const double low = double(random() % 60) / 64, high = low + double(1 + random() % 4) / 64;
            const Pieces all(kCard, low, high, turn);
            const double s = low + uniform(random) * (high - low), t = low + uniform(random) * (high - low);
            const V3d point = V3d(kCard[0]) + V3d(kCard[1] - kCard[0]) * s + V3d(kCard[3] - kCard[0]) * t;
            EXPECT_GT(std::max(depth(weights_at(all.trimmed[0], point)), depth(weights_at(all.trimmed[1], point))),
                      -1e-5)
                << low << ", " << high << ": " << s << ", " << t;
        }
}

TEST(TrimmedPieces, TrianglesThatAreNoCardAreTrimmedAlone)
{
    const auto expect_alone = [](const std::array<V3f, 4>& card, const char* why) {
        Pieces all(card, 0.4, 0.6);
        for (size_t i = 0; i < 2; ++i)
            EXPECT_FALSE(all.pieces[i].is_trimmed) << why << ": rays would slip through where its triangles meet";
        for (uint32_t& vertex : all.triangles[1])
            vertex += 8;
        all.trim();
        for (size_t i = 0; i < 2; ++i) {
            EXPECT_EQ(all.pieces[i].partner, TrimmedPiece::kAlone) << why;
            EXPECT_TRUE(all.pieces[i].is_trimmed) << why;
            for (const V2f& at : { V2f(0, 0), V2f(1, 0), V2f(0, 1) }) {
                const V2f own = all.pieces[i].own.at(at.x, at.y);
                EXPECT_LT((point_of(all.whole[i], own.x, own.y) - point_of(all.trimmed[i], at.x, at.y)).length(), 1e-6);
            }
        }
    };
    std::array<V3f, 4> bent = kCard, kite = kCard;
    bent[2] += V3f(0.001f, 0.002f, 0.003f);
    kite[2] = kCard[0] + (kCard[2] - kCard[0]) * 1.2f;
    expect_alone(bent, "bent");
    expect_alone(kite, "a kite");
    // One that is turned over: its pieces would face the other way.
    Pieces over(kCard, 0.4, 0.6);
    std::swap(over.triangles[1][0], over.triangles[1][1]);
    std::swap(over.whole[1][0], over.whole[1][1]);
    std::swap(over.ranges[1].least[0], over.ranges[1].least[1]);
    std::swap(over.ranges[1].most[0], over.ranges[1].most[1]);
    over.trim();
    EXPECT_EQ(over.pieces[0].partner, TrimmedPiece::kAlone);
}

TEST(TrimmedPieces, WhatDoesNotPayOrHasNoAreaStaysAsItIs)
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::array<V3f, 4> line { V3f(0, 0, 0), V3f(1, 0, 0), V3f(1, 0, 0), V3f(0, 0, 0) }, broken = kCard;
    broken[2].x = nan;
    for (const Pieces& all :
         { Pieces(kCard, 0, 1), Pieces(kCard, 0.01, 0.99), Pieces(line, 0.4, 0.6), Pieces(broken, 0.4, 0.6) })
        for (size_t i = 0; i < 2; ++i) {
            EXPECT_FALSE(all.pieces[i].is_trimmed);
            EXPECT_EQ(std::memcmp(&all.trimmed[i], &all.whole[i], sizeof(Corners)), 0);
            EXPECT_EQ(all.pieces[i].whole(uint32_t(i), 0.3f, 0.4f), std::pair(uint32_t(i), V2f(0.3f, 0.4f)));
        }
    EXPECT_TRUE(trim_triangles(nullptr, {}, {}, {}).empty());
}

// Against the card itself, in double.
TEST(TrimmedPieces, RaysAreStoppedWhereTheCardIsOpaque)
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
                const Corners triangle { V3f(card.positions[corners[0]]), V3f(card.positions[corners[1]]),
                                         V3f(card.positions[corners[2]]) };
                const V3d point = point_of(triangle, nearest[k].u, nearest[k].v);
                EXPECT_LT((point - middle - x * at[k].x - y * at[k].y).length(), 1e-5 * slope[k]) << at[k];
                EXPECT_LT((V3d(origins[k]) + V3d(directions[k]) * nearest[k].distance - point).length(),
                          1e-5 * slope[k]);
            }
        }
    }
    EXPECT_GT(stopped, 20000);
    EXPECT_GT(rim, 10000);
}

TEST(TrimmedPieces, MicromapsChangeNoBitOfASpot)
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

TEST(TrimmedPieces, RaysThroughAnEmptyRimMeetNothing)
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

TEST(TrimmedPieces, NoRaySlipsThroughBesideAnOpaqueNeighbour)
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
