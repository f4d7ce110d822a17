// SPDX-License-Identifier: Apache-2.0
#include "loading.h"

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/cfem/radiance.h>
#include <vmlight/frame/frame_object.h>
#include <vmlight/frame/object_mesh.h>
#include <vmlight/frame/scene_light.h>
#include <vmlight/frame/strand_light.h>
#include <vmlight/image/channels.h>
#include <vmlight/stage/recipe/chain.h>
#include <vmlight/stage/recipe/strand_recipe.h>
#include <vmlight/uv/udim.h>
#include <vmlight/vismap/baker.h>

#include <algorithm>
#include <future>
#include <string>
#include <utility>
#include <vector>

namespace vmlight::view {

MeshRequest mesh_request(const Request& request)
{
    MeshRequest dst { request.mesh, request.view.object, { 1, 1, 1 } };
    const std::vector<double>& color = request.view.strand_color;
    for (size_t c = 0; c < color.size(); ++c)
        dst.strand_color[int(c)] = float(color[c]);
    return dst;
}

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

VismapParams strand_bake_params(const VismapParams& asked, const std::string& model)
{
    VismapParams params = asked;
    params.basis = basis_for(strand_model(model), asked.basis);
    return params;
}

MapPointer bake_map(const MeshAsset& mesh, const std::string& model, int samples, const MakeOptions& options,
                    std::string& error)
{
    OIIO::ImageBuf image;
    if (mesh.is_strands()) {
        VismapRecipe recipe = mesh.recipe;
        recipe.vismap_params = strand_bake_params(recipe.vismap_params, model);
        recipe.vismap_params.samples = samples;
        if (!bake_strand_map(image, mesh.strands, *mesh.strand_scene, recipe, options, error))
            return nullptr;
    } else {
        VismapParams params = bake_params(mesh.recipe.vismap_params, model);
        params.samples = samples;
        const Size size = params.size();
        if (!make_vismap(image, mesh.scene, params, nullptr, options.threads,
                         options.step("bake", size.width, size.height))) {
            error = oiio::error_line(image);
            return nullptr;
        }
    }
    return with_maps_beside(make_map_asset(std::move(image), samples, mesh, options.threads), mesh, model, samples,
                            options, error);
}

MapPointer with_maps_beside(MapPointer map, const MeshAsset& mesh, const std::string& model, int samples,
                            const MakeOptions& options, std::string& error)
{
    if (!map || mesh.beside.empty())
        return map;
    auto all = std::make_shared<MapAsset>(*map);
    all->beside.clear();
    for (const MeshPointer& other : mesh.beside) {
        all->beside.push_back(bake_map(*other, model, samples, options, error));
        if (!all->beside.back())
            return nullptr;
    }
    return all;
}

bool load_assets(Assets& dst, const Request& request, const MakeOptions& options, std::string& error)
{
    // A stored map is read beside the environment: neither needs the other.
    OIIO::ImageBuf map;
    std::vector<std::string> said, warnings;
    std::future<std::string> map_fault;
    const bool is_of_mesh = !is_strand_occluder(request.mesh, request.mesh.mesh);
    if (is_of_mesh && !request.vismap.empty() && !has_udim_pattern(request.vismap)
        && recipe_stage(request.vismap).empty())
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
        dst.light = read_light_asset(request.environment, filter, request.view.background_blur, request.specular,
                                     options, error);
        if (!dst.light)
            return false;
        space = dst.light->light.space;
    }
    dst.mesh = read_mesh_asset(mesh_request(request), !request.vismap.empty(), space, request.filter.colorconfig,
                               options, error);
    if (!dst.mesh)
        return false;
    const int samples = request.mesh.vismap_params.samples;
    if (map_fault.valid()) {
        error = map_fault.get();
        for (const std::string& line : said)
            options.report(line);
        for (const std::string& line : warnings)
            options.report_warning(line);
        if (!error.empty())
            return false;
        warn_of_other_mesh(*dst.mesh->mesh, dst.mesh->recipe.mesh_params.uv_set, map.spec(), request.vismap, options);
        dst.map = make_map_asset(std::move(map), request.vismap, *dst.mesh, options.threads);
    } else if (!request.vismap.empty()) {
        dst.map = read_map_asset(request.vismap, *dst.mesh, options, error);
    } else {
        dst.map = bake_map(*dst.mesh, request.light.model, samples, options, error);
        return dst.map != nullptr;
    }
    dst.map = with_maps_beside(dst.map, *dst.mesh, request.light.model, samples, options, error);
    return dst.map != nullptr;
}

bool model_for(ShadingModel& dst, const std::string& model, const MapAsset& map, const LightAsset& light,
               std::string& error)
{
    LightmapParams params;
    params.model = model;
    if (kernel_of(map.image.spec()) == kStrandKernel) {
        params.model = strand_model(model);
        error = strand_light_fault(light.light, map.path.empty() ? "the environment" : map.path);
        if (!error.empty())
            return false;
    }
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
