// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/alembic.h>
#include <vmlight/mesh/import/assimp_importer.h>
#include <vmlight/mesh/import/format_checks.h>
#include <vmlight/mesh/import/gltf.h>
#include <vmlight/mesh/import/height_field.h>
#include <vmlight/mesh/import/importer.h>
#include <vmlight/mesh/import/obj.h>
#include <vmlight/mesh/import/ply.h>
#include <vmlight/mesh/import/scene_list.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>

namespace vmlight {
namespace {

bool has_extension(const MeshFormat& format, const std::string& path)
{
    const std::vector<std::string> extensions = OIIO::Strutil::splits(format.extensions);
    return std::any_of(extensions.begin(), extensions.end(),
                       [&](const std::string& e) { return OIIO::Strutil::iends_with(path, "." + e); });
}

} // namespace

const std::vector<MeshFormat>& mesh_formats()
{
    static const std::vector<MeshFormat> formats {
        { "OBJ", "obj", is_obj, nullptr, read_obj },
        { "PLY", "ply", is_ply, nullptr, read_ply },
        { "STL", "stl", is_stl, nullptr, read_with_assimp },
        { "glTF 2.0", "gltf glb", is_gltf, nullptr, read_gltf },
        { "Collada", "dae xml", is_collada, inspect_collada, read_with_assimp },
        { "FBX", "fbx", is_fbx, inspect_fbx, read_with_assimp },
        { "Alembic", "abc", is_alembic, nullptr, read_alembic, true },
        { "height image", "", is_height_field, nullptr, read_height_field, false, true },
        { "scene list", "toml", is_scene_list, nullptr, read_scene_list, true, true }, // whose meshes may be
    };
    return formats;
}

const MeshFormat* find_mesh_format(const std::vector<MeshFormat>& formats, const std::string& path,
                                   const FileHead& head)
{
    const auto has_content = [&](const MeshFormat& format) { return format.has_content && format.has_content(head); };
    auto format = std::find_if(formats.begin(), formats.end(), has_content);
    if (format == formats.end())
        format
            = std::find_if(formats.begin(), formats.end(), [&](const MeshFormat& f) { return has_extension(f, path); });
    return format == formats.end() ? nullptr : &*format;
}

bool is_mesh_name(const std::string& path)
{
    const auto& formats = mesh_formats();
    return std::any_of(formats.begin(), formats.end(), [&](const MeshFormat& f) { return has_extension(f, path); });
}

} // namespace vmlight
