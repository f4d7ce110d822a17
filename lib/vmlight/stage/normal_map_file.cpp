// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/normal_map_file.h>

#include <vmlight/base/format.h>
#include <vmlight/image/image_file.h>
#include <vmlight/stage/material_normals.h>

#include <utility>

namespace vmlight {

bool read_normal_map(NormalMapPointer& dst, const VismapRecipe& recipe, std::shared_ptr<const Mesh> mesh, int nthreads,
                     std::vector<std::string>& notes, std::vector<std::string>& warnings, std::string& error,
                     std::vector<FileStamp>* files)
{
    dst = nullptr;
    if (recipe.material_normals) {
        auto map = std::make_shared<NormalMap>();
        if (!read_material_normals(*map, recipe, *mesh, nthreads, notes, warnings, files, error)) {
            error = format("\"{}\": {}", recipe.mesh, error);
            return false;
        }
        if (map->is_flat())
            return true;
        map->attach(std::move(mesh));
        dst = std::move(map);
        return true;
    }
    const std::string& path = recipe.normal_map;
    if (path.empty())
        return true;
    OIIO::ImageBuf image;
    if (!read_image(image, path, error))
        return false;
    auto map = std::make_shared<NormalMap>();
    std::vector<std::string> doubts;
    if (!map->decode(image, recipe.normal_map_params, recipe.vismap_params.size(), nthreads, doubts, error)) {
        error = format("\"{}\": {}", path, error);
        return false;
    }
    for (const std::string& doubt : doubts)
        warnings.push_back(format("\"{}\": {}", path, doubt));
    if (map->points_inwards())
        warnings.back() += "; if it is in object space, set normal_map_space to object";
    notes.push_back(format("normal map: {}x{}, {}", image.spec().width, image.spec().height,
                           map->is_flat() ? "flat, so that it changes nothing: left out"
                                          : "in " + recipe.normal_map_params.normal_map_space + " space"));
    if (map->is_flat())
        return true;
    map->attach(std::move(mesh));
    dst = std::move(map);
    return true;
}

} // namespace vmlight
