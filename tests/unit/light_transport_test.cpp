// SPDX-License-Identifier: Apache-2.0
// Bounced light against closed forms and brute force.
#include "bounce_oracle.h"
#include "scenes.h"

#include <vmlight/base/work_counts.h>
#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/reference/reference.h>
#include <vmlight/vismap/light_transport.h>
#include <vmlight/vismap/point_visibility.h>

#include <OpenImageIO/imagebufalgo.h>

#include <gtest/gtest.h>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

VismapParams bounce_map_of(int width, int height = 0)
{
    VismapParams map;
    map.resolution = { width, height ? height : width };
    map.margin = 0;
    map.samples = 1024;
    return map;
}

// A map of a scene lit by a sky of 1, of which V is the light, and what bounces.
class Bounced
{
public:
    Bounced(const Mesh& mesh, const std::vector<Mesh>& occluders, const VismapParams& the_map,
            TransportParams params = {}, int nthreads = 0)
        : map(the_map)
        , m_nthreads(nthreads)
    {
        std::string error;
        OIIO::ImageBuf image;
        auto built = std::make_shared<BakeScene>();
        SceneChoice choice = SceneChoice::within(map.max_distance);
        choice.cull = false;
        EXPECT_TRUE(built->build(std::make_shared<Mesh>(mesh), occluders, nthreads, error, choice)) << error;
        scene = built;
        EXPECT_TRUE(make_vismap(image, mesh, occluders, map, nullptr, nthreads)) << image.geterror();
        visibility.resize(size_t(image.spec().image_pixels()));
        OIIO::ROI first = image.roi();
        first.chend = 1;
        EXPECT_TRUE(image.get_pixels(first, OIIO::TypeFloat, visibility.data()));
        EXPECT_TRUE(transport.prepare(scene, map, visibility, params, error, nthreads)) << error;
    }

    // With `albedo` of the map, and of each of the points off it.
    std::vector<float> gather(float albedo, const std::function<float(const LightPoint&)>& of_point = {}) const
    {
        std::vector<float> own, baked, points, light;
        for (const float v : visibility)
            own.insert(own.end(), 3, albedo * v);
        EXPECT_TRUE(bake_points(baked, *scene, map, transport.surfaces(), m_nthreads));
        const size_t channels = point_channels(map).size();
        for (size_t i = 0; i < transport.points().size(); ++i)
            points.insert(points.end(), 3, (of_point ? of_point(transport.points()[i]) : albedo) * baked[i * channels]);
        EXPECT_TRUE(transport.gather(light, own, points, m_nthreads));
        return light;
    }

    VismapParams map;
    BakeScenePointer scene;
    std::vector<float> visibility;
    LightTransport transport;

private:
    int m_nthreads;
};

// A floor and a wall, each 1 wide and 80 long, that meet at a right angle.
Mesh corner()
{
    Mesh mesh;
    mesh.name = "corner";
    add_quad(mesh, V3d(0, -40, 0), V3d(1, -40, 0), V3d(1, 40, 0), V3d(0, 40, 0), V2f(0, 0), V2f(0.5f, 1));
    add_quad(mesh, V3d(0, 40, 0), V3d(0, 40, 1), V3d(0, -40, 1), V3d(0, -40, 0), V2f(0.5f, 0), V2f(1, 1));
    return mesh;
}

// Root mean square of what the oracle and the library differ by, relative to the mean of the bounced light.
double error_of(const std::vector<float>& light, const std::vector<oracle::Place>& places, oracle::Bounce truth,
                int step)
{
    double squares = 0, all = 0, count = 0;
    for (size_t i = 0; i < places.size(); i += size_t(step)) {
        if (!places[i].exists)
            continue;
        const double wanted = truth.bounced(places[i].position, places[i].normal, 28, 6);
        squares += std::pow(double(light[3 * i]) - wanted, 2);
        all += wanted;
        ++count;
    }
    EXPECT_GT(count, 50);
    return std::sqrt(squares / count) / (all / count);
}

// Of error_of(): 64 rays a texel, and the noise of the oracle.
constexpr double kRmsOfBounce = 0.08;

double constant_sky(const V3d&)
{
    return 1;
}

} // namespace

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

TEST(LightTransport, WhereNothingIsInTheWayNoRayIsTraced)
{
    const int64_t before = work_counts().bounce_rays;
    for (const Mesh& mesh : { floor_facing_z(1), box(V3d(-1), V3d(1), false) }) {
        const Bounced bounced(mesh, {}, bounce_map_of(32));
        EXPECT_EQ(bounced.transport.rays(), 0);
        EXPECT_TRUE(bounced.transport.points().empty());
        for (const float value : bounced.gather(1))
            ASSERT_EQ(value, 0);
    }
    EXPECT_EQ(work_counts().bounce_rays, before);
}

