// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/lit_strands.h>

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/lightmap/model.h>
#include <vmlight/uv/udim.h>

namespace vmlight {

bool LitStrands::open(const ObjectRecipe& recipe, const MakeOptions& options, std::string& error)
{
    m_recipe = recipe;
    if (!m_object.open(recipe.map, error))
        return false;
    m_surface.mesh = m_object.mesh;
    m_surface.strands = m_object.surface;
    return recipe.texture.empty() || recipe.texture.find('#') != std::string::npos
        || show_texture(recipe.texture, options, error);
}

bool LitStrands::prepare_scene(const MakeOptions& options, std::string& error)
{
    if (m_scene)
        return true;
    std::vector<Mesh> occluders;
    for (const FrameSurface& surface : m_occluders)
        occluders.push_back(*surface.mesh);
    auto scene = std::make_unique<StrandScene>();
    if (!scene->build(m_object.strands(), occluders, options.threads, error))
        return false;
    m_scene = std::move(scene);
    return true;
}

bool LitStrands::bake_map(OIIO::ImageBuf& dst, const MakeOptions& options, std::string& error)
{
    VismapRecipe recipe = m_recipe.map;
    recipe.vismap_params.basis = m_basis;
    return prepare_scene(options, error) && bake_strand_map(dst, m_object, *m_scene, recipe, options, error);
}

bool LitStrands::prepare_map(const std::string& model, const MakeOptions& options, std::string& error)
{
    m_basis = m_recipe.vismap.empty() ? basis_for(model, m_recipe.map.vismap_params.basis) : "";
    if (m_maps.count(m_basis) != 0)
        return true;
    OIIO::ImageBuf map;
    if (!(m_recipe.vismap.empty() ? bake_map(map, options, error)
                                  : read_strand_map(map, m_object, m_recipe.vismap, options, error)))
        return false;
    m_maps[m_basis][kFirstUdim] = std::move(map);
    return true;
}

bool LitStrands::light(const SceneLight& light, const LightmapParams& given, const ReferenceParams&,
                       const MakeOptions& options, std::string& error, std::string* used)
{
    if (!m_recipe.texture.empty())
        return true;
    error = strand_light_fault(light, mesh().path);
    if (!error.empty())
        return false;
    LightmapParams params = given;
    params.model = strand_model(given.model);
    if (params.model != given.model && !m_has_warned) {
        options.report_warning(
            format("\"{}\": the model {} is of surfaces; the best of strands lights it", mesh().path, given.model));
        m_has_warned = true;
    }
    ShadingModel model;
    if (!prepare_map(params.model, options, error))
        return false;
    const OIIO::ImageBuf& map = m_maps[m_basis].at(kFirstUdim);
    if (!choose_model(model, params, map.spec(), true, error)
        || (model.light != ModelLight::radiance && m_filtered.empty()
            && !filter_for_strands(m_filtered, light, options.threads, error)))
        return false;
    const Stopwatch timer;
    const bool has_suns = m_recipe.trace.suns != "off" && !light.suns.empty();
    if (has_suns
        && (!prepare_scene(options, error)
            || !m_suns.trace(m_object, *m_scene, m_recipe.map, light, params, options, error)))
        return false;
    params.model = model.name;
    OIIO::ImageBuf& lightmap = m_lightmaps[kFirstUdim];
    const OIIO::cspan<OIIO::ImageBuf> filtered
        = model.light == ModelLight::radiance ? light.filtered : OIIO::cspan<OIIO::ImageBuf>(m_filtered);
    if (!make_lightmap(lightmap, map, filtered, has_suns ? &m_suns.light() : nullptr, params, nullptr, options.threads,
                       {})) {
        error = oiio::error_line(lightmap);
        return false;
    }
    if (!show_light(kFirstUdim, lightmap, options.threads, error))
        return false;
    if (used)
        *used = lightmap.spec().get_string_attribute("vmlight:model");
    m_light_seconds += timer();
    return true;
}

} // namespace vmlight
