// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/uv_sets.h>

#include <vmlight/base/format.h>
#include <vmlight/base/work_counts.h>
#include <vmlight/mesh/import/read_mesh.h>

#include <vector>

namespace vmlight {
namespace {

constexpr int kMostUvSets = 8;

// False if the mesh or the chosen part has no such UV set.
bool read_part(Mesh& dst, const VismapRecipe& recipe, int set)
{
    MeshParams params = recipe.mesh_params;
    params.uv_set = set;
    std::string at, ignored;
    if (!read_mesh(dst, recipe.mesh, params, ignored))
        return false;
    ++work_counts().meshes_read;
    std::vector<bool> chosen;
    if (!recipe.selection.is_all()) {
        if (!choose_triangles(chosen, dst, recipe.selection, at, ignored))
            return false;
        dst = mesh_part(dst, chosen);
    }
    return !dst.uvs.empty();
}

std::string sets_text(const std::vector<int>& sets)
{
    std::string text = sets.size() == 1 ? "UV set " : "UV sets ";
    for (size_t i = 0; i < sets.size(); ++i)
        text += (i == 0 ? "" : i + 1 == sets.size() ? " and " : ", ") + std::to_string(sets[i]);
    return text;
}

} // namespace

void for_each_other_uv_set(const VismapRecipe& recipe, const std::function<void(int set, const Mesh& part)>& visit)
{
    for (int set = 0; set < kMostUvSets; ++set) {
        Mesh part;
        if (set == recipe.mesh_params.uv_set)
            continue;
        if (read_part(part, recipe, set))
            visit(set, part);
        else if (set > 0)
            return;
    }
}

std::string no_uvs_error(const VismapRecipe& recipe)
{
    std::vector<int> sets;
    for_each_other_uv_set(recipe, [&](int set, const Mesh&) { sets.push_back(set); });
    if (sets.empty())
        return format("\"{}\": no texture coordinates: unwrap the mesh with makevismap --unwrap", recipe.mesh);
    return format("\"{}\": no texture coordinates in UV set {}; {} has {}", recipe.mesh, recipe.mesh_params.uv_set,
                  recipe.selection.is_all() ? "the mesh" : "the part to bake", sets_text(sets));
}

} // namespace vmlight
