// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/lit_strands.h>

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/base/text_format.h>
#include <vmlight/cfem/stack.h>
#include <vmlight/image/channels.h>
#include <vmlight/lightmap/model.h>
#include <vmlight/mesh/import/strands/read_strands.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/stage/open_source.h>
#include <vmlight/stage/stored_suns.h>
#include <vmlight/uv/udim.h>
#include <vmlight/vismap/strand_suns.h>

namespace vmlight {

bool LitStrands::open(const ObjectRecipe& recipe, const MakeOptions&, std::string& error)
{
    m_recipe = recipe;
    const VismapRecipe& map = recipe.map;
    auto strands = std::make_shared<Strands>();
    if (!read_strands(*strands, map.mesh, map.mesh_params, map.strand_params.radius, error)
        || !StrandLayout::make(m_layout, strands->count(), map.strand_params.strand_texels, error))
        return false;
    auto mesh = std::make_shared<Mesh>();
    mesh->name = strands->name;
    mesh->path = strands->path;
    mesh->strands = m_strands = std::move(strands);
    m_surface.mesh = std::move(mesh);
    m_surface.strands = std::make_shared<StrandSurface>(m_strands, m_layout);
    return recipe.texture.empty() || recipe.texture.find('#') != std::string::npos
        || show_texture(recipe.texture, error);
}

bool LitStrands::prepare_scene(const MakeOptions& options, std::string& error)
{
    if (m_scene)
        return true;
    std::vector<Mesh> occluders;
    for (const FrameSurface& surface : m_occluders)
        occluders.push_back(*surface.mesh);
    auto scene = std::make_unique<StrandScene>();
    if (!scene->build(*m_strands, occluders, options.threads, error))
        return false;
    m_scene = std::move(scene);
    return true;
}

bool LitStrands::read_map(OIIO::ImageBuf& dst, const MakeOptions& options, std::string& error)
{
    LightmapRecipe recipe;
    recipe.vismap = m_recipe.vismap;
    const PixelSourcePointer source = open_input(recipe, "vismap", recipe.vismap, InputKind::Vismap, error, {});
    std::vector<OIIO::ImageBuf> images;
    if (!source || !make_input(images, *source, {}, recipe, "vismap", recipe.vismap, options, error))
        return false;
    const OIIO::ImageSpec& spec = images[0].spec();
    const Size size = m_layout.size();
    if (kernel_of(spec) != kStrandKernel)
        error = format("\"{}\": a visibility map of a mesh, not of strands", recipe.vismap);
    else if (spec.width != size.width || spec.height != size.height)
        error
            = format("\"{}\": {}x{} texels, and \"{}\" needs {}x{} with {} along each strand: set --strand-texels to "
                     "what it was baked with",
                     recipe.vismap, spec.width, spec.height, m_strands->path, size.width, size.height, m_layout.texels);
    if (!error.empty())
        return false;
    dst = std::move(images[0]);
    return true;
}

bool LitStrands::bake_map(OIIO::ImageBuf& dst, const MakeOptions& options, std::string& error)
{
    const Stopwatch timer;
    VismapParams params = m_recipe.map.vismap_params;
    params.basis = m_basis;
    if (!prepare_scene(options, error))
        return false;
    int64_t rays = 0;
    const StrandBaker baker(*m_strands, *m_scene, m_layout, params);
    const OIIO::ImageSpec spec = describe_strand_map(*m_strands, m_layout, m_recipe.map.strand_params, params);
    if (!make_strand_map(dst, spec, baker, options.threads, rays, options.step("bake", spec.width, spec.height))) {
        error = oiio::error_line(dst);
        return false;
    }
    options.report(format("bake: {}: {} of {}, {} rays each, in {:.2f} s", m_strands->name,
                          count_text(m_layout.strands, "strand", "strands"),
                          count_text(m_layout.texels, "texel", "texels"), params.samples, timer()));
    return true;
}

bool LitStrands::prepare_map(const std::string& model, const MakeOptions& options, std::string& error)
{
    m_basis = m_recipe.vismap.empty() ? basis_for(model, m_recipe.map.vismap_params.basis) : "";
    if (m_maps.count(m_basis) != 0)
        return true;
    OIIO::ImageBuf map;
    if (!(m_recipe.vismap.empty() ? bake_map(map, options, error) : read_map(map, options, error)))
        return false;
    m_maps[m_basis][kFirstUdim] = std::move(map);
    return true;
}

// What the model `ao` looks up.
bool LitStrands::filter_light(const SceneLight& light, const MakeOptions& options, std::string& error)
{
    if (m_sine.initialized())
        return true;
    const OIIO::ImageSpec& spec = light.filtered.back().spec();
    CfemParams params;
    params.kernel = kStrandKernel;
    params.resolution = { spec.width, spec.height };
    if (!make_cfem(m_sine, light.filtered.back(), params, options.threads))
        error = oiio::error_line(m_sine);
    return error.empty();
}

bool LitStrands::trace_suns(SunLight& dst, const SceneLight& light, const LightmapParams& params,
                            const MakeOptions& options, std::string& error)
{
    Rotation rotation;
    if (!prepare_scene(options, error) || !lightmap_rotation(rotation, params, error))
        return false;
    std::string key = suns_text(light.suns);
    for (int i = 0; i < 9; ++i)
        key += format("|{}", rotation[i / 3][i % 3]);
    if (key == m_suns_key)
        return true;
    const Stopwatch timer;
    const Size size = m_layout.size();
    int64_t rays = 0;
    m_suns_key.clear();
    dst.suns = light.suns;
    dst.roi = OIIO::ROI(0, size.width, 0, size.height);
    if (!trace_strand_discs(dst.visibility, *m_strands, *m_scene, m_layout, discs_in_object_space(dst.suns, rotation),
                            m_recipe.map.vismap_params, options.threads, rays,
                            options.step("suns", size.width, size.height))) {
        error = "interrupted";
        return false;
    }
    m_suns_key = key;
    options.report(format("suns: {} in {:.3f} s", count_text(rays, "ray", "rays"), timer()));
    return true;
}

bool LitStrands::light(const SceneLight& light, const LightmapParams& given, const ReferenceParams&,
                       const MakeOptions& options, std::string& error, std::string* used)
{
    if (!m_recipe.texture.empty())
        return true;
    if (!is_stack(light.filtered)) {
        error = format("\"{}\": strands need the environment itself, or a stack of makecfem", m_strands->path);
        return false;
    }
    LightmapParams params = given;
    const ModelEntry* const entry = find_model_entry(params.model);
    if (params.model != "auto" && !(entry && entry->strand_rank > 0)) {
        params.model = "auto";
        if (!m_has_warned)
            options.report_warning(format("\"{}\": the model {} is of surfaces; the best of strands lights it",
                                          m_strands->path, given.model));
        m_has_warned = true;
    }
    ShadingModel model;
    if (!prepare_map(params.model, options, error))
        return false;
    const OIIO::ImageBuf& map = m_maps[m_basis].at(kFirstUdim);
    if (!choose_model(model, params, map.spec(), true, error)
        || (model.light == ModelLight::cfem && !filter_light(light, options, error)))
        return false;
    const Stopwatch timer;
    const bool has_suns = m_recipe.trace.suns != "off" && !light.suns.empty();
    if (has_suns && !trace_suns(m_suns, light, params, options, error))
        return false;
    params.model = model.name;
    OIIO::ImageBuf& lightmap = m_lightmaps[kFirstUdim];
    const OIIO::cspan<OIIO::ImageBuf> filtered
        = model.light == ModelLight::cfem ? OIIO::cspan<OIIO::ImageBuf>(&m_sine, 1) : light.filtered;
    if (!make_lightmap(lightmap, map, filtered, has_suns ? &m_suns : nullptr, params, nullptr, options.threads, {})) {
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
