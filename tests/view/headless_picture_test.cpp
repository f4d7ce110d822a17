// SPDX-License-Identifier: Apache-2.0
// Pictures without a window: exposure, false colors, and what they refuse.
#include "view_pictures.h"

#include "temporary_folder.h"
#include "vmview/render/false_color.h"

#include <vmlight/image/channels.h>
#include <vmlight/lightmap/light_level.h>

#include <gmock/gmock.h>

using namespace vmlight;
using namespace vmlight::view;
using testing::HasSubstr;

namespace {

using HeadlessView = HeadlessPicture;

std::string refusal(const Assets& assets, const Request& request)
{
    OIIO::ImageBuf picture;
    std::string error;
    EXPECT_FALSE(render_headless(picture, assets, request, error));
    return error;
}

} // namespace

// Measured on a small picture, as vmframes does.
TEST_F(HeadlessView, AutomaticExposureMakesTheMeanMiddleGray)
{
    Request request = request_for("spot.obj", "studio_small_03.hdr");
    request.light.model = "paper";
    request.view.background = "none";
    const Assets assets = loaded(request);
    request.is_auto_exposed = true;
    const OIIO::ImageBuf picture = drawn(assets, request);
    EXPECT_NEAR(covered_luminance(picture, assets.light->light.space), 0.18, 0.18 * 0.03);
    const float stops = picture.spec().get_float_attribute("vmlight:exposure");
    EXPECT_LT(stops, -1);
    request.is_auto_exposed = false;
    request.light.exposure = double(stops);
    EXPECT_LT(relative_rmse(drawn(assets, request), picture), 1e-6);
}

// An open square has V = 1 and B = (2/3) n.
TEST_F(HeadlessView, FalseColorsOfAnOpenSquare)
{
    const TemporaryFolder folder;
    Request request;
    request.mesh.mesh = folder.write("square.obj",
                                     "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 "
                                     "1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1 4/4/1\n");
    request.mesh.vismap_params.resolution = { 8, 8 };
    request.mesh.vismap_params.samples = 4;
    request.mesh.vismap_params.channels = { kErrorChannel };
    request.render.size = { 8, 8 };
    request.camera.elevation = 0;
    const Assets assets = loaded(request);
    const auto middle = [&](const char* show) {
        request.view.show = show;
        const OIIO::ImageBuf picture = drawn(assets, request);
        float rgba[4] = {};
        picture.getpixel(4, 4, rgba);
        return std::vector<float>(rgba, rgba + 3);
    };
    const auto near = [](float r, float g, float b) {
        return testing::Pointwise(testing::FloatNear(1e-5f), std::vector<float> { r, g, b });
    };
    EXPECT_THAT(middle("visibility"), near(1, 1, 1));
    EXPECT_THAT(middle("direction"), near(0.5f, 0.5f, 0.5f + 1.0f / 3));
    EXPECT_THAT(middle("ratio"), near(2.0f / 3, 2.0f / 3, 2.0f / 3));
    EXPECT_THAT(middle("error"), near(0, 0, 0));
    float rgb[3];
    find_false_color("error")->color(nullptr, 0.05f, rgb);
    EXPECT_THAT(std::vector<float>(rgb, rgb + 3), near(1, 0.5f, 0)) << "half of the scale";
}

TEST_F(HeadlessView, WhatCannotBeDrawnIsRefused)
{
    const TemporaryFolder folder;
    Request request = request_for("spot.obj", "studio_small_03.hdr");
    request.light.model = "paper";
    Assets assets = loaded(request);
    request.camera.camera = "shot";
    EXPECT_THAT(refusal(assets, request), HasSubstr("\"shot\""));
    request.camera.camera.clear();
    auto filtered = std::make_shared<LightAsset>(*assets.light);
    filtered->panorama.reset();
    assets.light = filtered;
    EXPECT_THAT(refusal(assets, request), HasSubstr("--background environment needs the environment itself"));
    // Files that are not what they are given as.
    const std::string stack = folder / "stack.exr";
    ASSERT_TRUE(data_light("studio_small_03.hdr", { 16, 8 })[0].write(stack));
    std::string error;
    for (const std::string& path : { data_path("studio_small_03.hdr"), stack, folder / "none.exr" }) {
        request.vismap = path;
        EXPECT_FALSE(load_assets(assets, request, {}, error));
        EXPECT_THAT(error, HasSubstr(path));
    }
}
