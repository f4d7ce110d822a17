// SPDX-License-Identifier: Apache-2.0
// Strands in the view: their light, and their share of the pixels.
#include "strand_view.h"
#include "view_pictures.h"

#include "vmview/render/picture.h"

#include <OpenImageIO/imagebuf.h>

#include <gmock/gmock.h>

#include <string>
#include <vector>

using namespace vmlight;
using namespace vmlight::view;

namespace {

using StrandView = StrandViewTest;

double mean_alpha(const OIIO::ImageBuf& image)
{
    double sum = 0;
    for (OIIO::ImageBuf::ConstIterator<float> pixel(image); !pixel.done(); ++pixel)
        sum += double(pixel[3]);
    return sum / double(image.spec().image_pixels());
}

} // namespace

// On the graphics card as by make_lightmap().
TEST_F(StrandView, IsLitAsInFrames)
{
    Request request = request_for(groom, "kloppenheim_05.hdr");
    request.light.rotate = { 20, 130, -70 };
    const Assets assets = loaded(request);
    for (const char* model : { "ao", "lobe", "sh" }) {
        request.light.model = model;
        Renderer renderer;
        ASSERT_NO_FATAL_FAILURE(show_lit(renderer, assets, request));
        const auto objects = lit_objects(assets, request);
        const OIIO::ImageBuf& lightmap = objects[0]->lightmaps().at(1001);
        std::vector<float> wanted, rgb;
        const std::vector<float> texels = renderer.read_texture(0);
        for (OIIO::ImageBuf::ConstIterator<float> texel(lightmap); !texel.done(); ++texel)
            wanted.insert(wanted.end(), { texel[0], texel[1], texel[2] });
        for (size_t i = 0; i < texels.size(); i += 4)
            rgb.insert(rgb.end(), { texels[i], texels[i + 1], texels[i + 2] });
        EXPECT_LT(largest_difference(rgb, wanted), 1e-5) << model;
    }
}

// However thin strands are, one quick sample shows as many of their pixels as they cover of all: but for chance, of the
// few pixels that the thinnest have, a quarter of which 16 samples leave.
TEST_F(StrandView, QuickKeepsTheirShareOfPixels)
{
    for (const char* radius : { "0.02", "0.004", "0.001", "0.0002" }) { // from 3 pixels to a thirtieth of one
        Request request = request_for(groom, "studio_small_03.hdr");
        request.mesh.strand_params.radius = radius;
        const Assets assets = loaded(request);
        Renderer renderer;
        ASSERT_NO_FATAL_FAILURE(show_lit(renderer, assets, request));
        PictureParams params;
        params.view.camera = place_camera(request.camera, assets.mesh->subject, 4.0 / 3, false);
        RenderParams render = request.render;
        render.spp = 64;
        OIIO::ImageBuf exact;
        std::string error;
        ASSERT_TRUE(render_picture(exact, renderer, params, render, error)) << error;
        for (const int spp : { 1, 16 }) {
            PictureSum sum;
            sum.start(120, 90, spp, "box");
            while (!sum.is_complete())
                sum.add(renderer, params);
            const OIIO::ImageBuf quick = read_image_of(sum.mean_framebuffer());
            const double share = mean_alpha(quick) / mean_alpha(exact);
            EXPECT_NEAR(share, 1, spp == 1 ? 0.25 : 0.1) << radius << " " << spp;
        }
    }
}

// What is not strands is no strands beside a mesh; and strands need the whole light.
TEST_F(StrandView, WhatItCannotShowIsRefused)
{
    const auto refusal = [](const Request& request) {
        Assets assets;
        std::string error;
        EXPECT_FALSE(load_assets(assets, request, {}, error));
        return error;
    };
    Request request = request_for(groom, "studio_small_03.hdr");
    request.view.object = { data_path("spot.obj") };
    EXPECT_THAT(refusal(request), testing::HasSubstr("is no file of strands; only they can be beside MESH"));
    request.view.object.clear();
    request.vismap = folder.write("hero.vismap", "mesh = \"" + data_path("cases/box.obj") + "\"\nsamples = 1\n");
    EXPECT_THAT(refusal(request), testing::HasSubstr("a visibility map of a mesh, not of strands"));
    request.vismap.clear();
    request.mesh.strand_params.radius.clear();
    EXPECT_THAT(refusal(request), testing::HasSubstr("--radius ROOT:TIP"));
}
