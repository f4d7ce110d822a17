// SPDX-License-Identifier: Apache-2.0
#include "loading.h"

#include <vmlight/base/format.h>
#include <vmlight/cfem/radiance.h>
#include <vmlight/image/channels.h>
#include <vmlight/vismap/baker.h>

#include <algorithm>

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
        error = image.geterror();
        return nullptr;
    }
    return make_map_asset(std::move(image), samples, mesh, threads);
}

bool load_assets(Assets& dst, const Request& request, const MakeOptions& options, std::string& error)
{
    std::string space;
    if (!request.environment.empty()) {
        dst.light = read_light_asset(request.environment, request.filter, request.view.background_blur, options, error);
        if (!dst.light)
            return false;
        space = dst.light->light.space;
    }
    dst.mesh
        = read_mesh_asset(request.mesh, !request.vismap.empty(), space, request.filter.colorconfig, options, error);
    if (!dst.mesh)
        return false;
    if (!request.vismap.empty()) {
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
    LightmapParams own = asked;
    own.env_rotate.clear();
    Rotation pose;
    if (!lightmap_rotation(pose, own, error))
        return false;
    pose = rotation_from_angles(0, turn, 0) * pose;
    dst = asked;
    dst.exposure = 0;
    dst.rotate.clear();
    dst.quaternion.clear();
    dst.matrix.assign(&pose[0][0], &pose[0][0] + 9);
    return true;
}

} // namespace vmlight::view
