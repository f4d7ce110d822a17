// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/export/write_mesh.h>

#include <vmlight/base/format.h>
#include <vmlight/base/output_file.h>
#include <vmlight/mesh/export/exporter.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

namespace vmlight {
namespace {

constexpr MeshWriter kWriters[] = { { ".glb", gltf_files }, { ".obj", obj_files } };

const MeshWriter* find_writer(const std::string& path)
{
    const std::string extension = OIIO::Strutil::lower(OIIO::Filesystem::extension(path));
    for (const MeshWriter& writer : kWriters)
        if (extension == writer.extension)
            return &writer;
    return nullptr;
}

} // namespace

std::string mesh_name_fault(const std::string& path)
{
    if (find_writer(path))
        return "";
    std::string known;
    for (const MeshWriter& writer : kWriters)
        known += (known.empty() ? "" : " or ") + std::string(writer.extension);
    return format("\"{}\": a mesh is written as {}", path, known);
}

bool write_mesh(const Mesh& mesh, const std::string& path, std::string& error)
{
    error = mesh_name_fault(path);
    if (!error.empty() || !check_mesh(mesh, error))
        return false;
    for (const MeshFile& file : find_writer(path)->write(mesh, path))
        if (!write_file(file.path, file.bytes, error))
            return false;
    return true;
}

} // namespace vmlight
