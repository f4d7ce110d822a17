// SPDX-License-Identifier: Apache-2.0
// Effects that meet: suns over a ground and under a normal map; a normal map over a ground.
#include "baked_map.h"
#include "scenes.h"

#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/sun_visibility.h>

#include <OpenImageIO/imagebufalgo.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace vmlight;
using Imath::V3d;
using Imath::V3f;
using OIIO::ImageBuf;

namespace {

constexpr double kHalfAngle = 0.005;

Disc sun_at(double degrees_above_horizon)
{
    const double angle = degrees_above_horizon * M_PI / 180;
    return { V3d(0, std::sin(angle), std::cos(angle)), kHalfAngle };
}

NormalMapPointer leaning(const V3d& normal, const Mesh& mesh, Size size)
{
    ImageBuf image(OIIO::ImageSpec(2, 2, 3, OIIO::TypeDesc::FLOAT));
    OIIO::ImageBufAlgo::fill(image, { float(normal.x + 1) / 2, float(normal.y + 1) / 2, float(normal.z + 1) / 2 });
    auto map = std::make_shared<NormalMap>();
    std::vector<std::string> warnings;
    std::string error;
    EXPECT_TRUE(map->decode(image, {}, size, 1, warnings, error)) << error;
    map->attach(non_owning(mesh));
    return map;
}

// Of the middle of a square that faces +z.
float sun_seen(const Disc& disc, const VismapParams& params, const V3d& normal = V3d(0, 0, 1))
{
    const Mesh mesh = scenes::floor_facing_z(1);
    auto scene = std::make_shared<BakeScene>();
    std::string error;
    EXPECT_TRUE(scene->build(non_owning(mesh), {}, 1, error)) << error;
    SunTracer tracer;
    EXPECT_TRUE(tracer.prepare(scene, params, error, 1, {}, leaning(normal, mesh, params.size()))) << error;
    std::vector<float> seen;
    EXPECT_TRUE(tracer.trace(seen, { &disc, 1 }, 1));
    return seen[size_t(params.size().width) * 4 + 4];
}

} // namespace

TEST(EffectsTogether, TheGroundHidesSunsBelowItsHorizon)
{
    VismapParams params = map_params(8, 8, 4), over_ground = params;
    over_ground.ground = true;
    over_ground.ground_height = -5;
    for (const double degrees : { 30.0, 2.0 }) {
        EXPECT_NEAR(sun_seen(sun_at(degrees), params), std::cos(degrees * M_PI / 180), 1e-4);
        EXPECT_EQ(sun_seen(sun_at(degrees), over_ground), sun_seen(sun_at(degrees), params)) << degrees;
        EXPECT_NEAR(sun_seen(sun_at(-degrees), params), std::cos(degrees * M_PI / 180), 1e-4);
        EXPECT_EQ(sun_seen(sun_at(-degrees), over_ground), 0) << degrees;
    }
    over_ground.ground_height = 5; // the square is under it
    EXPECT_EQ(sun_seen(sun_at(30), over_ground), 0);
    // A ground that is farther than rays reach hides nothing.
    over_ground.ground_height = -5;
    over_ground.max_distance = 3;
    EXPECT_GT(sun_seen(sun_at(-30), over_ground), 0.8f);
}

TEST(EffectsTogether, SunsShineOnMappedNormals)
{
    const V3d normal = V3d(0, 0.6, 0.8);
    const Disc disc = sun_at(40);
    EXPECT_NEAR(sun_seen(disc, map_params(8, 8, 4), normal), normal.dot(disc.direction), 1e-4);
    // What the normal map turns away is dark, and so is what is behind the surface itself.
    EXPECT_EQ(sun_seen(sun_at(-60), map_params(8, 8, 4), normal), 0);
    EXPECT_EQ(sun_seen(sun_at(100), map_params(8, 8, 4), normal), 0);
}

TEST(EffectsTogether, AMappedNormalOverAGroundSeesWhatIsAboveBoth)
{
    // The square faces +z and leans up: above the ground and in front of the square is a quarter of all directions.
    const Mesh mesh = scenes::floor_facing_z(1);
    VismapParams params = map_params(8, 8, 4096);
    params.ground = true;
    params.ground_height = -5;
    const double lean = 0.6;
    const V3d normal(0, std::sin(lean), std::cos(lean));
    auto scene = std::make_shared<BakeScene>();
    std::string error;
    ASSERT_TRUE(scene->build(non_owning(mesh), {}, 1, error)) << error;
    ImageBuf image;
    ASSERT_TRUE(make_vismap(image, scene, params, nullptr, 1, {}, 0, leaning(normal, mesh, params.size())))
        << image.geterror();
    // (1/pi) Int of n.w over the wedge y > 0, z > 0: its moment is (1/2, 1/2) / 1 in y and z.
    EXPECT_NEAR(image.getchannel(4, 4, 0, 0), (normal.y + normal.z) / 2, 4e-3);
}
