// SPDX-License-Identifier: Apache-2.0
// What of its mesh a vismap recipe bakes: UDIM tiles and materials.
#include <vmlight/stage/make_stage.h>

#include <vmlight/base/format.h>
#include <vmlight/stage/recipe/chain.h>
#include <vmlight/stage/recipe/udim.h>
#include <vmlight/stage/scene_cache.h>
#include <vmlight/uv/udim.h>

#include <memory>

namespace vmlight {
namespace {

// What the recipe bakes of its mesh. Shares the scene of the whole mesh.
bool share_mesh(std::shared_ptr<const Mesh>& dst, const VismapRecipe& recipe, const MakeOptions& options,
                std::string& error)
{
    error = recipe_fault(recipe, options.chain);
    VismapRecipe whole = recipe;
    whole.selection = {};
    SceneStamps stamps;
    BakeScenePointer scene;
    std::vector<bool> chosen;
    std::string at;
    if (!error.empty())
        return false;
    if (!stamp_scene(stamps, whole, at, error)
        || !share_scene(scene, whole, stamps, options.threads, nullptr, at, error)
        || !choose_triangles(chosen, scene->mesh(), recipe.selection, at, error)) {
        error = with_location(recipe, at, options.chain, error);
        return false;
    }
    if (options.scene)
        *options.scene = scene;
    dst = recipe.selection.is_all() ? std::shared_ptr<const Mesh>(scene, &scene->mesh())
                                    : std::make_shared<const Mesh>(mesh_part(scene->mesh(), chosen));
    return true;
}

} // namespace

bool vismap_udims(std::vector<int>& dst, const VismapRecipe& given, const MakeOptions& options, std::string& error)
{
    const VismapRecipe recipe = resolve_udim(given);
    std::shared_ptr<const Mesh> mesh;
    if (!share_mesh(mesh, recipe, options, error))
        return false;
    dst = mesh_udims(*mesh);
    if (dst.empty())
        error = with_location(recipe, "mesh", options.chain,
                              format("\"{}\": its texture coordinates are outside all UDIM tiles", recipe.mesh));
    return !dst.empty();
}

namespace {

bool mesh_part_names(std::vector<std::string>& dst, std::vector<std::string> (*find)(const Mesh&), const char* fault,
                     const VismapRecipe& given, const MakeOptions& options, std::string& error)
{
    const VismapRecipe recipe = resolve_udim(given);
    std::shared_ptr<const Mesh> mesh;
    if (!share_mesh(mesh, recipe, options, error))
        return false;
    dst = find(*mesh);
    if (dst.empty())
        error = with_location(recipe, "mesh", options.chain, format("\"{}\": {}", recipe.mesh, fault));
    return !dst.empty();
}

} // namespace

bool vismap_materials(std::vector<std::string>& dst, const VismapRecipe& recipe, const MakeOptions& options,
                      std::string& error)
{
    return mesh_part_names(dst, baked_materials, "no materials: remove <MATERIAL> from -o", recipe, options, error);
}

bool vismap_instances(std::vector<std::string>& dst, const VismapRecipe& recipe, const MakeOptions& options,
                      std::string& error)
{
    return mesh_part_names(
        dst, baked_instances,
        "no instances, which only scene lists, glTF and Alembic files have: remove <INSTANCE> from -o", recipe, options,
        error);
}

} // namespace vmlight
