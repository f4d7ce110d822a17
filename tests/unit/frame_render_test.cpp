// SPDX-License-Identifier: Apache-2.0
// Frames of scenes whose pictures are known.
#include "frame_scenes.h"

#include <vmlight/frame/lit_object.h>
#include <vmlight/lightmap/lightmap.h>
#include <vmlight/math/latlong.h>

#include <OpenImageIO/imagebufalgo.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

using namespace vmlight;
using namespace vmlight::frame_scenes;
using Imath::V3d;
using OIIO::ImageBuf;

TEST(RenderFrame, ASquareSeenSquareOnKeepsItsTexels)
{
    const int side = 37;
    std::mt19937 random(5);
    std::vector<float> texels(side * side * 3);
    for (float& texel : texels)
        texel = float(random()) / 4e9f;
    FrameSurface square;
    square.mesh = shared(scenes::floor_facing_z(1));
    square.light = texture_of(side, side, texels);
    const FrameScene scene = scene_of({ square });
    for (const bool is_orthographic : { true, false }) {
        const ImageBuf image = rendered(scene, square_on(is_orthographic), params_of(side));
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x)
                for (int c = 0; c < 3; ++c)
                    ASSERT_FLOAT_EQ(image.getchannel(x, y, 0, c), texels[size_t((y * side + x) * 3 + c)])
                        << x << " " << y;
    }
}

// A convex white object in light of one colour sends out that colour everywhere.
TEST(RenderFrame, AConvexObjectInConstantLightIsThatLight)
{
    OIIO::ImageSpec spec(16, 8, 3, OIIO::TypeFloat);
    SceneLight light;
    light.filtered.emplace_back(spec);
    OIIO::ImageBufAlgo::fill(light.filtered[0], { 0.4f, 1.5f, 7.0f });
    for (const Mesh& mesh : { scenes::sphere(V3d(0), 1, 24), scenes::box(V3d(-1), V3d(1), false) }) {
        VismapParams map;
        map.resolution = { 128, 128 };
        map.samples = 16;
        LitObject object;
        object.open(shared(mesh), map);
        LightmapParams params;
        params.model = "paper";
        std::string error;
        ASSERT_TRUE(object.light(light, params, {}, {}, error)) << error;
        CameraParams place;
        place.azimuth = 30;
        Subject subject;
        subject.add(mesh);
        const ImageBuf image
            = rendered(scene_of({ object.surface() }), place_camera(place, subject, 1, false), params_of(64, 9));
        int covered = 0;
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) {
                const auto p = pixel(image, x, y);
                covered += p[3] == 1;
                EXPECT_NEAR(p[0], 0.4f * p[3], 1e-6 * 0.4);
                EXPECT_NEAR(p[1], 1.5f * p[3], 1e-6 * 1.5);
                EXPECT_NEAR(p[2], 7.0f * p[3], 1e-6 * 7.0);
            }
        EXPECT_GT(covered, 1000);
    }
}

TEST(RenderFrame, TheNearerSurfaceIsSeen)
{
    FrameSurface front = surface_of(scenes::floor_facing_z(0.5, V3d(0, 0, 1)), { 1, 0, 0 });
    const FrameScene scene = scene_of({ surface_of(scenes::floor_facing_z(1), { 0, 1, 0 }), front });
    const ImageBuf image = rendered(scene, square_on(), params_of(8));
    EXPECT_EQ(pixel(image, 4, 4), (std::vector<float> { 1, 0, 0, 1 }));
    EXPECT_EQ(pixel(image, 0, 0), (std::vector<float> { 0, 1, 0, 1 }));
}

