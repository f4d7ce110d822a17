// SPDX-License-Identifier: Apache-2.0
/// Whole pictures of vmview, and how far two are apart.
#pragma once

#include "view_test.h"

#include "vmview/headless.h"
#include "vmview/render/lighting.h"
#include "vmview/scene/loading.h"

#include <vmlight/frame/lit_object.h>
#include <vmlight/frame/texel_weights.h>

#include <cmath>
#include <memory>

namespace vmlight::view {

/// Pictures that bring a context of their own.
class HeadlessPicture : public ::testing::Test
{
protected:
    void SetUp() override
    {
        std::string error;
        if (!HeadlessContext::open(error))
            GTEST_SKIP() << error;
    }
};

/// A picture of a file of tests/data in one of its environments.
inline Request request_for(const std::string& mesh, const std::string& environment)
{
    Request request;
    request.mesh.mesh = data_path(mesh);
    request.environment = data_path(environment);
    request.mesh.vismap_params.resolution = { 128, 128 };
    request.mesh.vismap_params.samples = 16;
    request.view.background = "environment";
    request.render.size = { 96, 72 };
    request.render.spp = 4;
    request.render.sampling = "all"; // as vmview samples; `edges` mixes inner pixels from their corners
    return request;
}

/// The same picture by the renderer of vmframes.
inline OIIO::ImageBuf traced(const Assets& assets, const Request& request)
{
    const MeshAsset& mesh = *assets.mesh;
    std::string error;
    LightmapParams light;
    EXPECT_TRUE(light_params(light, request.light, 0, error)) << error;
    OIIO::ImageBuf lightmap, picture;
    FrameSurface white;
    white.mesh = mesh.mesh;
    white.materials = mesh.materials;
    white.material_uvs = mesh.material_uvs;
    TracedLight added(request.trace, mesh.scene, mesh.recipe.vismap_params.udim, white, {});
    EXPECT_TRUE(added.light(assets.map->image, assets.light->light, light, {}, error)) << error;
    EXPECT_TRUE(make_lightmap(lightmap, assets.map->image, assets.light->filtered(), added.suns(), added.bounce(),
                              light, nullptr, 0, {}))
        << lightmap.geterror();
    const auto texture = std::make_shared<TileTexture>(3);
    texture->set(mesh.recipe.vismap_params.udim,
                 TexturePyramid(lightmap.spec().width, lightmap.spec().height, 3,
                                static_cast<const float*>(lightmap.localpixels()), assets.map->weights.data()));
    FrameScene scene;
    FrameSurface& surface = scene.surfaces.emplace_back();
    surface.mesh = mesh.mesh;
    surface.light = texture;
    surface.materials = mesh.materials;
    surface.material_uvs = mesh.material_uvs;
    scene.background.is_visible = request.view.background == "environment";
    scene.background.environment = assets.light->panorama;
    LightmapParams own = request.light;
    own.env_rotate.clear();
    Rotation pose;
    EXPECT_TRUE(lightmap_rotation(pose, own, error) && lightmap_rotation(scene.background.rotation, light, error)
                && scene.build(0, error))
        << error;
    Subject subject;
    subject.add(*mesh.mesh, pose);
    const Size size = request.render.size;
    const Camera camera
        = camera_for(place_camera(request.camera, subject, double(size.width) / size.height, false), pose);
    RenderParams params = request.render;
    params.sampling = "all"; // as the view samples every pixel
    EXPECT_TRUE(render_frame(picture, scene, camera, params, 0, {}, error)) << error;
    return picture;
}

inline Assets loaded(const Request& request)
{
    Assets assets;
    std::string error;
    EXPECT_TRUE(load_assets(assets, request, {}, error)) << error;
    return assets;
}

inline OIIO::ImageBuf drawn(const Assets& assets, const Request& request)
{
    OIIO::ImageBuf picture;
    std::string error;
    EXPECT_TRUE(render_headless(picture, assets, request, error)) << error;
    return picture;
}

/// Let `renderer` show these assets in the light of `request`.
inline void show_lit(Renderer& renderer, const Assets& assets, const Request& request)
{
    LightmapParams light;
    std::string error;
    ASSERT_TRUE(renderer.build(error) && renderer.set_mesh(assets.mesh, true, error)
                && renderer.set_map(assets.map, error) && renderer.set_light(assets.light, error)
                && light_params(light, request.light, 0, error) && show_surface(renderer, 0, "lit", light, error))
        << error;
}

/// Over the mean of `b`.
inline double relative_rmse(const OIIO::ImageBuf& a, const OIIO::ImageBuf& b)
{
    double squares = 0, sum = 0;
    OIIO::ImageBuf::ConstIterator<float> x(a), y(b);
    for (; !x.done(); ++x, ++y)
        for (int c = 0; c < 3; ++c) {
            squares += (x[c] - y[c]) * (x[c] - y[c]);
            sum += y[c];
        }
    const double count = 3.0 * double(a.spec().image_pixels());
    return std::sqrt(squares / count) / (sum / count);
}

} // namespace vmlight::view
