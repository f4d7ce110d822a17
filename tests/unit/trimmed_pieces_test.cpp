// SPDX-License-Identifier: Apache-2.0
// Cut-out triangles that are traced as smaller ones: what is left of them.
#include "cutout_scene.h"

#include <vmlight/trace/trimmed_pieces.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

using namespace vmlight;
using namespace vmlight::cutout_scene;

namespace {

using Corners = std::array<V3f, 3>;

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
