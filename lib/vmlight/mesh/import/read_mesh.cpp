// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/read_mesh.h>

#include <vmlight/base/deep_stack.h>
#include <vmlight/base/format.h>
#include <vmlight/mesh/import/importer.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <vector>

namespace vmlight {
namespace {

// The first `most` bytes; none of a file that cannot be read.
std::string read_bytes(const std::string& path, uint64_t most)
{
    std::string bytes(most, '\0');
    bytes.resize(OIIO::Filesystem::read_bytes(path, bytes.data(), bytes.size()));
    return bytes;
}

std::string unknown_format(const std::vector<MeshFormat>& formats)
{
    std::vector<std::string> names;
    for (const MeshFormat& format : formats)
        names.emplace_back(format.name);
    return "unknown mesh format; supported: " + OIIO::Strutil::join(names, ", ");
}

// A function of its own, so that the bytes are freed before the file is read.
Inspection inspect(const MeshFormat& format, const std::string& path)
{
    return format.inspect ? format.inspect(file_bytes(path)) : Inspection();
}

bool import_parts(MeshBuilder& dst, const std::string& path, const BeforeOpen& before_open,
                  const std::vector<MeshFormat>& formats, bool keeps_instances, std::string& error)
{
    const FileHead head = read_head(path);
    if (OIIO::Strutil::starts_with(head.bytes, "PK\3\4")) {
        error = "a zip archive: unpack it, and pass the mesh inside";
        return false;
    }
    const MeshFormat* format = find_mesh_format(formats, path, head);
    if (!format) {
        error = unknown_format(formats);
        return false;
    }
    const ImportRequest request { path, *format, head, inspect(*format, path), before_open, keeps_instances };
    error = request.inspection.error;
    return error.empty() && format->read(dst, request, error);
}

} // namespace

std::string file_bytes(const std::string& path)
{
    return read_bytes(path, OIIO::Filesystem::file_size(path));
}

FileHead read_head(const std::string& path)
{
    if (!OIIO::Filesystem::is_regular(path))
        return {};
    return { read_bytes(path, FileHead::kBytes), OIIO::Filesystem::file_size(path) };
}

bool has_time(const std::string& path)
{
    const MeshFormat* format = find_mesh_format(mesh_formats(), path, read_head(path));
    return format && format->has_time;
}

bool has_heights(const std::string& path)
{
    const MeshFormat* format = find_mesh_format(mesh_formats(), path, read_head(path));
    return format && format->has_heights;
}

bool import_mesh(Mesh& dst, const std::string& path, const MeshParams& params, std::string& error,
                 const BeforeOpen& before_open, const std::vector<MeshFormat>& formats, bool keeps_instances)
{
    dst = Mesh();
    dst.name = OIIO::Filesystem::filename(path);
    dst.path = path;
    if (!OIIO::Filesystem::is_regular(path)) {
        error = format("\"{}\": {}", path, OIIO::Filesystem::exists(path) ? "not a file" : "no such file");
        return false;
    }
    bool good = false;
    run_on_deep_stack([&] { // inspections and libraries recurse down the node hierarchy
        MeshBuilder builder(dst, params);
        good = import_parts(builder, path, before_open, formats, keeps_instances, error) && builder.finish(error);
    });
    if (good)
        return true;
    error = format("\"{}\": {}", path, error);
    dst = Mesh();
    return false;
}

bool read_mesh(Mesh& dst, const std::string& path, const MeshParams& params, std::string& error,
               const std::function<void(const std::string& path)>& before_open)
{
    return import_mesh(dst, path, params, error, before_open);
}

bool read_instanced_mesh(Mesh& dst, const std::string& path, const MeshParams& params, std::string& error,
                         const std::function<void(const std::string& path)>& before_open)
{
    return import_mesh(dst, path, params, error, before_open, mesh_formats(), true);
}

} // namespace vmlight