TEST(RenderFrame, AlphaIsLaidOverWhatIsBehind)
{
    const auto pane = [](double z, AlphaMode mode, float alpha, const std::vector<float>& color) {
        FrameSurface surface = surface_of(scenes::floor_facing_z(1, V3d(0, 0, z)), color);
        surface.materials.resize(1);
        surface.materials[0].alpha_mode = mode;
        surface.materials[0].alpha = alpha;
        return surface;
    };
    const auto seen = [&](const std::vector<FrameSurface>& surfaces) {
        return pixel(rendered(scene_of(surfaces), square_on(), params_of(2)), 0, 0);
    };
    const FrameSurface wall = pane(0, AlphaMode::opaque, 0.1f, { 0, 1, 0 });
    EXPECT_EQ(seen({ wall }), (std::vector<float> { 0, 1, 0, 1 })); // alpha of what is opaque is ignored
    EXPECT_EQ(seen({ wall, pane(1, AlphaMode::blend, 0.25f, { 1, 0, 0 }) }), (std::vector<float> { 0.25, 0.75, 0, 1 }));
    EXPECT_EQ(seen({ pane(1, AlphaMode::blend, 0.25f, { 1, 0, 0 }) }), (std::vector<float> { 0.25, 0, 0, 0.25 }));
    EXPECT_EQ(seen({ wall, pane(1, AlphaMode::mask, 0.49f, { 1, 0, 0 }) }), (std::vector<float> { 0, 1, 0, 1 }));
    EXPECT_EQ(seen({ wall, pane(1, AlphaMode::mask, 0.5f, { 1, 0, 0 }) }), (std::vector<float> { 1, 0, 0, 1 }));
    // Twenty panes, one behind the other: (1 - alpha)^20 is left.
    std::vector<FrameSurface> panes { wall };
    for (int i = 1; i <= 20; ++i)
        panes.push_back(pane(i * 0.05, AlphaMode::blend, 0.1f, { 1, 0, 0 }));
    EXPECT_NEAR(seen(panes)[1], std::pow(0.9, 20), 1e-6);
    EXPECT_NEAR(seen(panes)[0], 1 - std::pow(0.9, 20), 1e-6);
}

TEST(RenderFrame, MaterialsMultiplyTheLight)
{
    FrameSurface square = surface_of(scenes::floor_facing_z(1), { 2, 2, 2 });
    SurfaceMaterial material;
    material.color = { 0.5f, 1, 0.25f };
    const std::array<float, 16> texels { 1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1, 1, 1, 1, 1 };
    material.texture = std::make_shared<TexturePyramid>(2, 2, 4, texels.data(), nullptr);
    square.materials = { material };
    RenderParams params = params_of(2);
    params.layers = { "albedo", "lit" };
    const ImageBuf image = rendered(scene_of({ square }), square_on(), params);
    // Rows from the top, as the texture has them.
    EXPECT_EQ(pixel(image, 0, 0), (std::vector<float> { 1, 0, 0, 1, 0.5, 0, 0, 2, 2, 2 }));
    EXPECT_EQ(pixel(image, 1, 0), (std::vector<float> { 0, 2, 0, 1, 0, 1, 0, 2, 2, 2 }));
    EXPECT_EQ(pixel(image, 0, 1), (std::vector<float> { 0, 0, 0.5, 1, 0, 0, 0.25, 2, 2, 2 }));
}

TEST(RenderFrame, LayersSayWhatAndWhere)
{
    RenderParams params = params_of(4);
    params.layers = { "normal", "position", "depth", "uv" };
    const FrameScene scene = scene_of({ surface_of(scenes::floor_facing_z(0.5, V3d(0, 0, 1))) });
    const ImageBuf image = rendered(scene, square_on(), params);
    EXPECT_THAT(image.spec().channelnames,
                testing::ElementsAre("R", "G", "B", "A", "normal.x", "normal.y", "normal.z", "position.x", "position.y",
                                     "position.z", "uv.u", "uv.v", "depth.Z"));
    const auto inside = pixel(image, 1, 1), outside = pixel(image, 0, 0);
    EXPECT_THAT(inside, testing::ElementsAre(1, 1, 1, 1, 0, 0, 1, -0.25, 0.25, 1, 0.25, 0.75, 4));
    EXPECT_THAT(outside, testing::ElementsAre(0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1e10f));
}

