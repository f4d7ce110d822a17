// SPDX-License-Identifier: Apache-2.0
/// The reference against closed forms, and its standard error against what it is the error of.
#include "scenes.h"

#include <vmlight/cfem/cfem.h>
#include <vmlight/lightmap/environment_light.h>
#include <vmlight/math/latlong.h>
#include <vmlight/reference/reference.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

template <class Radiance> OIIO::ImageBuf sky(int width, int height, Radiance&& radiance)
{
    OIIO::ImageBuf image(OIIO::ImageSpec(width, height, 3, OIIO::TypeFloat));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const V3f rgb(radiance(latlong::direction((x + 0.5) / width, (y + 0.5) / height)));
            image.setpixel(x, y, 0, &rgb.x);
        }
    return image;
}

OIIO::ImageBuf constant_sky(float value)
{
    return sky(16, 8, [&](const V3d&) { return V3d(value, 2 * value, 0); });
}

// One bright pixel over a dim noise, which no cosine finds by itself.
OIIO::ImageBuf sunny_sky()
{
    OIIO::ImageBuf image = sky(64, 32, [](const V3d& d) { return V3d(1 + d.x, 1 + d.y * d.z, 1.5); });
    const float sun[3] = { 1e4f, 8e3f, 5e3f };
    image.setpixel(40, 9, 0, sun);
    return image;
}

VismapParams map_of(int side)
{
    VismapParams map;
    map.resolution = { side, side };
    return map;
}

struct Traced
{
    std::vector<float> pixels; // seven channels
    std::string error;

    Traced(const Mesh& mesh, const std::vector<Mesh>& occluders, const OIIO::ImageBuf& env, int side, int samples,
           int seed = 0, const LightmapParams& light = {}, int nthreads = 0)
    {
        ReferenceParams params;
        params.samples = samples;
        params.seed = seed;
        OIIO::ImageBuf image;
        if (!make_reference(image, mesh, occluders, env, map_of(side), light, params, nthreads))
            error = image.geterror();
        else {
            pixels.resize(size_t(side) * side * 7);
            image.get_pixels(image.roi(), OIIO::TypeFloat, pixels.data());
        }
    }
    double value(int texel, int channel) const { return pixels[size_t(texel) * 7 + size_t(channel)]; }
    double sigma(int texel, int channel) const { return pixels[size_t(texel) * 7 + 3 + size_t(channel)]; }
};

const Mesh kFloor = floor_facing_z(1);

} // namespace

TEST(EnvironmentLight, ItsDensityIsThatOfItsSamplesAndIntegratesToOne)
{
    OIIO::ImageBuf env = sunny_sky();
    for (const bool border : { false, true }) {
        if (border)
            env.specmod().attribute("oiio:sampleborder", 1);
        EnvironmentLight light;
        std::string error;
        ASSERT_TRUE(light.build(env, false, error)) << error;
        double integral = 0;
        const int n = 512;
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < 2 * n; ++i)
                integral += light.at(latlong::direction((i + 0.5) / (2 * n), (j + 0.5) / n)).density
                    * latlong::row_solid_angle(j, n) / (2 * n);
        // With a border, cells end between the points of this sum, 16 of which span the sun's.
        EXPECT_NEAR(integral, 1, border ? 0.02 : 1e-4) << border;
        int at_edges = 0;
        std::mt19937 random(1);
        std::uniform_real_distribution<double> unit(0, 1);
        for (int i = 0; i < 10000; ++i) {
            const double u = unit(random), v = unit(random);
            const EnvironmentSample sample = light.sample(u, v), back = light.at(sample.direction);
            ASSERT_NEAR(sample.direction.length(), 1, 1e-12);
            ASSERT_GT(sample.density, 0);
            at_edges += sample.density != back.density || sample.radiance != back.radiance;
        }
        EXPECT_LE(at_edges, 2) << "rounding may take the neighbour";
    }
}

