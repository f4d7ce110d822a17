// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/mesh_list.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/stage/recipe/strand_recipe.h>
#include <vmlight/stage/recipe/udim.h>
#include <vmlight/stage/uv_sets.h>
#include <vmlight/uv/raster.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace vmlight {
namespace {

constexpr int kDeepestIndent = 32;

std::vector<int64_t> count_by_index(const TriangleIndices& indices, size_t size)
{
    std::vector<int64_t> counts(size, 0);
    for (const uint32_t index : indices)
        if (index < size)
            ++counts[index];
    return counts;
}

std::string line_of(const std::string& what, int64_t triangles)
{
    return what + ": " + count_text(triangles, "triangle", "triangles") + "\n";
}

std::string list_nodes(const Mesh& mesh)
{
    std::vector<int64_t> counts = count_by_index(mesh.triangle_nodes, mesh.nodes.size());
    std::vector<int> depth(mesh.nodes.size(), 0);
    for (size_t i = mesh.nodes.size(); i-- > 0;)
        if (mesh.nodes[i].parent >= 0)
            counts[size_t(mesh.nodes[i].parent)] += counts[i];
    std::string text;
    for (size_t i = 0; i < mesh.nodes.size(); ++i) {
        if (mesh.nodes[i].parent >= 0)
            depth[i] = std::min(depth[size_t(mesh.nodes[i].parent)] + 1, kDeepestIndent);
        text += std::string(size_t(2 * depth[i]), ' ')
            + line_of(format("node \"{}\"", printable_line(node_name(mesh, i))), counts[i]);
    }
    return text;
}

} // namespace

bool list_mesh(std::string& dst, const VismapRecipe& given, std::string& error)
{
    VismapRecipe recipe = resolve_udim(given);
    Mesh mesh;
    if (recipe.mesh.empty())
        error = "mesh is missing";
    else if (bakes_strands(recipe))
        error = format("\"{}\": strands have no UV sets, materials or nodes to list", printable_line(recipe.mesh));
    if (!error.empty() || !read_mesh(mesh, recipe.mesh, recipe.mesh_params, error))
        return false;
    dst = line_of(format("\"{}\"", printable_line(recipe.mesh)), int64_t(mesh.triangles.size()));
    recipe.mesh_params.uv_set = -1; // all are others
    recipe.selection = {};
    for_each_other_uv_set(recipe, [&](int set, const Mesh& textured) {
        const UvReport report = UvRaster(textured, 1, 1).report();
        dst += line_of(format("UV set {}", set), report.triangles - report.without_uv);
    });
    const std::vector<int64_t> counts = count_by_index(mesh.triangle_materials, mesh.materials.size());
    for (size_t i = 0; i < counts.size(); ++i)
        dst += line_of(format("material \"{}\"", printable_line(material_name(mesh, i))), counts[i]);
    dst += list_nodes(mesh);
    return true;
}

} // namespace vmlight
