// SPDX-License-Identifier: Apache-2.0
// Poses over the ground: texels that go under it, or lean over it, are not those that they were.
#include "pose_scenes.h"

#include <vmlight/uv/raster.h>
#include <vmlight/vismap/pose_ground.h>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

constexpr double kGroundError = 0.01;

} // namespace

TEST(PoseSequence, TexelsThatGoUnderGroundAreBakedAgain)
{
    VismapParams params = pose_params(256, 64);
    params.ground = true;
    params.ground_height = 0;
    // A wall before a lawn sinks by more than a row of texels, which probes may miss.
    const auto wall = [](double sunk) {
        Mesh mesh;
        const auto flat = [](V3d corner, V3d along, V3d up) {
            return [=](double u, double v) { return corner + along * u + up * v; };
        };
        add_sheet(mesh, 16, 16, flat(V3d(-8, 0.5, -8), V3d(16, 0, 0), V3d(0, 0, -16)), V2f(0.01f, 0.01f),
                  V2f(0.99f, 0.48f));
        add_sheet(mesh, 16, 4, flat(V3d(-8, -0.002 - sunk, -8), V3d(16, 0, 0), V3d(0, 4, 0)), V2f(0.01f, 0.52f),
                  V2f(0.99f, 0.98f));
        return mesh;
    };
    const auto whole = bake_alone(scene_of(wall(0.05)), params);
    for (const double error : { 0.0, 0.02 }) {
        PoseSequence sequence(error);
        const auto base = bake_pose(sequence, scene_of(wall(0)), params, "a");
        const auto kept = bake_pose(sequence, scene_of(wall(0.05)), params, "b");
        int sunk = 0, wrong = 0;
        kept->each_covered([&](int x, int y) {
            const bool sinks = whole->at(x, y)[0] == 0 && base->at(x, y)[0] > 0;
            sunk += sinks;
            wrong += sinks && kept->at(x, y)[0] > 0;
        });
        EXPECT_GT(sunk, 200);
        EXPECT_EQ(wrong, 0) << error;
        EXPECT_TRUE(error == 0 || kept->pose.kept > kept->pose.covered / 4);
    }
}

TEST(PoseSequence, AFaceOnTheGroundThatSinksByLessThanRaysResolveIsUnderIt)
{
    VismapParams params = pose_params(96, 32);
    params.ground = true;
    params.ground_height = 0;
    const Mesh sunk = moved(door(0), Rotation(), V3d(0, -std::ldexp(1.0, -16), 0));
    const auto whole = bake_alone(scene_of(sunk), params);
    for (const double error : { 0.0, kGroundError }) {
        PoseSequence sequence(error);
        const auto base = bake_pose(sequence, scene_of(door(0)), params, "a");
        const auto kept = bake_pose(sequence, scene_of(sunk), params, "b");
        EXPECT_GT(share_beyond(*base, *whole, 0.5), 0.5);
        EXPECT_EQ(share_beyond(*kept, *whole, kGroundError), 0) << error;
    }
}

TEST(PoseSequence, AFewTrianglesThatLeanOverTheGroundAreBakedAgain)
{
    VismapParams params = pose_params(256, 64);
    params.ground = true;
    params.ground_height = -1;
    // One shingle of a wall leans: it covers four texels between probes.
    const auto shingled = [](double lean) {
        Mesh mesh;
        const auto flat = [](V3d corner, V3d along, V3d up) {
            return [=](double u, double v) { return corner + along * u + up * v; };
        };
        add_sheet(mesh, 60, 60, flat(V3d(-8, 0, 0), V3d(16, 0, 0), V3d(0, 16, 0)), V2f(0.01f, 0.01f),
                  V2f(0.99f, 0.99f));
        for (int i = 0; i < 12; ++i)
            mesh.positions[size_t(61 * (3 + 5 * i) + 3 + 4 * i)].z += lean;
        return mesh;
    };
    const BakeScenePointer upright = scene_of(shingled(0)), leaning = scene_of(shingled(0.05));
    const auto whole = bake_alone(leaning, params);
    PoseSequence sequence(kGroundError);
    bake_pose(sequence, upright, params, "a");
    const auto kept = bake_pose(sequence, leaning, params, "b");
    const PoseMotion motion(*upright, *leaning);
    const PoseGround ground(motion, params, kGroundError);
    const auto cover = std::make_unique<TileCover>();
    const UvRaster raster(leaning->mesh(), 256, 256);
    int leans = 0;
    for (int tile = 0; tile < 16; ++tile) {
        raster.cover(tile, *cover);
        for (size_t i = 0; i < cover->triangle.size(); ++i) {
            if (cover->triangle[i] == TileCover::kNone || ground.keeps(cover->triangle[i]) == PoseGround::all)
                continue;
            const int x = tile % 4 * kTileSize + int(i % kTileSize), y = tile / 4 * kTileSize + int(i / kTileSize);
            EXPECT_EQ(kept->at(x, y)[0], whole->at(x, y)[0]) << x << " " << y;
            ++leans;
        }
    }
    EXPECT_GT(leans, 100);
    EXPECT_LT(leans, 3000);
}
