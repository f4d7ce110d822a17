// SPDX-License-Identifier: Apache-2.0
// Bounced light of what few rays meet, or none of a texel.
#include "bounced_map.h"

#include <vmlight/reference/reference.h>

#include <OpenImageIO/imagebufalgo.h>

using namespace vmlight;
using namespace vmlight::scenes;

// It fills some .4 % of the hemisphere: most texels have no ray that meets it, and many have V = 1.
TEST(LightTransport, SmallFarThingsSendAllTheirLight)
{
    const Mesh floor = floor_facing_z(1);
    const Mesh lamp = rectangle(V3d(-0.2, -0.2, 3), V3d(0.4, 0, 0), V3d(0, 0.4, 0));
    for (const int samples : { 16, 128, 1024 }) {
        VismapParams map = bounce_map_of(64);
        map.samples = samples;
        const Bounced bounced(floor, { lamp }, map);
        const std::vector<float> light = bounced.gather(1);
        double sum = 0, hidden = 0;
        for (size_t i = 0; i < 64 * 64; ++i) {
            sum += double(light[3 * i]);
            hidden += 1 - double(bounced.visibility[i]);
        }
        // The lamp's underside sees the floor, and past it a sky of 1; the floor is nearly as bright as that.
        oracle::Bounce truth({ floor, lamp }, constant_sky, [](size_t) { return 1.0; });
        double wanted = 0;
        for (int y = 0; y < 5; ++y)
            for (int x = 0; x < 5; ++x)
                wanted += truth.bounced(V3d(0.4 * x - 0.8, 0.4 * y - 0.8, 0), V3d(0, 0, 1), 100, 8) / 25;
        EXPECT_NEAR(sum / (64 * 64), wanted, 0.1 * wanted) << samples << ": hidden " << hidden / (64 * 64);
    }
}

TEST(LightTransport, AFaceThatLiesOnTheGroundGetsNothingFromIt)
{
    Mesh mesh;
    add_quad(mesh, V3d(-1, 0, -1), V3d(1, 0, -1), V3d(1, 0, 1), V3d(-1, 0, 1), V2f(0, 0), V2f(1, 1));
    ASSERT_LT(surface_normal(mesh, mesh.triangles[0]).y, 0);
    VismapParams map = bounce_map_of(32);
    map.ground = true;
    TransportParams params;
    params.ground = true;
    const Bounced bounced(mesh, {}, map, params);
    for (const float v : bounced.visibility)
        ASSERT_EQ(v, 0);
    for (const float value : bounced.gather(1))
        ASSERT_EQ(value, 0);
}

// A roof over a ramp: too far from the floor to occlude it, and in the way of the light that the ramp sends to it.
TEST(LightTransport, WhatNoTexelMeetsShadesWhatLightsThem)
{
    const Mesh floor = floor_facing_z(1);
    const std::vector<Mesh> occluders { rectangle(V3d(1, -1, 0.05), V3d(0.9, 0, 0.85), V3d(0, 2, 0)),
                                        rectangle(V3d(0.5, -2, 1.1), V3d(2, 0, 0), V3d(0, 4, 0)) };
    VismapParams map = bounce_map_of(32);
    map.max_distance = 1;
    std::string error;
    BakeScene culled;
    ASSERT_TRUE(culled.build(non_owning(floor), occluders, 0, error, SceneChoice::within(1))) << error;
    ASSERT_EQ(culled.reach()[1].verdict, CasterReach::too_far);
    LightTransport transport;
    EXPECT_FALSE(transport.prepare(BakeScenePointer(BakeScenePointer(), &culled), map, {}, {}, error));
    EXPECT_NE(error.find("is not in the scene, and may shade what sends light"), std::string::npos) << error;

    std::vector<Mesh> all { floor };
    all.insert(all.end(), occluders.begin(), occluders.end());
    const oracle::Bounce truth(
        all, constant_sky, [](size_t) { return 1.0; }, 1);
    const std::vector<float> light = Bounced(floor, occluders, map).gather(1);
    EXPECT_LT(error_of(light, oracle::places(floor, 32, 32), truth, 13), 0.15); // of a small part of the floor
    // The reference builds its own scene.
    OIIO::ImageBuf sky(OIIO::ImageSpec(4, 2, 3, OIIO::TypeFloat)), direct, traced;
    OIIO::ImageBufAlgo::fill(sky, { 1.0f, 1.0f, 1.0f });
    ReferenceParams params;
    params.samples = 512;
    ASSERT_TRUE(make_reference(direct, floor, occluders, sky, map, {}, params)) << direct.geterror();
    params.bounce_albedo = 1;
    ASSERT_TRUE(make_reference(traced, floor, occluders, sky, map, {}, params)) << traced.geterror();
    double ours = 0, theirs = 0;
    for (OIIO::ImageBuf::ConstIterator<float> all_light(traced), of_sky(direct); !all_light.done();
         ++all_light, ++of_sky) {
        theirs += double(all_light[0]) - double(of_sky[0]);
        ours += double(light[3 * size_t(all_light.y() * 32 + all_light.x())]);
    }
    EXPECT_NEAR(ours, theirs, 0.04 * theirs);
}
