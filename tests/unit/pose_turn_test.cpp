// SPDX-License-Identifier: Apache-2.0
// What a map has of a texel, turned with the surface.
#include "pose_scenes.h"

#include <vmlight/math/harmonics.h>
#include <vmlight/vismap/turned_texels.h>

#include <random>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

// Of the bands from the third on, in direction w.
double bands_at(const float* bands, int order, const V3d& w)
{
    const Harmonics harmonics(order);
    std::vector<float> values(size_t(harmonics.count()) * Harmonics::kLanes);
    const std::vector<float> x(Harmonics::kLanes, float(w.x)), y(Harmonics::kLanes, float(w.y)),
        z(Harmonics::kLanes, float(w.z));
    harmonics.evaluate(x.data(), y.data(), z.data(), values.data());
    double sum = 0;
    for (int k = 4; k < harmonics.count(); ++k)
        sum += double(bands[k - 4]) * double(values[size_t(k * Harmonics::kLanes)]);
    return sum;
}

} // namespace

TEST(PoseTurn, BandsTurnWithTheTexel)
{
    for (const int order : { 3, 5, 8 }) {
        VismapParams params;
        params.basis = "sh";
        params.order = order;
        params.channels = { "normal", "error", "coverage" };
        const Rotation turn = rotation_from_angles(33, -70, 120);
        std::mt19937 random(7);
        std::uniform_real_distribution<float> number(-0.3f, 0.3f);
        std::vector<float> from(size_t(4 + 3 + 1 + order * order - 4 + 1)), to(from.size());
        for (float& value : from)
            value = number(random);
        TexelTurn(params, turn).copy(from.data(), to.data());
        EXPECT_EQ(to[0], from[0]);
        EXPECT_EQ(to[7], from[7]); // error
        EXPECT_EQ(to.back(), from.back());
        for (const size_t at : { size_t(1), size_t(4) }) {
            const V3d before(from[at], from[at + 1], from[at + 2]), after(to[at], to[at + 1], to[at + 2]);
            EXPECT_LT((rotate(turn, before) - after).length(), 1e-6);
        }
        for (int i = 0; i < 50; ++i) {
            const V3d w = V3d { number(random), number(random), number(random) }.normalized();
            EXPECT_NEAR(bands_at(from.data() + 8, order, w), bands_at(to.data() + 8, order, rotate(turn, w)), 2e-5)
                << order;
        }
    }
}

TEST(PoseTurn, WhatCannotBeTurnedIsTracedAgain)
{
    const Rotation turn = rotation_from_angles(0, 30, 0);
    for (const char* basis : { "mask", "cells" })
        for (const double error : { 0.0, 0.01 }) {
            VismapParams params = pose_params(64, 32);
            params.basis = basis;
            PoseSequence sequence(error);
            bake_pose(sequence, scene_of(skin(0)), params, "a");
            // A shift turns nothing.
            const auto shifted = bake_pose(sequence, scene_of(moved(skin(0), Rotation(), V3d(4, 0, 1))), params, "b");
            EXPECT_EQ(shifted->report.rays, 0) << basis;
            const BakeScenePointer turned = scene_of(moved(skin(0), turn, V3d(0)));
            const auto traced = bake_pose(sequence, turned, params, "c");
            EXPECT_TRUE(traced->has_bytes_of(*bake_alone(turned, params))) << basis;
        }
}

TEST(PoseTurn, SunsStayWhereTheyAre)
{
    VismapParams params = pose_params(64, 32);
    params.sun_directions = "0.3,1,0.2,2";
    PoseSequence sequence(0.01);
    bake_pose(sequence, scene_of(skin(0)), params, "a");
    const BakeScenePointer turned = scene_of(moved(skin(0), rotation_from_angles(0, 30, 0), V3d(0)));
    EXPECT_TRUE(bake_pose(sequence, turned, params, "b")->has_bytes_of(*bake_alone(turned, params)));
}

TEST(PoseTurn, ASkyInHarmonicsLightsATurnedMeshAlike)
{
    VismapParams params = pose_params(48, 1024);
    params.basis = "sh";
    const Rotation turn = rotation_from_angles(15, 130, -40);
    PoseSequence sequence(0.01);
    bake_pose(sequence, scene_of(skin(0)), params, "a");
    const BakeScenePointer turned = scene_of(moved(skin(0), turn, V3d(0, 1, 0)));
    const auto kept = bake_pose(sequence, turned, params, "b");
    const auto whole = bake_alone(turned, params);
    EXPECT_EQ(kept->report.rays, 0);
    double squares = 0, values = 0;
    whole->each_covered([&](int x, int y) {
        for (int c = 0; c < 4 + 21; ++c, ++values)
            squares += std::pow(kept->at(x, y)[c] - whole->at(x, y)[c], 2);
    });
    EXPECT_LT(std::sqrt(squares / values), 0.01); // the noise of both
}
