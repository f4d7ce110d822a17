// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/uv_sets.h>

#include <vmlight/base/format.h>
#include <vmlight/base/work_counts.h>
#include <vmlight/mesh/import/read_mesh.h>

#include <limits>
#include <vector>

namespace vmlight {
namespace {

constexpr int kMostUvSets = 8;

// False if the mesh or the chosen part has no such UV set.
bool read_uv_set(Mesh& dst, const VismapRecipe& recipe, int set)
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

// Three uvs a triangle.
std::vector<Imath::V2f> corner_uvs(const Mesh& mesh)
{
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    std::vector<Imath::V2f> uvs;
    for (const auto& triangle : mesh.triangles)
        for (const uint32_t vertex : triangle)
            uvs.push_back(mesh.uvs.empty() ? Imath::V2f(kNone, kNone) : mesh.uvs[vertex]);
    return uvs;
}

} // namespace

void for_each_other_uv_set(const VismapRecipe& recipe, const std::function<void(int set, const Mesh& part)>& visit)
{
    for (int set = 0; set < kMostUvSets; ++set) {
        Mesh part;
        if (set == recipe.mesh_params.uv_set)
            continue;
        if (read_uv_set(part, recipe, set))
            visit(set, part);
        else if (set > 0)
            return;
    }
}

std::vector<std::vector<Imath::V2f>> other_uvs(const Mesh& mesh, const std::vector<int>& sets, int own_set,
                                               bool is_lost, const std::function<bool(Mesh& dst, int set)>& read_again)
{
    std::vector<std::vector<Imath::V2f>> uvs(kMostUvSets);
    for (const int set : sets) {
        if (set < 0 || set >= kMostUvSets || !uvs[size_t(set)].empty())
            continue;
        if (set == own_set) {
            if (is_lost)
                uvs[size_t(set)] = corner_uvs(mesh);
            continue;
        }
        Mesh again;
        if (read_again && read_again(again, set) && again.triangles.size() == mesh.triangles.size())
            uvs[size_t(set)] = corner_uvs(again);
    }
    return uvs;
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
