// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/export/write_mesh.h>

#include <vmlight/base/format.h>
#include <vmlight/base/output_file.h>
#include <vmlight/mesh/export/exporter.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

namespace vmlight {
namespace {

constexpr MeshWriter kWriters[]
    = { { ".glb", gltf_files, gltf_strand_files }, { ".obj", obj_files, obj_strand_files } };

const MeshWriter* find_writer(const std::string& path)
{
    const std::string extension = OIIO::Strutil::lower(OIIO::Filesystem::extension(path));
    for (const MeshWriter& writer : kWriters)
        if (extension == writer.extension)
            return &writer;
    return nullptr;
}

bool write_all(const std::vector<MeshFile>& files, std::string& error)
{
    for (const MeshFile& file : files)
        if (!write_file(file.path, file.bytes, error))
            return false;
    return true;
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
    return error.empty() && check_mesh(mesh, error) && write_all(find_writer(path)->write(mesh, path), error);
}

bool write_strands(const Strands& strands, const std::vector<Imath::V2f>& uvs, const std::string& path,
                   std::string& error)
{
    error = mesh_name_fault(path);
    return error.empty() && write_all(find_writer(path)->write_strands(strands, uvs, path), error);
}

} // namespace vmlight