TEST(EnvironmentLight, SamplesOverDensityAverageToAllLight)
{
    EnvironmentLight light;
    std::string error;
    ASSERT_TRUE(light.build(sunny_sky(), false, error)) << error;
    double exact = 0, mean = 0, squares = 0;
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x)
            exact += double(light.at(latlong::direction((x + 0.5) / 64, (y + 0.5) / 32)).radiance.x)
                * latlong::row_solid_angle(y, 32) / 64;
    const int n = 100000;
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < n; ++i) {
        const double u = unit(random);
        const EnvironmentSample sample = light.sample(u, unit(random));
        const double x = sample.radiance.x / sample.density;
        mean += x / n;
        squares += x * x / n;
    }
    EXPECT_NEAR(mean, exact, 4 * std::sqrt((squares - mean * mean) / n));
}

TEST(EnvironmentLight, BlacknessHasNoDensity)
{
    EnvironmentLight light;
    std::string error;
    ASSERT_TRUE(light.build(constant_sky(0), false, error)) << error;
    EXPECT_EQ(light.sample(0.3, 0.7).density, 0);
    EXPECT_EQ(light.at(V3d(0, 1, 0)).density, 0);
    EXPECT_FALSE(light.build(constant_sky(NAN), false, error));
    EXPECT_NE(error.find("NaN"), std::string::npos) << error;
}

TEST(Reference, OpenTexelsSeeTheWholeHemisphere)
{
    const Traced traced(kFloor, {}, constant_sky(0.5f), 4, 256);
    ASSERT_EQ(traced.error, "");
    for (int texel = 0; texel < 16; ++texel) {
        EXPECT_NEAR(traced.value(texel, 0), 0.5, 5 * traced.sigma(texel, 0) + 1e-6);
        EXPECT_NEAR(traced.value(texel, 1), 1.0, 5 * traced.sigma(texel, 1) + 1e-6);
        EXPECT_EQ(traced.value(texel, 2), 0);
        EXPECT_EQ(traced.value(texel, 6), 1);
        EXPECT_GT(traced.sigma(texel, 0), 0);
    }
}

// V = 1/2, B = (4/(3 pi), 0, 2/3)/2 beside an endless wall: under a linear sky L = 1 + a.w the light is V + a.B.
TEST(Reference, BesideAnEndlessWallALinearSkyGivesTheClosedForm)
{
    const double far = 1e5;
    const Mesh floor = floor_facing_z(1e-4);
    const Mesh wall = rectangle(V3d(-2e-4, -far, 0), V3d(0, 2 * far, 0), V3d(0, 0, far));
    const V3d a(0.5, 0.3, -0.4);
    const OIIO::ImageBuf env = sky(512, 256, [&](const V3d& d) { return V3d(1 + a.dot(d)); });
    const double expected = 0.5 + 0.5 * (a.x * 4 / (3 * latlong::pi) + a.z * 2 / 3);
    const Traced traced(floor, { wall }, env, 4, 4096);
    ASSERT_EQ(traced.error, "");
    double mean = 0, variance = 0;
    for (int texel = 0; texel < 16; ++texel) {
        EXPECT_NEAR(traced.value(texel, 0), expected, 5 * traced.sigma(texel, 0) + 1e-4) << texel;
        mean += traced.value(texel, 0) / 16;
        variance += std::pow(traced.sigma(texel, 0) / 16, 2);
    }
    EXPECT_NEAR(mean, expected, 4 * std::sqrt(variance) + 1e-4); // pixels of the sky are flat
}

