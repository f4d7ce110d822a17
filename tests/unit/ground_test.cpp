// SPDX-License-Identifier: Apache-2.0
// The analytic ground: against closed forms, against a mesh that is as good as endless, and in the traced reference.
#include "baked_map.h"
#include "scenes.h"

#include <vmlight/math/latlong.h>
#include <vmlight/reference/reference.h>
#include <vmlight/trace/ground_plane.h>

#include <random>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

constexpr double kEndless = 1e4;

VismapParams over_ground(VismapParams params, double height = VismapParams::kLowest)
{
    params.ground = params.skip_open = true;
    params.ground_height = height;
    return params;
}

// A square of side 2 around `centre`, whose normal leans from +y toward +x by `degrees`.
Mesh leaning_square(double degrees, V3d centre)
{
    const double t = degrees * M_PI / 180;
    const V3d x(std::cos(t), -std::sin(t), 0), z(0, 0, 1);
    Mesh mesh;
    mesh.name = "square";
    add_quad(mesh, centre - x + z, centre + x + z, centre + x - z, centre - x - z, V2f(0, 0), V2f(1, 1));
    return mesh;
}

Mesh ground_mesh(double height)
{
    return quad(V3d(-kEndless, height, kEndless), V3d(kEndless, height, kEndless), V3d(kEndless, height, -kEndless),
                V3d(-kEndless, height, -kEndless));
}

// A box with its own part of the texture for each face, and a ball beside it.
Mesh box_and_ball()
{
    Mesh mesh = box(V3d(-1, 0, -1), V3d(1, 1.5, 1), false);
    append(mesh, sphere(V3d(1.4, 0.4, 0), 0.4, 12));
    return mesh;
}

double rms_of_difference(const BakedMap& a, const BakedMap& b)
{
    double sum = 0, count = 0;
    a.each_covered([&](const Texel& t, int x, int y) {
        sum += std::pow(t.visibility - b.at(x, y).visibility, 2);
        ++count;
    });
    EXPECT_GT(count, 0);
    return std::sqrt(sum / count);
}

} // namespace

TEST(Ground, ALeaningPlaneSeesItsPartOfTheSkyExactly)
{
    // By quadrature over the hemisphere, not by the formula.
    for (const double degrees : { 0.0, 10.0, 45.0, 90.0, 120.0, 170.0 }) {
        const double t = degrees * M_PI / 180;
        const V3d n(std::sin(t), std::cos(t), 0);
        V3d moment(0);
        double all = 0;
        const int steps = 600;
        for (int k = 0; k < 2 * steps; ++k) {
            const double phi = (k + 0.5) * M_PI / steps, x = std::cos(phi), z = std::sin(phi);
            for (int i = 0; i < steps; ++i) {
                const double theta = (i + 0.5) * M_PI / 2 / steps, sine = std::sin(theta); // y > 0
                const V3d w(sine * x, std::cos(theta), sine * z);
                const double weight = std::max(0.0, w.dot(n)) * sine * (M_PI / 2 / steps) * (M_PI / steps) / M_PI;
                all += weight;
                moment += w * weight;
            }
        }
        const BakedMap map(leaning_square(degrees, V3d(0, 3, 0)), {}, over_ground(map_params(4, 4, 32), 0));
        map.each([&](const Texel& texel, int, int) {
            EXPECT_NEAR(texel.visibility, all, 2e-6) << degrees;
            EXPECT_NEAR(texel.visibility, (1 + std::cos(t)) / 2, 1e-6) << degrees;
            EXPECT_LT((V3d(texel.direction) - moment).length(), 2e-6) << degrees;
        });
        EXPECT_EQ(map.report.rays, 0) << degrees;
    }
}

TEST(Ground, AWallOverItSeesWhatAWallBesideAnotherDoes)
{
    const GroundView view = ground_view(V3d(0, 0, 1));
    EXPECT_NEAR(view.visibility, 0.5, 1e-15);
    EXPECT_LT((view.direction - V3d(0, 2 / (3 * M_PI), 1.0 / 3)).length(), 1e-15);
    EXPECT_EQ(ground_view(V3d(0, 1, 0)).visibility, 1);
    EXPECT_LT((ground_view(V3d(0, 1, 0)).direction - V3d(0, 2.0 / 3, 0)).length(), 1e-15);
    EXPECT_EQ(ground_view(V3d(0, -1, 0)).visibility, 0);
    EXPECT_EQ(ground_view(V3d(0, -1, 0)).direction, V3d(0));
}

TEST(Ground, AFaceThatLiesOnItSeesAllFromAboveAndNothingFromBelow)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> number(-1, 1);
    for (int k = 0; k < 20; ++k) {
        const double scale = std::pow(10.0, 4 * number(random));
        const V3d centre = V3d { number(random), number(random), number(random) } * scale * 100.0;
        for (const double side : { 0.0, 180.0 }) {
            const Mesh mesh = placed(leaning_square(side, V3d(0)), scale, centre);
            double height = 0;
            for (const V3d& p : mesh.positions)
                height = p.y; // sin(180 degrees) is not 0
            for (const double given : { VismapParams::kLowest, height }) {
                const BakedMap map(mesh, {}, over_ground(map_params(8, 8, 16), given));
                map.each([&](const Texel& t, int, int) {
                    if (side == 0)
                        EXPECT_EQ(t.visibility, 1) << scale << " " << given;
                    else
                        EXPECT_TRUE(t.is_zero()) << scale << " " << given << ": " << t.visibility;
                });
                EXPECT_EQ(map.report.rays, 0);
            }
        }
    }
}