TEST(LightTransport, OtherLightNeedsNoRay)
{
    const Bounced bounced(corner(), { rectangle(V3d(0.2, -40, 0.5), V3d(0, 80, 0), V3d(0.3, 0, 0.1)) },
                          bounce_map_of(32));
    EXPECT_TRUE(bounced.transport.is_kept());
    EXPECT_GT(bounced.transport.rays(), 0);
    const int64_t before = work_counts().bounce_rays;
    const std::vector<float> once = bounced.gather(1), half = bounced.gather(0.5f);
    EXPECT_EQ(work_counts().bounce_rays, before);
    for (size_t i = 0; i < once.size(); ++i)
        ASSERT_NEAR(half[i], 0.5f * once[i], 1e-6f);
}

TEST(LightTransport, ShortMemoryAndThreadsChangeNoBit)
{
    const std::vector<Mesh> occluders { rectangle(V3d(0.2, -40, 0.5), V3d(0, 80, 0), V3d(0.3, 0, 0.1)) };
    VismapParams map = bounce_map_of(150, 90);
    map.margin = 3;
    map.samples = 64;
    map.ground = true;
    map.ground_height = -60;
    TransportParams params;
    params.ground = true;
    const std::vector<float> one = Bounced(corner(), occluders, map, params, 1).gather(0.7f);
    EXPECT_EQ(Bounced(corner(), occluders, map, params, 4).gather(0.7f), one);
    params.most_bytes = 0;
    const Bounced unkept(corner(), occluders, map, params, 4);
    const int64_t before = work_counts().bounce_rays;
    EXPECT_FALSE(unkept.transport.is_kept());
    EXPECT_EQ(unkept.gather(0.7f), one);
    EXPECT_GT(work_counts().bounce_rays, before);
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
    params.samples = 256;
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

TEST(LightTransport, MemoryIsCounted)
{
    const std::vector<Mesh> occluders { rectangle(V3d(0.2, -40, 0.5), V3d(0, 80, 0), V3d(0.3, 0, 0.1)) };
    const Bounced whole(corner(), occluders, bounce_map_of(64));
    LightTransport transport;
    TransportParams params;
    std::string error;
    const auto prepare = [&](size_t memory, size_t kept) {
        params.memory = memory;
        params.most_bytes = kept;
        error.clear();
        return transport.prepare(whole.scene, whole.map, whole.visibility, params, error);
    };
    EXPECT_FALSE(prepare(1000, 1 << 30));
    EXPECT_NE(error.find("bounced light of 64x64 texels needs 192 KB of memory"), std::string::npos) << error;
    // Enough for the texels, and not for cells: also where nothing else is kept.
    EXPECT_FALSE(prepare(64 * 64 * 48 + 1000, 0));
    EXPECT_NE(error.find("needs more than"), std::string::npos) << error;
    EXPECT_TRUE(transport.points().empty());
    EXPECT_EQ(transport.bytes(), 0u);
    EXPECT_TRUE(prepare(size_t(64) << 20, 1 << 30)) << error;
    EXPECT_EQ(transport.bytes(), whole.transport.bytes());
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

TEST(LightTransport, RefusesWhatItCannotTrace)
{
    const Mesh floor = floor_facing_z(1);
    std::string error;
    auto scene = std::make_shared<BakeScene>();
    ASSERT_TRUE(scene->build(non_owning(floor), {}, 0, error)) << error;
    LightTransport transport;
    TransportParams params;
    params.rays = 500;
    EXPECT_FALSE(transport.prepare(scene, bounce_map_of(16), {}, params, error));
    EXPECT_EQ(error, "rays: 500 is not in [8, 248]");
    params.rays = 8;
    EXPECT_FALSE(transport.prepare(scene, bounce_map_of(16), {}, params, error, 1, [](double) { return false; }));
    EXPECT_EQ(error, "interrupted");
    EXPECT_TRUE(transport.prepare(scene, bounce_map_of(16), {}, params, error)) << error;
    EXPECT_EQ(transport.rays(), 16 * 16 * 8); // nothing is known of what is open
    std::vector<float> light { 1 };
    EXPECT_FALSE(transport.gather(light, std::vector<float>(3 * 16 * 15), {}));
    EXPECT_TRUE(light.empty());
    EXPECT_FALSE(transport.gather(light, std::vector<float>(3 * 16 * 16), std::vector<float>(3)));
    EXPECT_TRUE(transport.gather(light, std::vector<float>(3 * 16 * 16), {}));
    EXPECT_FALSE(transport.prepare(scene, bounce_map_of(16), std::vector<float>(15 * 16), params, error));
    EXPECT_EQ(error, "240 values of visibility for 16x16 texels");
    EXPECT_FALSE(transport.gather(light, std::vector<float>(3 * 16 * 16), {}));
    EXPECT_EQ(transport.bytes(), 0u);
}
