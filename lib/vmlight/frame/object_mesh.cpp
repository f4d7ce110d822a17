// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/object_mesh.h>

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/mesh/selection.h>
#include <vmlight/stage/cutouts.h>
#include <vmlight/stage/map_scene.h>
#include <vmlight/stage/overlap_hint.h>
#include <vmlight/stage/unwrap_report.h>
#include <vmlight/stage/uv_sets.h>
#include <vmlight/uv/raster.h>
#include <vmlight/uv/udim.h>
#include <vmlight/uv/unwrap.h>
#include <vmlight/vismap/baked_mesh.h>

#include <algorithm>
#include <memory>

namespace vmlight {
namespace {

using Imath::V2f;

bool read_part(Mesh& dst, const VismapRecipe& recipe, int uv_set, std::string& error)
{
    MeshParams params = recipe.mesh_params;
    params.uv_set = uv_set;
    if (!read_mesh(dst, recipe.mesh, params, error))
        return false;
    if (dst.instances) {
        error = format("\"{}\": a scene list, whose instances are not drawn; bake it with makevismap", recipe.mesh);
        return false;
    }
    if (recipe.selection.is_all())
        return true;
    std::vector<bool> chosen;
    std::string at;
    if (!choose_triangles(chosen, dst, recipe.selection, at, error))
        return false;
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
    if (!unwrap_mesh(mesh, params, &report, error))
        return false;
    options.report(format("{}: {}{}", mesh.name, reason, unwrap_line(report, params)));
    if (const std::string warning = unwrap_warning(report); !warning.empty())
        options.report_warning(warning);
    return true;
}

std::vector<std::vector<V2f>> material_uvs(const Mesh& mesh, const CutoutSource& source)
{
    std::vector<int> sets;
    for (const Material& material : mesh.materials)
        for (const MaterialTexture* texture : { &material.base_color_texture, &material.opacity_texture })
            if (texture->exists())
                sets.push_back(texture->uv_set);
    return other_uvs(mesh, sets, source.uv_set, source.loses_uvs, source.read_again);
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
    const auto read_again = [&](Mesh& again, int set) {
        std::string ignored; // a material that asks for UVs that the file lacks
        return read_part(again, recipe, set, ignored);
    };
    const CutoutSource source { recipe.mesh_params.uv_set, dst.is_unwrapped, read_again };
    dst.material_uvs = material_uvs(*mesh, source);
    if (recipe.cutout_params.cutouts != "off" && !read_cutouts(*mesh, source, nullptr, error))
        return false;
    if (dst.is_unwrapped && !unwrap(*mesh, recipe, reason, options, error))
        return false;
    dst.mesh = std::move(mesh);
    return true;
}

void warn_of_other_mesh(const Mesh& mesh, int uv_set, const OIIO::ImageSpec& map, const std::string& vismap,
                        const MakeOptions& options)
{
    const int baked_set = recipe_of_map(map).mesh_params.uv_set;
    if (uv_set != baked_set)
        options.report_warning(format("\"{}\": was baked with UV set {} of its mesh, and \"{}\" is read with set {}: "
                                      "pass --uv-set {}",
                                      vismap, baked_set, mesh.path, uv_set, baked_set));
    else if (!is_baked_of(mesh, map))
        options.report_warning(
            format("\"{}\": was baked from another mesh than \"{}\", or of another part of it", vismap, mesh.path));
}

} // namespace vmlight