TEST(Ground, TexelsBelowItSeeNothing)
{
    for (const double degrees : { 0.0, 60.0, 180.0 }) {
        VismapParams params = over_ground(map_params(4, 4, 16), 10);
        for (const double distance : { 0.1, std::numeric_limits<double>::infinity() }) {
            params.max_distance = distance;
            const BakedMap map(leaning_square(degrees, V3d(0)), {}, params);
            map.each([&](const Texel& t, int, int) { EXPECT_TRUE(t.is_zero()); });
            EXPECT_EQ(map.report.rays, 0);
        }
    }
}

TEST(Ground, IsWhatAMeshOfTenThousandTimesTheSizeIs)
{
    const Mesh mesh = box_and_ball();
    VismapParams params = map_params(64, 64, 512);
    const BakedMap traced(mesh, { ground_mesh(-0.25) }, params);
    const BakedMap analytic(mesh, {}, over_ground(params, -0.25));
    EXPECT_LT(rms_of_difference(traced, analytic), 0.004);
    EXPECT_LT(analytic.report.rays, traced.report.rays);
    double most = 0;
    analytic.each_covered([&](const Texel& t, int x, int y) {
        most = std::max(most, double((t.direction - traced.at(x, y).direction).length()));
    });
    EXPECT_LT(most, 0.03);
}

TEST(Ground, RespectsTheMaximumDistance)
{
    const Mesh mesh = box_and_ball();
    VismapParams params = map_params(64, 64, 256);
    double least = 1;
    for (const double distance : { 0.2, 0.6, 2.0 }) {
        params.max_distance = distance;
        const BakedMap traced(mesh, { ground_mesh(-0.5) }, params);
        const BakedMap analytic(mesh, {}, over_ground(params, -0.5));
        EXPECT_LT(rms_of_difference(traced, analytic), 5e-4)
            << distance; // the same rays: few at the edge of reach differ
        double sum = 0;
        analytic.each_covered([&](const Texel& t, int, int) { sum += t.visibility; });
        EXPECT_LT(sum / double(analytic.report.covered), least);
        least = sum / double(analytic.report.covered);
    }
}

TEST(Ground, BasesSeeItToo)
{
    const Mesh mesh = box_and_ball();
    for (const char* basis : { "sh", "mask", "cells" }) {
        VismapParams params = map_params(32, 32, 64);
        params.basis = basis;
        params.max_distance = 1e6; // no closed form: the very rays of the mesh
        const BakedMap traced(mesh, { ground_mesh(-0.5) }, params);
        const BakedMap analytic(mesh, {}, over_ground(params, -0.5));
        int64_t differ = 0, all = 0;
        const int channels = traced.spec().nchannels;
        std::vector<float> a(size_t(channels), 0.0f), b(size_t(channels), 0.0f);
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 32; ++x) {
                traced.image().getpixel(x, y, a.data());
                analytic.image().getpixel(x, y, b.data());
                differ += a != b;
                ++all;
            }
        EXPECT_LT(differ, all / 50) << basis;
    }
}

TEST(Ground, TheReferenceSeesTheSame)
{
    OIIO::ImageBuf sky(OIIO::ImageSpec(32, 16, 3, OIIO::TypeFloat));
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 32; ++x) {
            const V3d d = latlong::direction((x + 0.5) / 32, (y + 0.5) / 16);
            const float rgb[3] = { float(1 + d.y), 1, float(2 + d.x) };
            sky.setpixel(x, y, 0, rgb);
        }
    ReferenceParams rays;
    rays.samples = 2048;
    const Mesh mesh = leaning_square(90, V3d(0, 2, 0));
    OIIO::ImageBuf lit[2];
    ASSERT_TRUE(make_reference(lit[0], mesh, {}, sky, over_ground(map_params(4, 4, 1), 0), {}, rays));
    ASSERT_TRUE(make_reference(lit[1], mesh, { ground_mesh(0) }, sky, map_params(4, 4, 1), {}, rays));
    float a[7], b[7];
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) {
            lit[0].getpixel(x, y, a);
            lit[1].getpixel(x, y, b);
            EXPECT_NEAR(a[1], 0.5, 5 * a[4] + 1e-6);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(a[c], b[c], 1e-3); // the same rays
        }
}

TEST(Ground, AMapWithoutHasTheMetadataThatItAlwaysHad)
{
    const Mesh mesh = floor_facing_z(1);
    const BakedMap without(mesh, {}, map_params(4, 4, 1)), with(mesh, {}, over_ground(map_params(4, 4, 1)));
    for (const char* name : { "vmlight:ground", "vmlight:ground_height" }) {
        EXPECT_FALSE(without.spec().find_attribute(name)) << name;
        EXPECT_TRUE(with.spec().find_attribute(name)) << name;
    }
    EXPECT_EQ(with.spec().get_string_attribute("vmlight:ground_height"), "lowest");
}
