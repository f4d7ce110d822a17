// SPDX-License-Identifier: Apache-2.0
#include "added_light.h"

#include <algorithm>
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
    : m_params(params)
    , m_mesh(std::move(mesh))
    , m_map(std::move(map))
    , m_light(std::move(light))
{
    std::vector<FrameSurface> others;
    for (size_t i = 0; i < std::min(m_mesh->beside.size(), m_map->beside.size()); ++i) {
        const MeshPointer& other = m_mesh->beside[i];
        others.push_back(surface_of(*other, true));
        m_beside.push_back(std::make_unique<AddedLight>(params, other, is_white, m_map->beside[i], m_light));
    }
    if (!m_mesh->is_strands())
        m_traced = std::make_unique<TracedLight>(params, m_mesh->scene, m_mesh->recipe.vismap_params.udim,
                                                 surface_of(*m_mesh, is_white), std::move(others));
}

bool AddedLight::trace_mesh(std::vector<float>& dst, const LightmapParams& params, const MakeOptions& options,
                            std::string& error)
{
    dst.clear();
    if (!m_traced->light(m_map->image, m_light->light, params, options, error))
        return false;
    if (!m_traced->suns() && !m_traced->bounce())
        return true;
    const OIIO::ROI roi = m_map->image.roi();
    dst.resize(3 * size_t(roi.npixels()));
    if (m_traced->suns())
        m_traced->suns()->add(roi, 1, dst.data());
    if (m_traced->bounce())
        m_traced->bounce()->add(roi, 1, dst.data());
    return true;
}

// Nothing bounces to them.
bool AddedLight::trace_strands(std::vector<float>& dst, const LightmapParams& params, const MakeOptions& options,
                               std::string& error)
{
    dst.clear();
    if (m_params.suns == "off" || m_light->light.suns.empty())
        return true;
    if (!m_suns.trace(m_mesh->strands, *m_mesh->strand_scene, m_mesh->recipe, m_light->light, params, options, error))
        return false;
    const OIIO::ROI roi = m_map->image.roi();
    dst.resize(3 * size_t(roi.npixels()));
    m_suns.light().add(roi, 1, dst.data());
    return true;
}

bool AddedLight::trace(AddedTexels& dst, const LightmapParams& params, const MakeOptions& options, std::string& error)
{
    dst.resize(1 + m_beside.size());
    if (!(m_traced ? trace_mesh(dst[0], params, options, error) : trace_strands(dst[0], params, options, error)))
        return false;
    for (size_t i = 0; i < m_beside.size(); ++i)
        if (!m_beside[i]->trace_strands(dst[i + 1], params, options, error))
            return false;
    return true;
}

} // namespace vmlight::view
