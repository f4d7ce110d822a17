// SPDX-License-Identifier: Apache-2.0
// Bounced light against closed forms and brute force.
#include "bounced_map.h"
#include "cases.h"

#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/reference/reference.h>

#include <OpenImageIO/imagebufalgo.h>

using namespace vmlight;
using namespace vmlight::scenes;

// Radiosity in two dimensions: what a strip sees of another that stands on its edge.
TEST(LightTransport, AWhiteCornerLightsItself)
{
    const int side = 64;
    const Bounced bounced(corner(), {}, bounce_map_of(side));
    const std::vector<float> light = bounced.gather(1);
    const auto hidden = [](double x) { return 0.5 * (1 - x / std::sqrt(x * x + 1)); };
    double squares = 0, bias = 0, all = 0;
    int count = 0;
    for (int y = side / 2 - 4; y < side / 2 + 4; ++y)
        for (int x = 0; x < side; ++x, ++count) {
            const double at = (x % (side / 2) + 0.5) / (side / 2);
            double wanted = 0;
            constexpr int n = 4000;
            for (int i = 0; i < n; ++i) {
                const double h = (i + 0.5) / n;
                wanted += (1 - hidden(h)) * 0.5 * at * h / std::pow(at * at + h * h, 1.5) / n;
            }
            const size_t texel = size_t(y * side + x);
            const double error = double(light[3 * texel]) - wanted;
            squares += error * error;
            bias += error;
            all += 1 - hidden(at) + wanted;
            EXPECT_NEAR(light[3 * texel], wanted, 0.03) << x;
        }
    EXPECT_LT(std::sqrt(squares / count), 0.01 * all / count);
    EXPECT_NEAR(bias / count, 0, 0.003 * all / count);
}

// The first term of the geometric series: rho of what the wall itself sends out.
TEST(LightTransport, AFurnaceGivesTheFirstTermOfItsSeries)
{
    const Mesh wall = sphere(V3d(0), 1, 16, true);
    const Bounced bounced(wall, {}, bounce_map_of(64));
    const std::vector<oracle::Place> places = oracle::places(wall, 64, 64);
    for (const float v : bounced.visibility)
        ASSERT_EQ(v, 0);
    for (const float rho : { 0.0f, 0.25f, 1.0f, 3.0f }) {
        std::vector<float> light;
        ASSERT_TRUE(bounced.transport.gather(light, std::vector<float>(3 * 64 * 64, rho),
                                             std::vector<float>(3 * bounced.transport.points().size(), rho)));
        for (size_t i = 0; i < places.size(); ++i)
            ASSERT_NEAR(light[3 * i], places[i].exists ? rho : 0, 1e-5f * rho);
    }
}

TEST(LightTransport, OccludersLightWhatTheyHide)
{
    const Mesh floor = floor_facing_z(1);
    const Mesh shelf = rectangle(V3d(-0.6, -0.7, 0.5), V3d(1.1, 0, 0.2), V3d(0, 1.2, 0));
    const Bounced bounced(floor, { shelf }, bounce_map_of(32));
    EXPECT_FALSE(bounced.transport.points().empty());
    for (const LightPoint& point : bounced.transport.points())
        ASSERT_EQ(point.caster, 0);
    const std::vector<float> light = bounced.gather(0.5f, [](const LightPoint&) { return 0.8f; });
    const oracle::Bounce truth({ floor, shelf }, constant_sky, [](size_t t) { return t < 2 ? 0.5 : 0.8; });
    EXPECT_LT(error_of(light, oracle::places(floor, 32, 32), truth, 13), kRmsOfBounce);
}

TEST(LightTransport, TheBackOfASheetHasItsOwnLight)
{
    Mesh mesh;
    add_quad(mesh, V3d(-1, -1, 0), V3d(1, -1, 0), V3d(1, 1, 0), V3d(-1, 1, 0), V2f(0, 0), V2f(0.48f, 1));
    add_quad(mesh, V3d(-0.8, -0.6, 0.4), V3d(0.7, -0.6, 0.8), V3d(0.7, 0.6, 0.8), V3d(-0.8, 0.6, 0.4), V2f(0.52f, 0),
             V2f(1, 1));
    const Bounced bounced(mesh, {}, bounce_map_of(64, 32));
    const std::vector<float> light = bounced.gather(0.6f);
    const oracle::Bounce truth({ mesh }, constant_sky, [](size_t) { return 0.6; });
    EXPECT_LT(error_of(light, oracle::places(mesh, 64, 32), truth, 29), kRmsOfBounce);
}

