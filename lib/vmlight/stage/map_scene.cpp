// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/map_scene.h>

#include <vmlight/base/format.h>
#include <vmlight/stage/bake_switches.h>
#include <vmlight/stage/bounce_shading.h>
#include <vmlight/stage/normal_map_file.h>
#include <vmlight/stage/recipe/udim.h>

namespace vmlight {

VismapRecipe recipe_of_map(const OIIO::ImageSpec& map)
{
    VismapRecipe recipe;
    for (const std::string& key : param_names(recipe))
        if (const OIIO::ParamValue* value = map.find_attribute(metadata_name(key.c_str()))) {
            std::string ignored;
            if (key != "mesh" && key != "occluder") // as metadata these are names for people
                set_param(recipe, key, value->get_string(), ignored);
        }
    return recipe;
}

std::shared_ptr<MapScene> MapScene::of(BakeScenePointer built, const OIIO::ImageSpec& vismap, int udim)
{
    auto scene = std::make_shared<MapScene>();
    scene->m_mesh = recipe_of_map(vismap);
    scene->m_mesh.mesh = built->mesh().name.empty() ? "mesh" : built->mesh().name;
    scene->m_roi = OIIO::get_roi(vismap);
    scene->m_map = scene->m_mesh.vismap_params;
    scene->m_map.width = vismap.width;
    scene->m_map.height = vismap.height;
    scene->m_map.udim = udim;
    scene->m_scene = std::move(built);
    return scene;
}

std::shared_ptr<MapScene> MapScene::open(const LightmapRecipe& recipe, const OIIO::ImageSpec& vismap,
                                         bool from_anywhere, std::string& error, const RecipeChain& chain)
{
    auto scene = std::make_shared<MapScene>();
    scene->m_recipe = recipe;
    if (recipe_stage(recipe.vismap) == VismapRecipe::kStage) {
        if (!read_recipe(scene->m_mesh, recipe.vismap, error))
            return nullptr;
        scene->m_mesh = with_switches(resolve_udim(scene->m_mesh));
    } else {
        scene->m_mesh = recipe_of_map(vismap);
        scene->m_mesh.mesh = recipe.mesh;
        scene->m_mesh.occluder = recipe.occluder;
        scene->m_normal_map = scene->m_mesh.normal_map; // its name alone is known
        scene->m_mesh.normal_map.clear();
        scene->m_hash = vismap.get_string_attribute("vmlight:meshHash");
        scene->m_occluder_hashes = vismap.get_string_attribute("vmlight:occluderHash");
        scene->m_occluder_names = vismap.get_string_attribute("vmlight:occluder");
    }
    scene->m_mesh.cull_occluders = !from_anywhere;
    scene->m_roi = OIIO::get_roi(vismap);
    if (scene->m_roi != OIIO::get_roi_full(vismap)) {
        error = with_location(recipe, "vismap", chain,
                              format("\"{}\": only part of a map; tracing needs the whole map", recipe.vismap));
        return nullptr;
    }
    std::string at;
    if (scene->has_mesh() && !stamp_scene(scene->m_stamps, scene->m_mesh, at, error)) {
        error = with_location(recipe, at, chain, error);
        return nullptr;
    }
    // The map may have been resized since.
    scene->m_map = scene->m_mesh.vismap_params;
    scene->m_map.width = vismap.width;
    scene->m_map.height = vismap.height;
    scene->m_key = format("{}{}x{}\n{}\n", scene->m_stamps.key, vismap.width, vismap.height, scene->m_hash);
    scene->m_mesh.visit([&](const char* name, auto& value, const auto& allowed, const char*) {
        scene->m_key += std::string(name) + "=" + value_text(value, allowed) + "\n";
    });
    return scene;
}

bool MapScene::prepare(const MakeOptions& options, std::string& error)
{
    return m_prepare.run([&](std::string& reason) { return read(options, reason); }, error);
}

std::string MapScene::occluder_fault(const std::string& hashes) const
{
    if (m_hash.empty() || hashes == m_occluder_hashes)
        return "";
    if (m_occluder_hashes.empty())
        return "baked without occluders; leave out --occluder, or bake the map again with it";
    return format("baked with other occluders{}; list the same ones with --occluder, in the same order",
                  m_occluder_names.empty() ? "" : format(": {}", m_occluder_names));
}

bool MapScene::read(const MakeOptions& options, std::string& error)
{
    if (m_scene)
        return true;
    BakeScenePointer scene;
    std::string at;
    if (!share_scene(scene, m_mesh, m_stamps, options.threads, nullptr, at, error, options.steps())) {
        error = with_location(m_recipe, at, options.chain, error);
        return false;
    }
    if (!m_hash.empty() && scene->mesh_hash() != m_hash) {
        error = with_location(m_recipe, "mesh", options.chain,
                              format("\"{}\": not the mesh that \"{}\" was baked from; set that one with --mesh, or "
                                     "bake the map again",
                                     m_mesh.mesh, m_recipe.vismap));
        return false;
    }
    error = occluder_fault(scene->occluder_hashes());
    if (!error.empty()) {
        error = with_location(m_recipe, "occluder", options.chain, format("\"{}\": {}", m_recipe.vismap, error));
        return false;
    }
    if (!m_normal_map.empty()) {
        error = with_location(m_recipe, "vismap", options.chain,
                              format("\"{}\": baked with the normal map \"{}\", which traced light needs too; light "
                                     "its recipe instead",
                                     m_recipe.vismap, m_normal_map));
        return false;
    }
    VismapRecipe sized = m_mesh;
    sized.vismap_params = m_map;
    std::vector<std::string> ignored;
    if (!read_normal_map(m_normals, sized, { scene, &scene->mesh() }, options.threads, ignored, ignored, error)) {
        error = with_location(m_recipe, "vismap", options.chain, error);
        return false;
    }
    m_scene = std::move(scene);
    return true;
}

} // namespace vmlight
