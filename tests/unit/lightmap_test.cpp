// SPDX-License-Identifier: Apache-2.0
#include "lightmap_scene.h"

#include <array>

using namespace vmlight;
using namespace scene;

TEST(Lightmap, AConstantEnvironmentIsVisibilityTimesItsLight)
{
    const ImageBuf vm = random_vismap(64, 48);
    for (const auto& [width, height] : { std::pair { 256, 128 }, { 33, 17 }, { 1, 1 } }) {
        const V3f light(0.25f, 1, 1000);
        const ImageBuf image = lit(vm, almost(cfem(width, height, [&](V3d) { return light; })));
        for (int y = 0; y < 48; ++y)
            for (int x = 0; x < 64; ++x)
                for (int c = 0; c < 3; ++c) {
                    const float expected = vm.getchannel(x, y, 0, 0) * light[c];
                    // The weights sum to V within a few units in the last place.
                    EXPECT_NEAR(color(image, x, y)[c], expected, 1e-6f * expected);
                }
    }
}

TEST(Lightmap, ALinearEnvironmentIsItsClosedForm)
{
    // L = a + b.w filters to C(n) = a + (2/3) b.n.
    const V3d a(1, 2, 3), b(0.5, -0.9, 0.7);
    const auto filtered = [&](V3d n) { return V3f(a + V3d(2.0 / 3 * (b ^ n))); };
    const ImageBuf vm = random_vismap(64, 48);
    LightmapParams params;
    params.rotate = { 20, 35, -50 };
    const Rotation r = rotation_from_angles(20, 35, -50);
    const ImageBuf image = lit(vm, cfem(256, 128, filtered), params);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x) {
            float t[4];
            vm.getpixel(x, y, t);
            const V3f expected = filtered(rotate(r, V3d(t[1], t[2], t[3])).normalized()) * t[0];
            // Bilinear interpolation is off by spacing^2 / 8 times the curvature in each angle: 7.5e-5 twice.
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(color(image, x, y)[c], expected[c], 1.5e-4 * 2 / 3 * b.length() + 2e-6);
        }
}

TEST(Lightmap, RotationTakesObjectSpaceToTheEnvironment)
{
    // All light comes from +x; a texel that looks along its own +z meets it once a quarter turn about y has taken +z
    // to +x, and turning the environment back by as much does the same.
    const ImageBuf from_x = cfem(64, 32, [](V3d n) { return V3f(float(std::max(0.0, n.x))); });
    const ImageBuf texel = one_texel(1, V3f(0, 0, 2.0f / 3));
    LightmapParams object, environment;
    object.rotate = { 0, 90, 0 };
    environment.env_rotate = { 0, -90, 0 };
    EXPECT_NEAR(color(lit(texel, from_x)).x, 0, 0.05);
    EXPECT_NEAR(color(lit(texel, from_x, object)).x, 1, 0.01);
    EXPECT_NEAR(color(lit(texel, from_x, environment)).x, 1, 0.01);
    environment.env_rotate = { 0, 90, 0 };
    EXPECT_NEAR(color(lit(texel, from_x, environment)).x, 0, 1e-5);
}

TEST(Lightmap, AQuarterTurnAboutTheAxisShiftsTheEnvironmentByAQuarter)
{
    const int width = 32, height = 15;
    const ImageBuf vm = random_vismap(40, 40), map = random_cfem(width, height);
    for (int quarters : { 1, 2, 3, 4 }) {
        ImageBuf shifted(map.spec());
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const V3f c = color(map, (x - quarters * width / 4 + 2 * width) % width, y);
                shifted.setpixel(x, y, &c.x, 3);
            }
        LightmapParams params;
        params.rotate = { 0, 90.0 * quarters, 0 };
        // The lookups differ by rounding of the column, at most 2^-19 columns of 32.
        EXPECT_LT(difference(lit(vm, map, params), lit(vm, shifted)), 4e-6f) << quarters;
    }
    LightmapParams full;
    full.rotate = { 0, 360, 0 };
    EXPECT_TRUE(same_bits(lit(vm, map, full), lit(vm, map)));
}

TEST(Lightmap, TurningObjectAndEnvironmentTogetherChangesNothing)
{
    const ImageBuf vm = random_vismap(40, 40), map = random_cfem(32, 16);
    for (const std::vector<double>& angles : { std::vector<double> { 0, 90, 0 }, { 90, 180, 270 }, { 20, 35, -50 } }) {
        LightmapParams both;
        both.rotate = both.env_rotate = angles;
        EXPECT_LT(difference(lit(vm, map, both), lit(vm, map)), 4e-6f);
    }
}

