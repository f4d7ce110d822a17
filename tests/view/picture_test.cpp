// SPDX-License-Identifier: Apache-2.0
#include "view_pictures.h"

#include "vmview/render/picture.h"

#include <vmlight/base/format.h>
#include <vmlight/frame/background.h>
#include <vmlight/frame/texel_weights.h>

#include <cmath>
#include <cstdlib>

using namespace vmlight;
using namespace vmlight::view;

namespace {

using Picture = DrawingTest;

} // namespace

// Against the renderer of vmframes. VMLIGHT_VIEW_ALL=1: three meshes, three environments, five rotations, three models.
TEST_F(HeadlessPicture, EqualsThatOfFrames)
{
    const bool is_all = std::getenv("VMLIGHT_VIEW_ALL") != nullptr;
    std::vector<std::string> meshes { "spot.obj", "gazebo.obj", "cases/box.obj" };
    std::vector<std::string> skies { "studio_small_03.hdr" };
    std::vector<std::vector<double>> rotations { { 20, 130, -70 } };
    if (is_all) {
        skies.insert(skies.end(), { "kloppenheim_05.hdr", "st_fagans_interior.hdr" });
        rotations.insert(rotations.end(), { { 0, 0, 0 }, { 0, 90, 0 }, { -30, 200, 10 }, { 90, 0, 45 } });
    }
    double worst = 0;
    for (const std::string& mesh : meshes)
        for (const std::string& sky : skies) {
            Request request = request_for(mesh, sky);
            const Assets assets = loaded(request);
            for (const auto& rotate : rotations)
                for (const char* model : { "paper", "lobe", "sh" }) {
                    request.light.rotate = rotate;
                    request.light.model = model;
                    const double error = relative_rmse(drawn(assets, request), traced(assets, request));
                    EXPECT_LT(error, 1e-3) << mesh << " " << sky << " " << model;
                    worst = std::max(worst, error);
                }
        }
    RecordProperty("worst", format("{:.3g}", worst));
    if (is_all)
        std::printf("largest relative RMSE: %.3g\n", worst);
}

// Where the seam of the lat-long map crosses the picture, at a pixel's edge and in its middle, and of maps whose own
// seam lies between texels or not.
TEST_F(Picture, SeamOfTheEnvironmentIsNotSeen)
{
    for (const int map_width : { 64, 63 })
        for (const int width : { 100, 101 }) {
            OIIO::ImageBuf sky(OIIO::ImageSpec(map_width, 32, 3, OIIO::TypeFloat));
            for (OIIO::ImageBuf::Iterator<float> pixel(sky); !pixel.done(); ++pixel)
                for (int c = 0; c < 3; ++c)
                    pixel[c] = 1 + float(std::cos(6.2831853 * (pixel.x() + 0.5) / map_width * (c + 1)));
            std::string error;
            auto light = std::make_shared<LightAsset>();
            ASSERT_TRUE(make_cfem_stack(light->light.filtered, sky, {}, error)
                        && make_background(light->panorama, sky, 0, 0, error))
                << error;
            Renderer renderer;
            ASSERT_TRUE(renderer.build(error) && renderer.set_light(light, error)) << error;
            PictureParams params;
            params.has_background = true;
            params.view.camera.forward = { 0, 0, -1 }; // towards the seam
            params.view.camera.half_width = 1;
            params.view.camera.half_height = 0.5;
            RenderParams render;
            render.size = { width, 50 };
            render.spp = 1;
            OIIO::ImageBuf picture;
            ASSERT_TRUE(render_picture(picture, renderer, params, render, error)) << error;
            Background background;
            background.environment = light->panorama;
            double largest = 0;
            for (OIIO::ImageBuf::ConstIterator<float> pixel(picture); !pixel.done(); ++pixel) {
                const Imath::C3f wanted
                    = background.look(params.view.camera.ray(pixel.x() + 0.5, pixel.y() + 0.5, width, 50));
                for (int c = 0; c < 3; ++c)
                    largest = std::max(largest, std::abs(double(pixel[c]) - double(wanted[c])));
            }
            EXPECT_LT(largest, 1e-4) << map_width << " " << width;
        }
}

