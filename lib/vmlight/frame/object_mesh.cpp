// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/object_mesh.h>

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/mesh/selection.h>
#include <vmlight/stage/overlap_hint.h>
#include <vmlight/stage/unwrap_report.h>
#include <vmlight/stage/uv_sets.h>
#include <vmlight/uv/raster.h>
#include <vmlight/uv/udim.h>
#include <vmlight/uv/unwrap.h>

#include <algorithm>
#include <limits>
#include <memory>

namespace vmlight {
namespace {

using Imath::V2f;

// Three uvs a triangle.
std::vector<V2f> corner_uvs(const Mesh& mesh)
{
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    std::vector<V2f> uvs;
    for (const auto& triangle : mesh.triangles)
        for (const uint32_t vertex : triangle)
            uvs.push_back(mesh.uvs.empty() ? V2f(kNone, kNone) : mesh.uvs[vertex]);
    return uvs;
}

bool read_part(Mesh& dst, const VismapRecipe& recipe, int uv_set, std::string& error)
{
    MeshParams params = recipe.mesh_params;
    params.uv_set = uv_set;
    if (!read_mesh(dst, recipe.mesh, params, error))
        return false;
    if (recipe.selection.is_all())
        return true;
    std::vector<bool> chosen;
    std::string at;
    if (!choose_triangles(chosen, dst, recipe.selection, at, error)) {
        error = format("\"{}\": {}: {}", recipe.mesh, at, error);
        return false;
    }
    Mesh part = mesh_part(dst, chosen);
    part.warnings = dst.warnings;
    dst = std::move(part);
    return true;
}

// As a bake would count it, at a size that is quick.
bool overlaps_heavily(const Mesh& mesh)
{
    constexpr int kSide = 512;
    VismapReport report;
    const auto cover = std::make_unique<TileCover>();
    for (const int udim : mesh_udims(mesh)) {
        const UvRaster raster(mesh, kSide, kSide, udim);
        for (int tile = 0; tile < raster.tiles_across() * raster.tiles_down(); ++tile) {
            raster.cover(tile, *cover);
            report.covered += cover->covered;
            report.overlapping += cover->overlapping;
        }
    }
    return report.covered == 0 || has_heavy_overlap(report);
}

bool unwrap(Mesh& mesh, const VismapRecipe& recipe, const std::string& reason, const MakeOptions& options,
            std::string& error)
{
    const Size size = recipe.vismap_params.size();
    const UnwrapParams params { size.width, size.height, recipe.vismap_params.margin, options.threads };
    UnwrapReport report;
    if (!unwrap_mesh(mesh, params, &report, error)) {
        error = format("\"{}\": {}", recipe.mesh, error);
        return false;
    }
    options.report(format("{}: {}{}", mesh.name, reason, unwrap_line(report, params)));
    if (const std::string warning = unwrap_warning(report); !warning.empty())
        options.report_warning(warning);
    return true;
}

// Those that are not, or will not be, the UVs of the mesh.
void keep_material_uvs(std::vector<std::vector<V2f>>& dst, const Mesh& mesh, const VismapRecipe& recipe,
                       bool is_unwrapped)
{
    constexpr int kMostSets = 8;
    const int baked_set = recipe.mesh_params.uv_set;
    dst.resize(kMostSets);
    for (const Material& material : mesh.materials) {
        const int set = material.base_color_texture.uv_set;
        if (!material.base_color_texture.exists() || set < 0 || set >= kMostSets || !dst[set].empty())
            continue;
        if (set == baked_set) {
            if (is_unwrapped)
                dst[set] = corner_uvs(mesh);
            continue;
        }
        Mesh again;
        std::string ignored; // a material that asks for UVs that the file lacks
        if (read_part(again, recipe, set, ignored) && again.triangles.size() == mesh.triangles.size())
            dst[set] = corner_uvs(again);
    }
}

} // namespace

bool read_object_mesh(ObjectMesh& dst, const VismapRecipe& recipe, bool may_unwrap, const MakeOptions& options,
                      std::string& error)
{
    auto mesh = std::make_shared<Mesh>();
    if (!read_part(*mesh, recipe, recipe.mesh_params.uv_set, error))
        return false;
    for (const std::string& warning : mesh->warnings)
        options.report_warning(format("\"{}\": {}", recipe.mesh, warning));
    if (mesh->uvs.empty() && !may_unwrap) {
        error = no_uvs_error(recipe);
        return false;
    }
    std::string reason;
    if (mesh->uvs.empty())
        reason = "no UVs; ";
    else if (!recipe.unwrap && may_unwrap && overlaps_heavily(*mesh))
        reason = "its UVs overlap; ";
    dst.is_unwrapped = may_unwrap && (recipe.unwrap || !reason.empty());
    keep_material_uvs(dst.material_uvs, *mesh, recipe, dst.is_unwrapped);
    if (dst.is_unwrapped && !unwrap(*mesh, recipe, reason, options, error))
        return false;
    dst.mesh = std::move(mesh);
    return true;
}

} // namespace vmlight
