// SPDX-License-Identifier: Apache-2.0
/// Small scenes for tests of frames.
#pragma once

#include "scenes.h"

#include <vmlight/frame/render.h>

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace vmlight::frame_scenes {

inline std::shared_ptr<const Mesh> shared(Mesh mesh)
{
    return std::make_shared<const Mesh>(std::move(mesh));
}

inline std::shared_ptr<TileTexture> texture_of(int width, int height, const std::vector<float>& rgb)
{
    auto texture = std::make_shared<TileTexture>(3);
    texture->set(1001, TexturePyramid(width, height, 3, rgb.data(), nullptr));
    return texture;
}

inline FrameSurface surface_of(Mesh mesh, const std::vector<float>& color = { 1, 1, 1 })
{
    FrameSurface surface;
    surface.mesh = shared(std::move(mesh));
    surface.light = texture_of(1, 1, color);
    return surface;
}

inline FrameScene scene_of(std::vector<FrameSurface> surfaces)
{
    FrameScene scene;
    scene.surfaces = std::move(surfaces);
    std::string error;
    EXPECT_TRUE(scene.build(1, error)) << error;
    return scene;
}

// Looks along -z at the square from -1 to 1.
inline Camera square_on(bool is_orthographic = true)
{
    Camera camera;
    camera.position = Imath::V3d(0, 0, 5);
    camera.is_orthographic = is_orthographic;
    camera.half_width = camera.half_height = is_orthographic ? 1 : 0.2;
    return camera;
}

inline OIIO::ImageBuf rendered(const FrameScene& scene, const Camera& camera, const RenderParams& params,
                               int nthreads = 2)
{
    OIIO::ImageBuf image;
    std::string error;
    EXPECT_TRUE(render_frame(image, scene, camera, params, nthreads, {}, error)) << error;
    return image;
}

inline RenderParams params_of(int side, int spp = 1, const char* filter = "box")
{
    RenderParams params;
    params.size = { side, side };
    params.spp = spp;
    params.filter = filter;
    return params;
}

inline std::vector<float> pixel(const OIIO::ImageBuf& image, int x, int y)
{
    std::vector<float> values(size_t(image.nchannels()));
    image.getpixel(x, y, values.data());
    return values;
}

} // namespace vmlight::frame_scenes
