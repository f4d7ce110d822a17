// SPDX-License-Identifier: Apache-2.0
#include "added_light.h"

#include <utility>

namespace vmlight::view {
namespace {

FrameSurface surface_of(const MeshAsset& mesh, bool is_white)
{
    FrameSurface surface;
    surface.mesh = mesh.mesh;
    if (!is_white)
        surface.materials = mesh.materials;
    surface.material_uvs = mesh.material_uvs;
    return surface;
}

} // namespace

AddedLight::AddedLight(const TraceParams& params, MeshPointer mesh, bool is_white, MapPointer map, LightPointer light)
    : m_mesh(std::move(mesh))
    , m_map(std::move(map))
    , m_light(std::move(light))
    , m_traced(params, m_mesh->scene, m_mesh->recipe.vismap_params.udim, surface_of(*m_mesh, is_white), {})
{
}

bool AddedLight::trace(std::vector<float>& dst, const LightmapParams& params, const MakeOptions& options,
                       std::string& error)
{
    dst.clear();
    if (!m_traced.light(m_map->image, m_light->light, params, options, error))
        return false;
    if (!m_traced.suns() && !m_traced.bounce())
        return true;
    const OIIO::ROI roi = m_map->image.roi();
    dst.resize(3 * size_t(roi.npixels()));
    if (m_traced.suns())
        m_traced.suns()->add(roi, 1, dst.data());
    if (m_traced.bounce())
        m_traced.bounce()->add(roi, 1, dst.data());
    return true;
}

} // namespace vmlight::view