// The environment behind a turned object is where its rotation says.
TEST(RenderFrame, TheBackgroundIsTheEnvironmentAlongTheRay)
{
    const int width = 64, height = 32;
    std::vector<float> texels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const V3d d = latlong::direction((x + 0.5) / width, (y + 0.5) / height);
            texels.insert(texels.end(), { float(1 + d.x), float(1 + d.y), float(1 + d.z) });
        }
    FrameScene scene = scene_of({ surface_of(scenes::floor_facing_z(1e-3)) });
    scene.background.is_visible = true;
    scene.background.environment = std::make_shared<TexturePyramid>(width, height, 3, texels.data(), nullptr,
                                                                    TextureWrap::periodic, TextureWrap::clamp);
    scene.background.rotation = rotation_from_angles(10, 70, 20);
    Camera camera;
    camera.position = V3d(0, 0, 3);
    camera.half_width = camera.half_height = 1;
    const ImageBuf image = rendered(scene, camera, params_of(33));
    for (int y = 0; y < 33; ++y)
        for (int x = 0; x < 33; ++x) {
            if (x == 16 && y == 16)
                continue; // the object
            const V3d d
                = rotate(scene.background.rotation, camera.ray(x + 0.5, y + 0.5, 33, 33).direction.normalized());
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(image.getchannel(x, y, 0, c), 1 + d[c], 0.02) << x << " " << y;
            EXPECT_EQ(image.getchannel(x, y, 0, 3), 1);
        }
}

TEST(Background, BlurKeepsTheMeanAndAConstant)
{
    ImageBuf constant(OIIO::ImageSpec(64, 32, 3, OIIO::TypeFloat)), spot(OIIO::ImageSpec(64, 32, 3, OIIO::TypeFloat));
    OIIO::ImageBufAlgo::fill(constant, { 2.0f, 3.0f, 4.0f });
    OIIO::ImageBufAlgo::zero(spot);
    const float white[3] { 1, 1, 1 };
    spot.setpixel(20, 12, white);
    std::shared_ptr<const TexturePyramid> blurred;
    std::string error;
    ASSERT_TRUE(make_background(blurred, constant, 10, 1, error)) << error;
    for (const float t : { 0.01f, 0.5f, 0.9f }) {
        std::array<float, 3> rgb {};
        blurred->lookup({ Imath::V2d(0.3, t) }, rgb.data());
        EXPECT_THAT(rgb,
                    testing::ElementsAre(testing::FloatNear(2, 1e-5f), testing::FloatNear(3, 1e-5f),
                                         testing::FloatNear(4, 1e-5f)));
    }
    ASSERT_TRUE(make_background(blurred, spot, 10, 1, error)) << error;
    const auto& level = blurred->levels()[0];
    double sum = 0, variance = 0;
    const V3d centre = latlong::direction(20.5 / 64, 12.5 / 32);
    for (int y = 0; y < level.height; ++y)
        for (int x = 0; x < level.width; ++x) {
            const double share = double(level.texels[size_t(y * level.width + x) * 4])
                * latlong::row_solid_angle(y, level.height) / level.width;
            const double angle = std::acos(
                std::min(1.0, centre.dot(latlong::direction((x + 0.5) / level.width, (y + 0.5) / level.height))));
            sum += share;
            variance += share * angle * angle;
        }
    EXPECT_NEAR(sum, latlong::row_solid_angle(12, 32) / 64, 0.02 * sum);
    // Two axes of 10 degrees each, cut at three deviations.
    EXPECT_NEAR(std::sqrt(variance / sum / 2) * 180 / latlong::pi, 10, 0.7);
}

TEST(RenderFrame, ShadowsAloneAreAlpha)
{
    FrameSurface ground = surface_of(scenes::floor_facing_z(1), { 0.3f, 0.3f, 0.3f });
    ground.catches_shadows = true;
    ground.unshadowed = 0.4f;
    const auto seen = pixel(rendered(scene_of({ ground }), square_on(), params_of(2)), 0, 0);
    EXPECT_EQ(seen[0], 0);
    EXPECT_NEAR(seen[3], 0.25, 1e-6);
}
