// SPDX-License-Identifier: Apache-2.0
#include "keep.h"

#include <vmlight/base/format.h>
#include <vmlight/image/image_file.h>
#include <vmlight/mesh/export/write_mesh.h>

#include <OpenImageIO/filesystem.h>

namespace vmlight::frames {
namespace {

bool write_tiles(const TileMaps& tiles, const std::string& start, std::string& error)
{
    for (const auto& [udim, image] : tiles) {
        const std::string path = tiles.size() == 1 ? start + ".exr" : format("{}.{}.exr", start, udim);
        if (!write_image(image, path, {}, {}, error))
            return false;
    }
    return true;
}

} // namespace

bool keep_maps(const Shot& shot, const Request& request, std::string& error)
{
    const std::string& folder = request.sheet.keep;
    if (!OIIO::Filesystem::is_directory(folder) && !OIIO::Filesystem::create_directory(folder, error)) {
        error = format("\"{}\": {}", folder, error);
        return false;
    }
    int number = 0;
    for (const auto& object : shot.objects()) {
        const std::string& file = object->mesh().name;
        const size_t stem = file.size() - OIIO::Filesystem::extension(file).size();
        const std::string start
            = format("{}/{}{}", folder, file.substr(0, stem), number ? format("_{}", number + 1) : "");
        ++number;
        if (!object->has_maps())
            continue;
        if (!write_tiles(object->maps(), start + "_vismap", error)
            || !write_tiles(object->lightmaps(), start + "_lightmap", error)
            || (object->is_unwrapped() && !write_mesh(object->mesh(), start + "_unwrapped.glb", error)))
            return false;
    }
    return !shot.ground() || !shot.ground()->has_maps()
        || write_tiles(shot.ground()->maps(), folder + "/ground_vismap", error);
}

} // namespace vmlight::frames
