// SPDX-License-Identifier: Apache-2.0
#include "loading.h"

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/cfem/radiance.h>
#include <vmlight/frame/scene_light.h>
#include <vmlight/image/channels.h>
#include <vmlight/stage/recipe/chain.h>
#include <vmlight/uv/udim.h>
#include <vmlight/vismap/baker.h>

#include <algorithm>
#include <future>
#include <string>
#include <utility>
#include <vector>

namespace vmlight::view {

VismapParams bake_params(const VismapParams& asked, const std::string& model)
{
    VismapParams params = asked;
    if (params.basis == "vector") {
        // `auto` has the best that is shaded on the graphics card.
        const ModelEntry* entry = find_model_entry(model == "auto" ? "sh" : model);
        params.basis = entry && *entry->basis ? entry->basis : params.basis;
    }
    for (const char* channel : { "normal" })
        if (!params.has(channel))
            params.channels.insert(params.channels.begin(), channel);
    return params;
}

MapPointer bake_map(const MeshAsset& mesh, const std::string& model, int samples, int threads, const Progress& progress,
                    std::string& error)
{
    VismapParams params = bake_params(mesh.recipe.vismap_params, model);
    params.samples = samples;
    OIIO::ImageBuf image;
    if (!make_vismap(image, mesh.scene, params, nullptr, threads, progress)) {
        error = oiio::error_line(image);
        return nullptr;
    }
    return make_map_asset(std::move(image), samples, mesh, threads);
}

bool load_assets(Assets& dst, const Request& request, const MakeOptions& options, std::string& error)
{
    // A stored map is read beside the environment: neither needs the other.
    OIIO::ImageBuf map;
    std::vector<std::string> said, warnings;
    std::future<std::string> map_fault;
    if (!request.vismap.empty() && !has_udim_pattern(request.vismap) && recipe_stage(request.vismap).empty())
        map_fault = std::async(std::launch::async, [&] {
            MakeOptions aside;
            aside.threads = options.threads;
            aside.say = [&](const std::string& line) { said.push_back(line); };
            aside.warn = [&](const std::string& line) { warnings.push_back(line); };
            std::string fault;
            return read_map_image(map, request.vismap, aside, fault) ? "" : fault;
        });
    std::string space;
    dst.trace = request.trace;
    if (!choose_trace(dst.trace, request.vismap, options, error))
        return false;
    if (!request.environment.empty()) {
        CfemRecipe filter = request.filter;
        filter.suns = dst.trace.suns == "off" ? "off" : "auto";
        dst.light = read_light_asset(request.environment, filter, request.view.background_blur, options, error);
        if (!dst.light)
            return false;
        space = dst.light->light.space;
    }
    dst.mesh
        = read_mesh_asset(request.mesh, !request.vismap.empty(), space, request.filter.colorconfig, options, error);
    if (!dst.mesh)
        return false;
    if (map_fault.valid()) {
        error = map_fault.get();
        for (const std::string& line : said)
            options.report(line);
        for (const std::string& line : warnings)
            options.report_warning(line);
        if (error.empty())
            dst.map = make_map_asset(std::move(map), request.vismap, *dst.mesh, options.threads);
    } else if (!request.vismap.empty()) {
        dst.map = read_map_asset(request.vismap, *dst.mesh, options, error);
    } else {
        const VismapParams& params = dst.mesh->recipe.vismap_params;
        const Size size = params.size();
        dst.map = bake_map(*dst.mesh, request.light.model, params.samples, options.threads,
                           options.step("bake", size.width, size.height), error);
    }
    return dst.map != nullptr;
}

bool model_for(ShadingModel& dst, const std::string& model, const MapAsset& map, const LightAsset& light,
               std::string& error)
{
    LightmapParams params;
    params.model = model;
    return choose_model(dst, params, map.image.spec(), has_all_light(light.filtered()), error);
}

bool light_params(LightmapParams& dst, const LightmapParams& asked, double turn, std::string& error)
{
    Rotation pose;
    if (!object_pose(pose, asked, error))
        return false;
    dst = turned_light(asked, pose, turn);
    return true;
}

} // namespace vmlight::view
