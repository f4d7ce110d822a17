// SPDX-License-Identifier: Apache-2.0
#include "live_page.h"

#include "page/page.h"

#include <vmlight/base/oiio_compat.h>
#include <vmlight/vismap/baker.h>

#include <algorithm>

namespace vmlight::cost {
namespace {

// A report of more can no longer be mailed, or takes a browser long to open.
constexpr size_t kLargestMesh = 12'000'000;

// Of its positions, UVs and triangles in the page.
size_t page_bytes(const Mesh& mesh)
{
    return (mesh.positions.size() * 5 * sizeof(float) + mesh.triangles.size() * 3 * sizeof(uint32_t)) * 4 / 3;
}

} // namespace

bool make_live_page(std::string& html, const Inputs& inputs, const CfemRecipe& light, const CostParams& params,
                    const MakeOptions& options, const Progress& progress, std::string& error)
{
    html.clear();
    const Mesh& mesh = inputs.scene->mesh();
    if (page_bytes(mesh) > kLargestMesh)
        return true;
    const VismapParams map_params = reference_map(params);
    OIIO::ImageBuf map;
    if (!make_vismap(map, inputs.scene, map_params, nullptr, options.threads, progress)) {
        error = oiio::error_line(map);
        return false;
    }
    const TexelSurface surface(mesh, map.spec().width, map.spec().height, map_params.udim, options.threads);
    MapTexels texels;
    if (!texels.open(map, &surface, error))
        return false;
    CfemRecipe filter = light;
    filter.cfem_params.sanitize = params.sanitize;
    MakeOptions quiet;
    quiet.threads = options.threads;
    std::vector<PageLight> lights(std::min(inputs.environments.size(), size_t(kLivePageLights)));
    for (size_t i = 0; i < lights.size(); ++i)
        if (!read_page_light(lights[i], inputs.environments[i].path, filter, quiet, error))
            return false;
    html = make_page(mesh, texels, surface, lights);
    return true;
}

} // namespace vmlight::cost
