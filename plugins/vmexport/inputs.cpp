// SPDX-License-Identifier: Apache-2.0
#include "inputs.h"

#include <vmlight/base/format.h>
#include <vmlight/export/lightmap_encoding.h>
#include <vmlight/frame/object_mesh.h>
#include <vmlight/image/image_file.h>
#include <vmlight/lightmap/lightmap_check.h>
#include <vmlight/lightmap/vismap_check.h>
#include <vmlight/stage/map_scene.h>
#include <vmlight/stage/open_source.h>
#include <vmlight/stage/recipe/paths.h>
#include <vmlight/uv/udim.h>
#include <vmlight/vismap/baked_mesh.h>

namespace vmlight::exporting {

bool find_tiles(std::vector<MapTile>& dst, const std::string& vismap, std::string& error)
{
    dst.clear();
    if (!has_udim_pattern(vismap)) {
        const int udim = udim_from_name(recipe_path(vismap));
        dst.push_back({ vismap, udim, udim != 0 });
        return true;
    }
    for (const int udim : existing_udims(recipe_path(vismap)))
        dst.push_back({ udim_path(vismap, udim), udim, true });
    if (dst.empty())
        error = format("\"{}\": no files match", vismap);
    return !dst.empty();
}

bool read_map(OIIO::ImageBuf& dst, const std::string& path, const MakeOptions& options, std::string& error)
{
    LightmapRecipe recipe;
    recipe.vismap = path;
    const PixelSourcePointer source = open_input(recipe, "vismap", path, InputKind::Vismap, error, {});
    std::vector<OIIO::ImageBuf> images;
    if (!source || !make_input(images, *source, {}, recipe, "vismap", path, options, error))
        return false;
    dst = std::move(images[0]);
    std::vector<std::string> warnings;
    if (!check_vismap(dst, source->spec(), options.threads, warnings, error)) {
        error = format("\"{}\": {}", path, error);
        return false;
    }
    if (recipe_of_map(dst.spec()).vismap_params.measure != "cosine")
        warnings.push_back("baked with --measure uniform; engines expect directions weighted by the cosine");
    for (const std::string& warning : warnings)
        options.report_warning(format("\"{}\": {}", path, warning));
    return true;
}

bool read_lightmap(OIIO::ImageBuf& dst, const std::string& path, const OIIO::ImageSpec& map, const MakeOptions& options,
                   std::string& error)
{
    OIIO::ImageBuf image;
    if (!read_image(image, path, error))
        return false;
    error = lightmap_fault(image.spec());
    if (!error.empty() || !engine_light(dst, image, error)) {
        error = format("\"{}\": {}", path, error);
        return false;
    }
    if (const std::string warning = other_mesh_warning(image.spec(), map); !warning.empty())
        options.report_warning(format("\"{}\": {}", path, warning));
    return true;
}

bool read_map_mesh(std::shared_ptr<const Mesh>& dst, const std::string& path, const OIIO::ImageSpec& map,
                   const MakeOptions& options, std::string& error)
{
    VismapRecipe recipe = recipe_of_map(map);
    recipe.mesh = path;
    recipe.cutout_params.cutouts = "off"; // nothing is traced
    ObjectMesh mesh;
    if (!read_object_mesh(mesh, recipe, recipe.unwrap, options, error))
        return false;
    if (!is_baked_of(*mesh.mesh, map))
        options.report_warning(format("\"{}\": not the mesh that the map was baked from, or changed since", path));
    dst = std::move(mesh.mesh);
    return true;
}

} // namespace vmlight::exporting