TEST(Reference, UnderNoOccluderItIsTheFilteredEnvironmentHoweverTheObjectIsTurned)
{
    const OIIO::ImageBuf env = sunny_sky();
    OIIO::ImageBuf cfem;
    ASSERT_TRUE(make_cfem(cfem, env)) << cfem.geterror();
    for (const std::vector<double>& angles : { std::vector<double> { 0, 0, 0 }, { -70, 0, 0 }, { 20, 140, -60 } }) {
        LightmapParams light;
        light.rotate = angles;
        light.exposure = 1;
        const V3d n = rotate(rotation_from_angles(angles[0], angles[1], angles[2]), V3d(0, 0, 1));
        const auto st = latlong::position(n);
        float rgb[3];
        cfem.interppixel_NDC(float(st.x), float(st.y), rgb, OIIO::ImageBuf::WrapPeriodic);
        const Traced traced(kFloor, {}, env, 2, 4096, 1, light);
        for (int texel = 0; texel < 4; ++texel)
            for (int c = 0; c < 3; ++c) // the lookup in the filtered map is off by up to .005 of its mean
                EXPECT_NEAR(traced.value(texel, c), 2 * rgb[c], 5 * traced.sigma(texel, c) + 0.01 * 2 * rgb[c]);
    }
}

TEST(Reference, ManyRunsAverageToOneLongRunAndScatterAsTheySay)
{
    const Mesh wall = rectangle(V3d(-1.2, -2, 0), V3d(0, 4, 0), V3d(0, 0, 1));
    const OIIO::ImageBuf env = sunny_sky();
    LightmapParams light;
    light.rotate = { -60, 20, 0 };
    const int side = 4, runs = 64, samples = 64;
    const Traced longer(kFloor, { wall }, env, side, 64 * samples * 4, 12345, light);
    std::vector<Traced> all;
    for (int run = 0; run < runs; ++run)
        all.emplace_back(kFloor, std::vector<Mesh> { wall }, env, side, samples, run, light);
    double scatter = 0, stated = 0;
    for (int texel = 0; texel < side * side; ++texel)
        for (int c = 0; c < 3; ++c) {
            double mean = 0, squares = 0, variance = 0;
            for (const Traced& run : all) {
                mean += run.value(texel, c) / runs;
                variance += std::pow(run.sigma(texel, c), 2) / runs;
            }
            for (const Traced& run : all)
                squares += std::pow(run.value(texel, c) - mean, 2) / (runs - 1);
            const double sigma = std::sqrt(squares / runs + std::pow(longer.sigma(texel, c), 2));
            EXPECT_NEAR(mean, longer.value(texel, c), 4 * sigma) << texel << " " << c;
            scatter += squares;
            stated += variance;
        }
    EXPECT_NEAR(stated / scatter, 1, 0.15); // of 48 variances of 64 runs each, 16 of them independent
}

TEST(Reference, AConstantSkyOverACoarseSmoothSphereIsWhole)
{
    const Traced traced(icosphere(1), {}, constant_sky(1), 32, 512);
    double mean = 0;
    int covered = 0;
    for (int texel = 0; texel < 32 * 32; ++texel)
        if (traced.value(texel, 6) > 0) {
            mean += traced.value(texel, 0);
            ++covered;
        }
    ASSERT_GT(covered, 400);
    EXPECT_NEAR(mean / covered, 1, 2e-3);
}

TEST(Reference, ThreadsChangeNothingAndSeedsDo)
{
    const OIIO::ImageBuf env = sunny_sky();
    const Traced one(kFloor, {}, env, 80, 16, 3, {}, 1), two(kFloor, {}, env, 80, 16, 3, {}, 2);
    EXPECT_EQ(one.pixels, two.pixels);
    EXPECT_NE(Traced(kFloor, {}, env, 80, 16, 4).pixels, one.pixels);
}

TEST(Reference, RefusalsSayWhy)
{
    EXPECT_NE(Traced(kFloor, {}, constant_sky(-1), 2, 16).error.find("negative"), std::string::npos);
    EXPECT_NE(Traced(kFloor, {}, constant_sky(1), 2, 1).error.find("samples: 1 is not in"), std::string::npos);
    EXPECT_NE(Traced(Mesh(), {}, constant_sky(1), 2, 16).error.find("no triangle"), std::string::npos);
    LightmapParams light;
    light.rotate = { 1, 2, 3 };
    light.quaternion = { 1, 0, 0, 0 };
    EXPECT_NE(Traced(kFloor, {}, constant_sky(1), 2, 16, 0, light).error, "");
}
