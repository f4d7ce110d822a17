// SPDX-License-Identifier: Apache-2.0
// What strands mirror, filtered: laws, limits, and brute force.
#include "cases.h"

#include <vmlight/cfem/cone_levels.h>
#include <vmlight/frame/strand_specular.h>
#include <vmlight/math/latlong.h>

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>

using namespace vmlight;
using Imath::C3f;
using Imath::V3d;

namespace {

using Radiance = std::function<double(const V3d&)>;

OIIO::ImageBuf sky_of(const Radiance& light, int height = 64)
{
    OIIO::ImageBuf sky(OIIO::ImageSpec(2 * height, height, 3, OIIO::TypeFloat));
    for (OIIO::ImageBuf::Iterator<float> pixel(sky); !pixel.done(); ++pixel) {
        const double value = light(latlong::direction((pixel.x() + 0.5) / (2 * height), (pixel.y() + 0.5) / height));
        for (int c = 0; c < 3; ++c)
            pixel[c] = float((c + 1) * value);
    }
    return sky;
}

// Smooth, with a lamp of about a degree squared times `sharpness`.
double with_lamp(const V3d& w, double sharpness)
{
    return 0.3 + 0.2 * w.y + 0.1 * w.x * w.z + 5 * std::exp(sharpness * (w.dot(V3d(0.6, 0.48, -0.64)) - 1));
}

ConeLevels levels_of(const Radiance& light, double exponent)
{
    ConeLevels levels;
    std::string error;
    EXPECT_TRUE(levels.make(sky_of(light), exponent, 0, error)) << error;
    return levels;
}

V3d looked(const ConeLevels& levels, const V3d& tangent, double cos_angle)
{
    float rgb[3];
    levels.look(rgb, tangent, cos_angle);
    return V3d(rgb[0], rgb[1], rgb[2]);
}

// A ring about the tangent.
double mean_of_cone(const Radiance& light, const V3d& tangent, double angle)
{
    constexpr int kColumns = 120;
    const V3d side = tangent.cross(std::abs(tangent.y) < 0.9 ? V3d(0, 1, 0) : V3d(1, 0, 0)).normalized();
    const V3d other = tangent.cross(side);
    double sum = 0;
    for (int k = 0; k < kColumns; ++k) {
        const double phi = 2 * latlong::pi * k / kColumns;
        sum += light(tangent * std::cos(angle) + (side * std::cos(phi) + other * std::sin(phi)) * std::sin(angle));
    }
    return sum / kColumns;
}

// The definition, by a sum over the sphere.
double integrated(const Radiance& light, const V3d& tangent, double angle, double exponent)
{
    constexpr int kRings = 250;
    double sum = 0, all = 0;
    for (int i = 0; i < kRings; ++i) {
        const double theta = latlong::pi * (i + 0.5) / kRings;
        const double weight = std::pow(std::max(0.0, std::cos(theta - angle)), exponent) * std::sin(theta);
        if (weight < 1e-6)
            continue;
        sum += weight * mean_of_cone(light, tangent, theta);
        all += weight;
    }
    return sum / all;
}

const std::vector<V3d> kTangents { V3d(0, 1, 0), V3d(0.6, 0.48, -0.64), V3d(1, 0, 0), V3d(-0.48, 0.6, 0.64),
                                   V3d(0, -0.6, -0.8) };

} // namespace

TEST(ConeLevels, ConstantLightIsConstant)
{
    const double exponents[] = { 12.5, 1, 120 };
    for (int i = 0; i < cases(3, 1); ++i) {
        const double exponent = exponents[i];
        const ConeLevels levels = levels_of([](const V3d&) { return 0.25; }, exponent);
        for (const V3d& tangent : kTangents)
            for (const double cos_angle : { -1.0, -0.3, 0.0, 0.7, 1.0 }) {
                const V3d seen = looked(levels, tangent, cos_angle);
                EXPECT_LT((seen - V3d(0.25, 0.5, 0.75)).length(), 1e-4) << exponent << " " << cos_angle;
            }
    }
}

TEST(ConeLevels, HaveNoRootAndNoTip)
{
    const ConeLevels levels = levels_of([](const V3d& w) { return with_lamp(w, 40); }, 60);
    for (const V3d& tangent : kTangents)
        for (const double cos_angle : { -0.9, -0.3, 0.0, 0.7 })
            EXPECT_LT((looked(levels, tangent, cos_angle) - looked(levels, -tangent, -cos_angle)).length(), 1e-5);
}