TEST(Lightmap, MatrixQuaternionAndAnglesAreOneRotation)
{
    const Rotation r = rotation_from_angles(0, 60, 0);
    LightmapParams angles, matrix, quaternion;
    angles.rotate = { 0, 60, 0 };
    matrix.matrix = { r[0][0], r[0][1], r[0][2], r[1][0], r[1][1], r[1][2], r[2][0], r[2][1], r[2][2] };
    quaternion.quaternion = { std::sqrt(3.0), 0, 1, 0 };
    const ImageBuf vm = random_vismap(40, 40), map = random_cfem(32, 16);
    EXPECT_LT(difference(lit(vm, map, angles), lit(vm, map, matrix)), 4e-6f);
    EXPECT_LT(difference(lit(vm, map, angles), lit(vm, map, quaternion)), 4e-6f);
}

TEST(Lightmap, RotationsCompose)
{
    LightmapParams params;
    params.rotate = { 10, 20, 30 };
    params.env_rotate = { -40, 5, 70 };
    Rotation r;
    std::string error;
    ASSERT_TRUE(lightmap_rotation(r, params, error)) << error;
    const V3d w(0.3, -0.5, 0.8);
    // Light that arrives along w comes from E^-1 R w: E takes it back to R w.
    const V3d there = rotate(rotation_from_angles(-40, 5, 70), rotate(r, w));
    EXPECT_LT((there - rotate(rotation_from_angles(10, 20, 30), w)).length(), 1e-15);
}

TEST(Lightmap, ATexelThatSeesNothingIsBlack)
{
    const ImageBuf map = random_cfem(16, 8);
    EXPECT_EQ(color(lit(one_texel(0, V3f(0)), map)), V3f(0));
    EXPECT_EQ(color(lit(one_texel(0, V3f(0, 1, 0)), map)), V3f(0));
    // Filters with negative lobes leave such values next to bright texels.
    EXPECT_EQ(color(lit(one_texel(-0.01f, V3f(0, 1, 0)), map)), V3f(0));
}

TEST(Lightmap, ATexelThatSeesAlikeOnAllSidesGetsTheMeanLight)
{
    // C = 1 + y^2 has the mean 1 + 1/3 over the sphere; a mean over the pixels would give 3/2.
    const ImageBuf map = cfem(256, 128, [](V3d n) { return V3f(float(1 + n.y * n.y)); });
    EXPECT_NEAR(color(lit(one_texel(0.5f, V3f(0)), map)).x, 0.5 * 4 / 3, 1e-4);
    EXPECT_NEAR(color(lit(one_texel(0.5f, V3f(1e-8f, -2e-8f, 0)), map)).x, 0.5 * 4 / 3, 1e-4);
    // A direction that is weak, but there, is followed.
    EXPECT_NEAR(color(lit(one_texel(0.5f, V3f(0, 1e-5f, 0)), map)).x, 0.5 * 2, 1e-4);
}

TEST(Lightmap, TheLengthOfTheDirectionDoesNotMatter)
{
    const ImageBuf map = random_cfem(16, 8);
    const V3f w(0.3f, -0.5f, 0.8f);
    const V3f expected = color(lit(one_texel(1, w), map));
    // From the edge of float, where squares would overflow, down to where they would vanish beside V = 1e-16.
    for (float length : { 1e-5f, 1e30f, 3e38f })
        EXPECT_LT((color(lit(one_texel(1, w * length), map)) - expected).length(), 1e-5f) << length;
    EXPECT_LT((color(lit(one_texel(1e-22f, w * 1e-22f), map)) * 1e22f - expected).length(), 1e-5f);
}

TEST(Lightmap, ExposureCountsInStops)
{
    const ImageBuf vm = random_vismap(20, 20), map = random_cfem(16, 8), plain = lit(vm, map);
    LightmapParams params;
    for (int stops : { 1, -3, 20 }) {
        params.exposure = stops;
        const ImageBuf image = lit(vm, map, params);
        for (int i = 0; i < 3 * 400; ++i)
            ASSERT_EQ(pixels(image)[i], std::ldexp(pixels(plain)[i], stops));
    }
}
