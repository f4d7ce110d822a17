// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/format.h>
#include <vmlight/mesh/import/format_checks.h>
#include <vmlight/mesh/import/mtl.h>
#include <vmlight/mesh/import/obj.h>
#include <vmlight/mesh/import/obj_text.h>
#include <vmlight/mesh/import/side_files.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <iterator>

namespace vmlight {
namespace {

// The materials of all libraries. One that is not there is no error: many files travel without.
std::vector<Material> read_libraries(MeshBuilder& dst, const obj::File& file, const ImportRequest& request)
{
    std::vector<Material> materials;
    const auto read = [&](const std::string& name) {
        const std::string path = find_side_file(OIIO::Filesystem::parent_path(request.path), name);
        if (path.empty())
            return false;
        if (request.before_open)
            request.before_open(path);
        add_mtl_materials(materials, file_bytes(path), OIIO::Filesystem::parent_path(path));
        return true;
    };
    for (const obj::Library& library : file.libraries) {
        if (read(library.names)) // one, whose name may have blanks
            continue;
        for (const std::string& name : OIIO::Strutil::splits(library.names))
            if (!read(name))
                dst.warn(format("no material file \"{}\", which line {} names", name, library.line));
    }
    return materials;
}

// A function of its own, so that the text is freed before the mesh is built.
bool parse_obj(obj::File& dst, const ImportRequest& request, std::string& error)
{
    if (request.before_open)
        request.before_open(request.path);
    return obj::parse(dst, file_bytes(request.path), error);
}

} // namespace

bool is_obj(const FileHead& head)
{
    const char* const keywords[] = { "mtllib", "usemtl", "o", "g", "s", "v", "vt", "vn", "vp", "f" };
    if (head.bytes.find('\0') != std::string::npos)
        return false;
    obj::Statements statements(head.bytes);
    obj::Statement statement;
    if (!statements.next(statement) || statement.arguments.empty())
        return false;
    return std::any_of(std::begin(keywords), std::end(keywords),
                       [&](const char* keyword) { return statement.keyword == keyword; });
}

bool read_obj(MeshBuilder& dst, const ImportRequest& request, std::string& error)
{
    obj::File file;
    return parse_obj(file, request, error) && append_obj(dst, file, read_libraries(dst, file, request), error);
}

} // namespace vmlight