// Turned with its light a strand mirrors the same.
TEST(ConeLevels, TurnWithTheLight)
{
    const Rotation turn = rotation_from_angles(30, 140, -50);
    const Radiance lamp = [](const V3d& w) { return with_lamp(w, 40); };
    const ConeLevels levels = levels_of(lamp, 60),
                     turned = levels_of([&](const V3d&w) { return lamp(rotate(turn.transposed(), w)); }, 60);
    for (const V3d& tangent : kTangents)
        for (const double cos_angle : { -0.9, 0.0, 0.7 }) {
            const V3d seen = looked(levels, tangent, cos_angle),
                      same = looked(turned, rotate(turn, tangent), cos_angle);
            EXPECT_LT((seen - same).length(), 0.04 * seen.length()) << cos_angle;
        }
}

// Relative to the brightest that any strand mirrors of the lamp.
TEST(ConeLevels, EqualTheIntegral)
{
    const std::pair<double, double> lobes[] = { { 40, 60 }, { 1, 5 }, { 200, 20 } };
    for (int i = 0; i < cases(3, 1); ++i) {
        const auto& [exponent, sharpness] = lobes[i];
        const double sharp = sharpness;
        const Radiance light = [&](const V3d& w) { return with_lamp(w, sharp); };
        const ConeLevels levels = levels_of(light, exponent);
        const double peak = *std::max_element(levels.texels.begin(), levels.texels.end()) / 3; // of B
        double worst = 0;
        for (const V3d& tangent : kTangents)
            for (const double angle : { 0.0, 0.4, 1.0, 1.5707, 2.2, 3.0 }) {
                const V3d seen = looked(levels, tangent, std::cos(angle));
                worst = std::max(worst, std::abs(seen.x - integrated(light, tangent, angle, exponent)) / peak);
                EXPECT_NEAR(seen.z, 3 * seen.x, 1e-4 * seen.z);
            }
        EXPECT_LT(worst, 0.015) << exponent << " " << sharpness;
    }
}

// The narrower the lobe, the nearer to the mean over the cone itself.
TEST(ConeLevels, TendToTheMeanOfTheCone)
{
    const Radiance light = [](const V3d& w) { return with_lamp(w, 4); };
    double last = 1e9;
    for (const double exponent : { 15.0, 60.0, 240.0 }) {
        const ConeLevels levels = levels_of(light, exponent);
        double worst = 0;
        for (const V3d& tangent : kTangents)
            for (const double angle : { 0.3, 0.9, 1.4 })
                worst = std::max(
                    worst, std::abs(looked(levels, tangent, std::cos(angle)).x - mean_of_cone(light, tangent, angle)));
        EXPECT_LT(worst, 0.35 * last) << exponent; // as 1 / exponent
        last = worst;
    }
    EXPECT_LT(last, 0.12);
}

// Strands across the line of sight mirror the plane across them; those along it what is behind the eye's far side.
TEST(StrandSpecular, MirrorsTheConeOfTheEye)
{
    auto levels = std::make_shared<ConeLevels>(levels_of([](const V3d& w) { return w.z < -0.95 ? 10.0 : 0.0; }, 200));
    StrandSpecular specular { levels, {}, 0.5 };
    EXPECT_GT(specular.look(V3d(0, 1, 0), V3d(0, 0, -3)).x, 0.1); // across: lights all round, also from behind
    EXPECT_GT(specular.look(V3d(0, 1, 0), V3d(1, 0, 0)).x, 0.1);
    EXPECT_LT(specular.look(V3d(0, 1, 0), V3d(0, 1, -1)).x, 1e-3);
    EXPECT_GT(specular.look(V3d(0, 0, 1), V3d(0, 0, -1)).x, 1); // along: straight on
    EXPECT_LT(specular.look(V3d(0, 0, 1), V3d(0, 1, 0)).x, 1e-3);
    specular.to_environment = rotation_from_angles(0, 0, 90); // the object's y is the environment's -x
    EXPECT_GT(specular.look(V3d(1, 0, 0), V3d(0, 0, -1)).x, 0.1);
}

TEST(ConeLevels, RefuseWhatIsNoEnvironment)
{
    ConeLevels levels;
    std::string error;
    OIIO::ImageBuf sky = sky_of([](const V3d& w) { return w.y; }, 16);
    EXPECT_FALSE(levels.make(sky, 10, 0, error));
    EXPECT_THAT(error, testing::HasSubstr("negative"));
    std::shared_ptr<const ConeLevels> none;
    EXPECT_FALSE(filter_for_specular(none, {}, {}, 0, error));
    EXPECT_THAT(error, testing::HasSubstr("needs the environment itself"));
}