TEST(LightTransport, TheGroundReflectsAsAMeshOfIt)
{
    // The analytic ground is level in y.
    Mesh mesh;
    add_quad(mesh, V3d(-1, 0, 0), V3d(1, 0, 0), V3d(1, 2, 0), V3d(-1, 2, 0), V2f(0, 0), V2f(1, 1));
    VismapParams map = bounce_map_of(32);
    map.ground = true;
    TransportParams params;
    const Bounced black(mesh, {}, map, params);
    for (const float value : black.gather(0.5f))
        ASSERT_EQ(value, 0);
    params.ground = true;
    const Bounced bounced(mesh, {}, map, params);
    const std::vector<float> light = bounced.gather(0.5f, [](const LightPoint& point) {
        EXPECT_EQ(point.caster, LightPoint::kGround);
        return 0.4f;
    });
    const Mesh ground = rectangle(V3d(-1e4, 0, -1e4), V3d(2e4, 0, 0), V3d(0, 0, 2e4));
    const oracle::Bounce truth({ mesh, ground }, constant_sky, [](size_t t) { return t < 2 ? 0.5 : 0.4; });
    EXPECT_LT(error_of(light, oracle::places(mesh, 32, 32), truth, 13), kRmsOfBounce);
}

TEST(LightTransport, WhatIsTooFarToOccludeSendsNothing)
{
    VismapParams map = bounce_map_of(32);
    map.max_distance = 0.3;
    const Bounced bounced(corner(), {}, map);
    const oracle::Bounce truth(
        { corner() }, constant_sky, [](size_t) { return 1.0; }, 0.3);
    std::vector<oracle::Place> middle = oracle::places(corner(), 32, 32);
    EXPECT_LT(error_of(bounced.gather(1), middle, truth, 13), kRmsOfBounce);
}

// The cow: smooth, with many islands, small triangles, and one half the mirror image of the other.
TEST(LightTransport, ACowIsLitAsThePathTracerHasIt)
{
    Mesh cow;
    std::string error;
    ASSERT_TRUE(read_mesh(cow, VMLIGHT_TEST_DATA "/spot.obj", {}, error)) << error;
    const Mesh ground = rectangle(V3d(-3, -0.75, 3), V3d(6, 0, 0), V3d(0, 0, -6));
    const int side = 64;
    const VismapParams map = bounce_map_of(side);
    const Bounced bounced(cow, { ground }, map);
    const std::vector<float> light = bounced.gather(0.7f);
    OIIO::ImageBuf sky(OIIO::ImageSpec(4, 2, 3, OIIO::TypeFloat)), traced;
    OIIO::ImageBufAlgo::fill(sky, { 1.0f, 1.0f, 1.0f });
    ReferenceParams params;
    params.samples = cases(256, 64);
    params.bounce_albedo = 0.7;
    ASSERT_TRUE(make_reference(traced, cow, { ground }, sky, map, {}, params)) << traced.geterror();
    double squares = 0, noise = 0, bias = 0, sum = 0, added = 0, count = 0;
    for (OIIO::ImageBuf::ConstIterator<float> truth(traced); !truth.done(); ++truth) {
        if (truth[6] == 0)
            continue;
        const size_t texel = size_t(truth.y() * side + truth.x());
        const double wrong = double(bounced.visibility[texel]) + double(light[3 * texel]) - double(truth[0]);
        squares += wrong * wrong;
        noise += double(truth[3]) * double(truth[3]);
        bias += wrong;
        added += double(light[3 * texel]);
        sum += double(truth[0]);
        ++count;
    }
    EXPECT_GT(added, 0.1 * sum);
    EXPECT_NEAR(bias, 0, 0.003 * sum);
    EXPECT_LT(std::sqrt(std::max(0.0, squares - noise) / count), 0.01 * sum / count)
        << squares / count << " " << noise / count;
}

TEST(LightTransport, MirroredUvsBounceToo)
{
    // Two walls of a ditch share their texels: the first has them.
    Mesh mesh;
    add_quad(mesh, V3d(0, -20, 0), V3d(1, -20, 0), V3d(1, 20, 0), V3d(0, 20, 0), V2f(0, 0), V2f(0.5f, 1));
    add_quad(mesh, V3d(0, 20, 0), V3d(0, 20, 1), V3d(0, -20, 1), V3d(0, -20, 0), V2f(0.5f, 0), V2f(1, 1));
    add_quad(mesh, V3d(1, -20, 0), V3d(1, -20, 1), V3d(1, 20, 1), V3d(1, 20, 0), V2f(0.5f, 1), V2f(1, 0));
    const Bounced bounced(mesh, {}, bounce_map_of(32));
    const oracle::Bounce truth({ mesh }, constant_sky, [](size_t) { return 0.5; });
    EXPECT_LT(error_of(bounced.gather(0.5f), oracle::places(mesh, 32, 32), truth, 13), kRmsOfBounce);
}
