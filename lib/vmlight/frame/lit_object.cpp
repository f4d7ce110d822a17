// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/lit_object.h>

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/base/text_format.h>
#include <vmlight/frame/object_mesh.h>
#include <vmlight/frame/surface_materials.h>
#include <vmlight/frame/texel_weights.h>
#include <vmlight/image/channels.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/stage/map_scene.h>
#include <vmlight/stage/open_source.h>
#include <vmlight/stage/uv_warnings.h>
#include <vmlight/uv/udim.h>
#include <vmlight/vismap/baker.h>

#include <algorithm>

namespace vmlight {
bool LitObject::open(const ObjectRecipe& recipe, const MakeOptions& options, std::string& error)
{
    m_recipe = recipe;
    ObjectMesh mesh;
    if (!recipe.texture.empty()) // nothing is traced
        m_recipe.map.cutout_params.cutouts = "off";
    if (!read_object_mesh(mesh, m_recipe.map, recipe.vismap.empty() && recipe.texture.empty(), options, error))
        return false;
    m_is_unwrapped = mesh.is_unwrapped;
    m_surface.material_uvs = std::move(mesh.material_uvs);
    m_surface.mesh = std::move(mesh.mesh);
    return recipe.texture.empty() || recipe.texture.find('#') != std::string::npos
        || show_texture(recipe.texture, options, error);
}

void LitObject::open(std::shared_ptr<const Mesh> mesh, const VismapParams& params, const TraceParams& trace)
{
    m_recipe.map.vismap_params = params;
    m_recipe.trace = trace;
    m_surface.mesh = std::move(mesh);
}

bool LitObject::read_materials(const std::string& light_space, const std::string& colorconfig,
                               const MakeOptions& options, std::string& error)
{
    return vmlight::read_materials(m_surface.materials, mesh(), light_space, colorconfig, options, error);
}

bool LitObject::prepare_scene(const MakeOptions& options, std::string& error)
{
    if (m_scene)
        return true;
    auto scene = std::make_shared<BakeScene>();
    std::vector<Mesh> occluders;
    for (const FrameSurface& surface : m_occluders)
        occluders.push_back(*surface.mesh);
    SceneChoice choice;
    choice.cull = false; // a bounce may be switched on later, which occluders shade that no texel sees
    if (!scene->build(m_surface.mesh, occluders, options.threads, error, choice))
        return false;
    m_scene = std::move(scene);
    return true;
}

bool LitObject::read_maps(const MakeOptions& options, std::string& error)
{
    const std::string& name = m_recipe.vismap;
    std::vector<int> tiles { kFirstUdim };
    if (has_udim_pattern(name)) {
        tiles = existing_udims(recipe_path(name));
        if (tiles.empty()) {
            error = format("\"{}\": no files match", name);
            return false;
        }
    } else if (const int udim = udim_from_name(recipe_path(name))) {
        tiles = { udim };
    }
    LightmapRecipe recipe;
    for (const int udim : tiles) {
        recipe.vismap = udim_path(name, udim);
        const PixelSourcePointer source = open_input(recipe, "vismap", recipe.vismap, InputKind::Vismap, error, {});
        std::vector<OIIO::ImageBuf> images;
        if (!source || !make_input(images, *source, {}, recipe, "vismap", recipe.vismap, options, error))
            return false;
        if (kernel_of(images[0].spec()) == kStrandKernel) {
            error = format("\"{}\": a visibility map of strands, not of a mesh", recipe.vismap);
            return false;
        }
        warn_of_other_mesh(mesh(), m_recipe.map.mesh_params.uv_set, images[0].spec(), recipe.vismap, options);
        m_maps[""][udim] = std::move(images[0]);
    }
    warn_of_uvs(mesh(), tiles, options);
    return true;
}

bool LitObject::bake_maps(TileMaps& dst, const std::string& basis, const MakeOptions& options, std::string& error)
{
    VismapParams params = m_recipe.map.vismap_params;
    params.basis = basis;
    if (!params.has("normal"))
        params.channels.insert(params.channels.begin(), "normal"); // for the model `ao`
    const std::vector<int> tiles = mesh_udims(mesh());
    if (tiles.empty())
        error = format("\"{}\": its texture coordinates are outside all UDIM tiles", mesh().path);
    if (!error.empty() || !prepare_scene(options, error))
        return false;
    if (m_maps.empty()) // rather than of another basis
        warn_of_uvs(mesh(), tiles, options);
    for (const int udim : tiles) {
        const Stopwatch timer;
        params.udim = udim;
        const Size size = params.size();
        VismapReport report;
        OIIO::ImageBuf& map = dst[udim];
        if (!make_vismap(map, m_scene, params, &report, options.threads, options.step("bake", size.width, size.height),
                         m_recipe.map.time_budget)) {
            error = oiio::error_line(map);
            return false;
        }
        if (report.covered == 0 && tiles.size() > 1) { // corners that reach into it by rounding
            dst.erase(udim);
            continue;
        }
        const std::string tile = tiles.size() > 1 ? format(" tile {}", udim) : "";
        options.report(format("bake: {}{}: {} of {}x{}, {} rays each, in {:.2f} s", mesh().name, tile,
                              count_text(report.covered, "texel", "texels"), size.width, size.height, report.samples,
                              timer()));
        if (report.covered > 0 && report.dark > report.covered / 2)
            options.report_warning(
                format("{}: {} of {} texels see almost nothing: normals that point inwards, or surfaces inside others?",
                       mesh().name, report.dark, report.covered));
    }
    return true;
}

bool LitObject::prepare_maps(const std::string& model, const MakeOptions& options, std::string& error)
{
    if (!m_recipe.vismap.empty()) {
        m_basis.clear();
        return m_maps.count("") != 0 || read_maps(options, error);
    }
    m_basis = basis_for(model, m_recipe.map.vismap_params.basis);
    // What the traced reference needs of a map is its size.
    if (model == kReferenceModel && !m_maps.empty())
        m_basis = m_maps.begin()->first;
    if (m_maps.count(m_basis) != 0)
        return true;
    TileMaps maps;
    if (!bake_maps(maps, m_basis, options, error))
        return false;
    m_maps[m_basis] = std::move(maps);
    return true;
}

const std::vector<float>& LitObject::weights(int udim, const OIIO::ImageBuf& map, int nthreads)
{
    std::vector<float>& weights = m_weights[udim];
    if (weights.empty())
        weights = texel_weights(mesh(), map, udim, nthreads);
    return weights;
}

// By a model, with what is traced besides.
bool LitObject::light_tile(OIIO::ImageBuf& dst, int udim, const OIIO::ImageBuf& map, const SceneLight& light,
                           const LightmapParams& params, const MakeOptions& options, std::string& error)
{
    const SunLight* suns = nullptr;
    const BounceLight* bounce = nullptr;
    if (m_recipe.trace.has_any() || options.explain) {
        std::unique_ptr<TracedLight>& traced = m_traced[m_basis][udim];
        if (!prepare_scene(options, error))
            return false;
        if (!traced)
            traced = std::make_unique<TracedLight>(m_recipe.trace, m_scene, udim, m_surface, m_occluders);
        if (!traced->light(map, light, params, options, error))
            return false;
        suns = traced->suns();
        bounce = traced->bounce();
    }
    if (!make_lightmap(dst, map, light.filtered, suns, bounce, params, nullptr, options.threads, {}))
        error = oiio::error_line(dst);
    return error.empty();
}

bool LitObject::trace_tile(OIIO::ImageBuf& dst, int udim, const OIIO::ImageBuf& map, const SceneLight& light,
                           const LightmapParams& params, const ReferenceParams& reference, const MakeOptions& options,
                           std::string& error)
{
    VismapParams size = m_recipe.map.vismap_params;
    size.width = map.spec().width;
    size.height = map.spec().height;
    size.udim = udim;
    LightmapParams turned = params;
    turned.model = "auto";
    ReferenceParams same = reference;
    if (m_recipe.trace.bounce.bounce != "off")
        same.bounce_albedo = m_recipe.trace.bounce.bounce_albedo;
    if (!make_reference(dst, *m_scene, light.environment, size, turned, same, options.threads,
                        options.step("trace", size.width, size.height)))
        error = oiio::error_line(dst);
    return error.empty();
}

bool LitObject::light(const SceneLight& light, const LightmapParams& params, const ReferenceParams& reference,
                      const MakeOptions& options, std::string& error, std::string* used)
{
    if (!m_recipe.texture.empty())
        return true;
    if (!prepare_maps(params.model, options, error))
        return false;
    const bool is_traced = params.model == kReferenceModel;
    if (is_traced && !prepare_scene(options, error))
        return false;
    const Stopwatch timer;
    for (const auto& [udim, map] : m_maps[m_basis]) {
        OIIO::ImageBuf& lightmap = m_lightmaps[udim];
        if (!(is_traced ? trace_tile(lightmap, udim, map, light, params, reference, options, error)
                        : light_tile(lightmap, udim, map, light, params, options, error))
            || !show_light(udim, lightmap, options.threads, error))
            return false;
        if (used)
            *used = is_traced ? kReferenceModel : lightmap.spec().get_string_attribute("vmlight:model");
    }
    m_light_seconds += timer();
    return true;
}

} // namespace vmlight