// A square seen square-on, a texel to a pixel, shows its texels.
TEST_F(Picture, TexelsAtOneToOne)
{
    constexpr int kSide = 32;
    auto mesh = std::make_shared<MeshAsset>();
    mesh->mesh = std::make_shared<Mesh>(square());
    mesh->subject.add(*mesh->mesh);
    auto map = std::make_shared<MapAsset>();
    map->image = full_map(*mesh->mesh, { kSide, kSide });
    map->weights = texel_weights(*mesh->mesh, map->image, kFirstUdim, 0);
    std::vector<float> rgb;
    for (int i = 0; i < 3 * kSide * kSide; ++i)
        rgb.push_back(float(i * 7919 % 1009) / 1009);
    Renderer renderer;
    std::string error;
    ASSERT_TRUE(renderer.build(error) && renderer.set_mesh(mesh, true, error) && renderer.set_map(map, error)) << error;
    renderer.set_texture(0, rgb.data());
    CameraParams straight;
    straight.elevation = 0;
    straight.fov = 0;
    straight.fill = 1;
    PictureParams params;
    params.view.camera = place_camera(straight, mesh->subject, 1, false);
    RenderParams render;
    render.size = { kSide, kSide };
    render.spp = 1;
    OIIO::ImageBuf picture;
    ASSERT_TRUE(render_picture(picture, renderer, params, render, error)) << error;
    for (OIIO::ImageBuf::ConstIterator<float> pixel(picture); !pixel.done(); ++pixel)
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(pixel[c], rgb[size_t(3 * (pixel.y() * kSide + pixel.x()) + c)], 2e-6);
}

// What is drawn quickly, in a window, is the picture but for rounding at edges.
TEST_F(Picture, QuickIsNearlyExact)
{
    Request request = request_for("spot.obj", "forest_slope.hdr");
    const Assets assets = loaded(request);
    Renderer renderer;
    PictureParams params;
    std::string error;
    ASSERT_NO_FATAL_FAILURE(show_lit(renderer, assets, request));
    params.has_background = true;
    params.view.camera = place_camera(request.camera, assets.mesh->subject, 96.0 / 72, false);
    OIIO::ImageBuf exact;
    ASSERT_TRUE(render_picture(exact, renderer, params, request.render, error)) << error;
    PictureSum sum;
    sum.start(96, 72, request.render.spp, request.render.filter);
    while (!sum.is_complete())
        sum.add(renderer, params);
    EXPECT_LT(relative_rmse(read_image_of(sum.mean_framebuffer()), exact), 0.02);
}

// Suns and the bounce are added to what shaders and make_lightmap() find.
TEST_F(HeadlessPicture, TracedLightIsAdded)
{
    Request request = request_for("gazebo.obj", "kloppenheim_05.hdr");
    request.mesh.vismap_params.resolution = { 64, 64 };
    request.light.rotate = { 0, 40, 0 };
    for (const char* model : { "lobe", "mask" }) {
        request.light.model = model;
        request.trace = {};
        const Assets plain = loaded(request);
        const OIIO::ImageBuf without = drawn(plain, request);
        EXPECT_TRUE(plain.light->light.suns.empty());
        request.trace.suns = "on";
        const Assets split = loaded(request);
        EXPECT_FALSE(split.light->light.suns.empty());
        EXPECT_LT(relative_rmse(drawn(split, request), traced(split, request)), 1e-3) << model;
        EXPECT_GT(relative_rmse(drawn(split, request), without), 0.05) << model;
        request.trace.bounce.bounce = "auto";
        const Assets bounced = loaded(request);
        EXPECT_LT(relative_rmse(drawn(bounced, request), traced(bounced, request)), 1e-3) << model;
        EXPECT_GT(relative_rmse(drawn(bounced, request), drawn(split, request)), 0.01) << model;
    }
}

// Other models are lit by make_lightmap().
TEST_F(HeadlessPicture, ModelsWithoutAShader)
{
    Request request = request_for("spot.obj", "studio_small_03.hdr");
    request.light.model = "mask";
    request.mesh.vismap_params.resolution = { 64, 64 };
    const Assets assets = loaded(request);
    EXPECT_LT(relative_rmse(drawn(assets, request), traced(assets, request)), 1e-3);
}
