// SPDX-License-Identifier: Apache-2.0
/// Strands in the view, alone and beside a mesh, and the same as frames have them.
#pragma once

#include "view_test.h"

#include "strand_files.h"
#include "temporary_folder.h"
#include "vmview/scene/loading.h"

#include <vmlight/frame/frame_object.h>

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace vmlight::view {

/// Curls in a folder, and requests for pictures of them.
class StrandViewTest : public DrawingTest
{
protected:
    void SetUp() override
    {
        DrawingTest::SetUp();
        groom = folder.write("curls.tfx", strand_files::tfx_of(strand_files::curls(120, 1)));
    }

    Request request_for(const std::string& mesh, const std::string& environment, bool is_beside = false) const
    {
        Request request;
        request.mesh.mesh = mesh;
        if (is_beside)
            request.view.object = { groom };
        request.environment = data_path(environment);
        request.mesh.strand_params.radius = "0.006:0.002";
        request.mesh.vismap_params.resolution = { 64, 64 };
        request.mesh.vismap_params.samples = 16;
        request.view.background = "environment";
        request.view.strand_color = { 0.9, 0.5, 0.25 };
        request.render.size = { 120, 90 };
        request.render.spp = 4;
        request.render.sampling = "all"; // as vmview samples
        return request;
    }

    const TemporaryFolder folder;
    std::string groom;
};

/// All objects as vmframes lights them, each with a map of its own bake.
inline std::vector<std::unique_ptr<FrameObject>> lit_objects(const Assets& assets, const Request& request)
{
    std::vector<std::unique_ptr<FrameObject>> objects;
    std::vector<FrameSurface> surfaces;
    std::string error;
    LightmapParams light;
    EXPECT_TRUE(light_params(light, request.light, 0, error)) << error;
    std::vector<std::string> paths { request.mesh.mesh };
    paths.insert(paths.end(), request.view.object.begin(), request.view.object.end());
    for (const std::string& path : paths) {
        ObjectRecipe recipe;
        recipe.map = request.mesh;
        recipe.map.mesh = path;
        recipe.trace = request.trace;
        objects.push_back(make_frame_object(recipe));
        FrameObject& object = *objects.back();
        EXPECT_TRUE(object.open(recipe, {}, error) && object.read_materials(assets.light->light.space, "", {}, error))
            << error;
        if (object.surface().strands)
            object.surface().strand_color = { 0.9f, 0.5f, 0.25f };
        surfaces.push_back(object.surface());
    }
    for (size_t i = 0; i < objects.size(); ++i) {
        std::vector<FrameSurface> others = surfaces;
        others.erase(others.begin() + std::ptrdiff_t(i));
        objects[i]->set_occluders(std::move(others));
        EXPECT_TRUE(objects[i]->light(assets.light->light, light, {}, {}, error)) << error;
    }
    return objects;
}

} // namespace vmlight::view
