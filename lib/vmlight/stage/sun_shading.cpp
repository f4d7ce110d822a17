// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/sun_shading.h>

#include <vmlight/base/format.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/base/text_format.h>
#include <vmlight/cfem/suns.h>
#include <vmlight/stage/normal_map_file.h>
#include <vmlight/stage/recipe/udim.h>
#include <vmlight/stage/sun_source.h>

#include <algorithm>
#include <cmath>

namespace vmlight {
namespace {

// The bake that `map` says it is from, but for the meshes. Keys that are not in the map, or are no longer valid, keep
// their defaults.
VismapRecipe recipe_of_map(const OIIO::ImageSpec& map)
{
    VismapRecipe recipe;
    for (const std::string& key : param_names(recipe))
        if (const OIIO::ParamValue* value = map.find_attribute(metadata_name(key.c_str()))) {
            std::string ignored;
            if (key != "mesh" && key != "occluder") // `vmlight:mesh` is a name for people
                set_param(recipe, key, value->get_string(), ignored);
        }
    return recipe;
}

} // namespace

std::shared_ptr<SunShading> SunShading::open(const LightmapRecipe& recipe, const OIIO::ImageSpec& vismap,
                                             std::string& error, const RecipeChain& chain)
{
    auto suns = std::make_shared<SunShading>();
    suns->m_recipe = recipe;
    const bool has_stored = [&] {
        std::string ignored;
        const std::string text = vismap.get_string_attribute("vmlight:sun_directions");
        parse_sun_directions(suns->m_stored, text, ignored);
        for (const std::string& channel : sun_channels(text))
            suns->m_channels.push_back(vismap.channelindex(channel));
        if (std::count(suns->m_channels.begin(), suns->m_channels.end(), -1))
            suns->m_stored.clear();
        return !suns->m_stored.empty();
    }();
    if (recipe_stage(recipe.vismap) == VismapRecipe::kStage) {
        if (!read_recipe(suns->m_mesh, recipe.vismap, error))
            return nullptr;
        suns->m_mesh = resolve_udim(suns->m_mesh);
    } else if (recipe.mesh.empty() && !has_stored) {
        error = with_location(recipe, "suns", chain,
                              format("\"{}\": a visibility map in a file does not say where its mesh is, which suns "
                                     "are traced on; set --mesh, and --occluder for all else that occluded it, or bake "
                                     "them with makevismap --sun-directions",
                                     recipe.vismap));
        return nullptr;
    } else {
        suns->m_mesh = recipe_of_map(vismap);
        suns->m_mesh.mesh = recipe.mesh;
        suns->m_mesh.occluder = recipe.occluder;
        suns->m_normal_map = suns->m_mesh.normal_map; // its name alone is known
        suns->m_mesh.normal_map.clear();
        suns->m_hash = vismap.get_string_attribute("vmlight:meshHash");
        suns->m_occluder_hashes = vismap.get_string_attribute("vmlight:occluderHash");
    }
    suns->m_roi = OIIO::get_roi(vismap);
    if (suns->m_roi != OIIO::get_roi_full(vismap)) {
        error
            = with_location(recipe, "vismap", chain,
                            format("\"{}\": only a part of a map, and suns are traced for whole ones", recipe.vismap));
        return nullptr;
    }
    std::string at;
    if (!suns->m_mesh.mesh.empty() && !stamp_scene(suns->m_stamps, suns->m_mesh, at, error)) {
        error = with_location(recipe, at, chain, error);
        return nullptr;
    }
    // The map may have been resized since.
    suns->m_map = suns->m_mesh.vismap_params;
    suns->m_map.width = vismap.width;
    suns->m_map.height = vismap.height;
    suns->m_key = format("suns\n{}{}x{}\n{}\n", suns->m_stamps.key, vismap.width, vismap.height, suns->m_hash);
    suns->m_mesh.visit([&](const char* name, auto& value, const auto& allowed, const char*) {
        suns->m_key += std::string(name) + "=" + value_text(value, allowed) + "\n";
    });
    return suns;
}

bool SunShading::prepare(const MakeOptions& options, std::string& error)
{
    BakeScenePointer scene;
    std::string at;
    if (!share_scene(scene, m_mesh, m_stamps, options.threads, nullptr, at, error, options.steps())) {
        error = with_location(m_recipe, at, options.chain, error);
        return false;
    }
    const bool other_mesh = !m_hash.empty() && scene->mesh_hash() != m_hash;
    if (other_mesh || (!m_hash.empty() && scene->occluder_hashes() != m_occluder_hashes)) {
        error = with_location(m_recipe, other_mesh ? "mesh" : "occluder", options.chain,
                              format("\"{}\": {} that \"{}\" was baked {}: {}",
                                     other_mesh ? m_mesh.mesh : m_recipe.vismap,
                                     other_mesh ? "not the mesh" : "the occluders are not those", m_recipe.vismap,
                                     other_mesh ? "from" : "with",
                                     other_mesh ? "give that one, or bake the map again"
                                                : "give each with --occluder, in the same order"));
        return false;
    }
    if (!m_normal_map.empty()) {
        error = with_location(m_recipe, "vismap", options.chain,
                              format("\"{}\": baked with the normal map \"{}\", which suns need too; light its recipe "
                                     "instead, or bake it with makevismap --sun-directions",
                                     m_recipe.vismap, m_normal_map));
        return false;
    }
    VismapRecipe sized = m_mesh;
    sized.vismap_params = m_map;
    NormalMapPointer normal_map;
    std::vector<std::string> ignored;
    if (!read_normal_map(normal_map, sized, { scene, &scene->mesh() }, options.threads, ignored, ignored, error)) {
        error = with_location(m_recipe, "vismap", options.chain, error);
        return false;
    }
    return m_tracer.prepare(std::move(scene), m_map, error, options.threads, {}, std::move(normal_map));
}

bool SunShading::read_stored(std::vector<float>& dst, const std::vector<Disc>& discs, const ReadChannel& read,
                             bool& matches, std::string& error) const
{
    constexpr double kTolerance = latlong::pi / 720; // a quarter of a degree
    std::vector<int> channels;
    for (const Disc& disc : discs)
        for (size_t k = 0; k < m_stored.size(); ++k)
            if ((m_stored[k].direction - disc.direction).length() < kTolerance
                && std::abs(m_stored[k].half_angle - disc.half_angle) < std::max(kTolerance, 0.25 * disc.half_angle)) {
                channels.push_back(m_channels[k]);
                break;
            }
    matches = channels.size() == discs.size();
    if (!matches)
        return true;
    std::vector<float> plane;
    dst.resize(size_t(m_roi.width()) * m_roi.height() * channels.size());
    for (size_t k = 0; k < channels.size(); ++k) {
        if (!read(channels[k], plane, error))
            return false;
        for (size_t i = 0; i < plane.size(); ++i)
            dst[i * channels.size() + k] = plane[i];
    }
    return true;
}

bool SunShading::light(SunLight& dst, const std::vector<Sun>& suns, const LightmapParams& params,
                       const ReadChannel& read, const MakeOptions& options, std::string& error)
{
    dst.suns = suns;
    dst.roi = m_roi;
    Rotation rotation;
    if (!lightmap_rotation(rotation, params, error))
        return false;
    if (suns.empty())
        return true;
    std::vector<Disc> discs;
    for (const Sun& sun : suns) // the inverse of a rotation is its transpose
        discs.push_back({ rotate(rotation.transposed(), sun.disc.direction), sun.disc.half_angle });
    bool is_stored = false;
    if (!read_stored(dst.visibility, discs, read, is_stored, error))
        return false;
    if (is_stored) {
        options.report("suns: from the visibility map");
        return true;
    }
    if (m_mesh.mesh.empty()) {
        error = with_location(m_recipe, "vismap", options.chain,
                              format("\"{}\": the suns are not among those that it was baked for, {}; they are "
                                     "\"{}\": set --mesh to trace them, or bake the map with these --sun-directions",
                                     m_recipe.vismap, sun_directions_text(m_stored), sun_directions_text(discs)));
        return false;
    }
    if (!m_prepare.run([&](std::string& reason) { return prepare(options, reason); }, error))
        return false;
    const Stopwatch timer;
    if (!m_tracer.trace(dst.visibility, discs, options.threads, options.step("suns", m_roi.width(), m_roi.height()))) {
        error = "interrupted";
        return false;
    }
    options.report(format("suns: {} in {:.3f} s", count_text(m_tracer.rays(), "ray", "rays"), timer()));
    return true;
}

bool find_suns(std::string& text, PixelSource& cfem, std::string& error)
{
    if (auto* source = dynamic_cast<SunSource*>(&cfem))
        return source->find_suns(text, error);
    text = cfem.spec().get_string_attribute(kSunsAttribute);
    if (text != kUnknownSuns)
        return true;
    error = "its suns were split off, and it does not say which: it was saved by a program that read a recipe; make it "
            "with makecfem";
    return false;
}

} // namespace vmlight
