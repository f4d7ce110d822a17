// SPDX-License-Identifier: Apache-2.0
// The picture in the window, without one: light that is traced in the background while the mouse drags.
#include "view_test.h"

#include "strand_files.h"
#include "temporary_folder.h"
#include "vmview/scene/loading.h"
#include "vmview/ui/viewport.h"

#include <OpenImageIO/imagebufalgo.h>

#include <gmock/gmock.h>

#include <chrono>
#include <thread>

using namespace vmlight;
using namespace vmlight::view;
using namespace vmlight::strand_files;

namespace {

class ViewportTest : public DrawingTest
{
protected:
    static Request sunny_request()
    {
        Request request;
        request.mesh.mesh = data_path("gazebo.obj");
        request.environment = data_path("kloppenheim_05.hdr");
        request.mesh.vismap_params.resolution = { 64, 64 };
        request.mesh.vismap_params.samples = 16;
        request.light.model = "lobe";
        request.trace.suns = "on";
        request.trace.bounce.bounce = "auto";
        return request;
    }
    static Assets loaded(const Request& request)
    {
        Assets assets;
        std::string error;
        EXPECT_TRUE(load_assets(assets, request, {}, error)) << error;
        return assets;
    }
    // Until nothing is left to trace.
    static bool settle(Viewport& viewport, const ViewState& state, bool is_dragging)
    {
        for (int i = 0; i < 6000; ++i) {
            viewport.update(state, 64, 48, is_dragging);
            EXPECT_EQ(viewport.problem(), "");
            if (!viewport.is_tracing() && viewport.activity().empty())
                return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        return false;
    }
    static void show(Viewport& viewport, const Assets& assets)
    {
        std::string error;
        ASSERT_TRUE(viewport.build("", error)) << error;
        viewport.set_mesh(assets.mesh);
        viewport.set_map(assets.map);
        viewport.set_light(assets.light);
    }
    static std::vector<float> texels(const Viewport& viewport) { return viewport.renderer().read_texture(0); }
};

} // namespace

TEST_F(ViewportTest, TracesWhatWasTurnedWhileTheMouseDrags)
{
    const Request request = sunny_request();
    const Assets assets = loaded(request);
    Viewport viewport(4, "box", 2, [] {});
    ASSERT_NO_FATAL_FAILURE(show(viewport, assets));
    ViewState state = state_of(request);
    // The picture is there at once, and never waits for rays.
    viewport.update(state, 64, 48, false);
    EXPECT_TRUE(viewport.is_tracing());
    EXPECT_TRUE(viewport.renderer().has_texture(0));
    for (int i = 0; i < 40; ++i) {
        turn_object(state, 3, 0);
        viewport.update(state, 64, 48, true);
    }
    ASSERT_TRUE(settle(viewport, state, false));
    const std::vector<float> seen = texels(viewport);

    // However it was turned to get there.
    Viewport still(4, "box", 2, [] {});
    ASSERT_NO_FATAL_FAILURE(show(still, assets));
    ASSERT_TRUE(settle(still, state, false));
    EXPECT_EQ(texels(still), seen);

    // What is switched off is gone, and comes back.
    ViewState plain = state;
    plain.trace.bounce.bounce = "off";
    ASSERT_TRUE(settle(viewport, plain, false));
    EXPECT_NE(texels(viewport), seen);
    plain.trace.suns = "off";
    ASSERT_TRUE(settle(viewport, plain, false));
    EXPECT_FALSE(viewport.is_tracing());
    ASSERT_TRUE(settle(viewport, state, false));
    EXPECT_EQ(texels(viewport), seen);
    viewport.stop();
}

// Models that are lit on the processor, and a wipe between two: each has the light of its own bounce.
TEST_F(ViewportTest, BothSidesOfAWipeHaveTheirLight)
{
    Request request = sunny_request();
    request.light.model = "mask";
    const Assets assets = loaded(request);
    Viewport viewport(1, "box", 2, [] {});
    ASSERT_NO_FATAL_FAILURE(show(viewport, assets));
    ViewState state = state_of(request);
    state.second = "paper";
    ASSERT_TRUE(settle(viewport, state, false));
    const std::vector<float> mask = texels(viewport), paper = viewport.renderer().read_texture(1);
    std::swap(state.light.model, state.second);
    ASSERT_TRUE(settle(viewport, state, false));
    EXPECT_EQ(viewport.renderer().read_texture(1), mask);
    EXPECT_EQ(texels(viewport), paper);
}

// Strands beside a mesh have their suns, whatever the model of the mesh; and beside its traced reference.
TEST_F(ViewportTest, StrandsBesideAMeshHaveTheirLight)
{
    const TemporaryFolder folder;
    Request request = sunny_request();
    request.light.model = "mask"; // which is lit on the processor
    request.trace.bounce.bounce = "off";
    request.mesh.strand_params.radius = "0.02";
    request.view.object = { folder.write("curls.tfx", tfx_of(curls(9, 1))) };
    const Assets assets = loaded(request);
    Viewport viewport(1, "box", 2, [] {});
    ASSERT_NO_FATAL_FAILURE(show(viewport, assets));
    const auto strands = [&] { return viewport.renderer().read_texture(0, 1); };
    ViewState state = state_of(request);
    ASSERT_TRUE(settle(viewport, state, false));
    const std::vector<float> lit = strands();
    for (const char* model : { "paper", "reference" }) {
        state.light.model = model;
        viewport.update(state, 64, 48, false);
        for (int i = 0; i < 6000 && viewport.is_tracing(); ++i) {
            viewport.update(state, 64, 48, false);
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        viewport.update(state, 64, 48, false);
        EXPECT_EQ(largest_difference(strands(), lit), 0) << model;
    }
    state.trace.suns = "off";
    viewport.update(state, 64, 48, false);
    viewport.update(state, 64, 48, false);
    EXPECT_NE(strands(), lit);
    viewport.stop();
}

// What is closed or replaced while light is traced leaves nothing behind.
TEST_F(ViewportTest, StopsWhileItTraces)
{
    const Request request = sunny_request();
    const Assets assets = loaded(request);
    for (int i = 0; i < 6; ++i) {
        Viewport viewport(1, "box", 2, [] {});
        ASSERT_NO_FATAL_FAILURE(show(viewport, assets));
        ViewState state = state_of(request);
        viewport.update(state, 64, 48, false);
        std::this_thread::sleep_for(std::chrono::milliseconds(10 * i));
        if (i % 2) {
            viewport.set_light(assets.light);
            ASSERT_TRUE(settle(viewport, state, false));
        }
    }
}

// As long as it is so: not for a frame, and not with the light of what was chosen before.
TEST_F(ViewportTest, WhatCannotBeShownIsBlackAndSaid)
{
    Request request = sunny_request();
    request.trace.suns = request.trace.bounce.bounce = "off";
    const Assets assets = loaded(request);
    Viewport viewport(1, "box", 2, [] {});
    ASSERT_NO_FATAL_FAILURE(show(viewport, assets));
    ViewState state = state_of(request);
    ASSERT_TRUE(settle(viewport, state, false));
    const std::vector<float> lobe = texels(viewport);
    const auto is_black = [](const std::vector<float>& texels) {
        bool result = !texels.empty();
        for (size_t i = 0; i < texels.size(); ++i)
            result &= i % 4 == 3 || texels[i] == 0;
        return result;
    };
    const auto expect_problem = [&](const std::string& text) {
        for (int frame = 0; frame < 3; ++frame) {
            viewport.update(state, 64, 48, false);
            EXPECT_THAT(viewport.problem(), testing::HasSubstr(text)) << frame;
        }
    };
    state.light.model = "cells";
    expect_problem("cells");
    EXPECT_TRUE(is_black(texels(viewport)));
    EXPECT_EQ(viewport.model(), "");
    state.show = "error";
    expect_problem("the visibility map has no channel \"error\"; bake it with makevismap --channels error");
    EXPECT_TRUE(is_black(texels(viewport)));
    state = state_of(request);
    state.second = "cells";
    expect_problem("cells");
    EXPECT_TRUE(is_black(viewport.renderer().read_texture(1)));
    EXPECT_EQ(texels(viewport), lobe);
    state.second.clear();
    ASSERT_TRUE(settle(viewport, state, false));
    EXPECT_EQ(texels(viewport), lobe);
}

TEST_F(ViewportTest, WithoutRoomForATextureTheSurfaceIsWhite)
{
    const TemporaryFolder folder;
    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    OIIO::ImageBuf wide(OIIO::ImageSpec(most + 1, 1, 3, OIIO::TypeDesc::UINT8));
    ASSERT_TRUE(wide.write(folder / "wide.png")) << wide.geterror();
    folder.write("card.mtl", "newmtl paint\nmap_Kd wide.png\n");
    Request request = sunny_request();
    request.trace.suns = request.trace.bounce.bounce = "off";
    request.mesh.mesh = folder.write("card.obj",
                                     "mtllib card.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                                     "usemtl paint\nf 1/1 2/2 3/3\n");
    const Assets assets = loaded(request);
    Viewport viewport(1, "box", 2, [] {});
    ASSERT_NO_FATAL_FAILURE(show(viewport, assets));
    ViewState state = state_of(request);
    for (int frame = 0; frame < 3; ++frame) {
        viewport.update(state, 64, 48, false);
        EXPECT_THAT(viewport.problem(), testing::HasSubstr(std::to_string(most + 1)));
    }
    const OIIO::ImageBuf shown = viewport.screenshot();
    state.is_white = true;
    ASSERT_TRUE(settle(viewport, state, false));
    EXPECT_EQ(OIIO::ImageBufAlgo::compare(viewport.screenshot(), shown, 0, 0).nfail, 0);
}
