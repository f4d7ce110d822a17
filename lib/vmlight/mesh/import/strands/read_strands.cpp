// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/strands/read_strands.h>

#include <vmlight/base/deep_stack.h>
#include <vmlight/base/format.h>
#include <vmlight/mesh/import/alembic.h>
#include <vmlight/mesh/import/gltf.h>
#include <vmlight/mesh/import/obj.h>
#include <vmlight/mesh/import/strands/strand_format.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <utility>

namespace vmlight {
namespace {

const StrandFormat* find_strand_format(const std::string& path, const FileHead& head)
{
    const auto& formats = strand_formats();
    const auto has_content = [&](const StrandFormat& format) { return format.has_content && format.has_content(head); };
    const auto has_extension = [&](const StrandFormat& format) {
        const std::vector<std::string> extensions = OIIO::Strutil::splits(format.extensions);
        return std::any_of(extensions.begin(), extensions.end(),
                           [&](const std::string& e) { return OIIO::Strutil::iends_with(path, "." + e); });
    };
    auto found = std::find_if(formats.begin(), formats.end(), has_content);
    if (found == formats.end())
        found = std::find_if(formats.begin(), formats.end(), has_extension);
    return found == formats.end() ? nullptr : &*found;
}

std::string unknown_strand_format()
{
    std::vector<std::string> names;
    for (const StrandFormat& format : strand_formats())
        names.emplace_back(format.name);
    return "unknown format of strands; supported: " + OIIO::Strutil::join(names, ", ");
}

} // namespace

const std::vector<StrandFormat>& strand_formats()
{
    static const std::vector<StrandFormat> formats {
        { "HAIR", "hair", is_hair, nullptr, true, read_hair },
        { "OBJ", "obj", is_obj, has_obj_lines_alone, false, read_obj_lines },
        { "glTF 2.0", "gltf glb", is_gltf, has_gltf_lines_alone, false, read_gltf_lines },
        { "Alembic", "abc", is_alembic, has_alembic_curves_alone, true, read_alembic_curves },
        { "TressFX", "tfx", nullptr, nullptr, false, read_tfx },
    };
    return formats;
}

bool is_strand_file(const std::string& path)
{
    const StrandFormat* format = find_strand_format(path, read_head(path));
    return format && (!format->has_lines_alone || (format->has_radius && has_lines_alone(path)));
}

bool has_lines_alone(const std::string& path)
{
    const MeshParams params;
    const StrandRequest request { path, read_head(path), params, {} };
    const StrandFormat* format = find_strand_format(path, request.head);
    bool has_lines = false;
    if (format && format->has_lines_alone)
        run_on_deep_stack([&] { has_lines = format->has_lines_alone(request); });
    return has_lines;
}

bool read_strands(Strands& dst, const std::string& path, const MeshParams& params, const std::string& radius,
                  std::string& error, const BeforeOpen& before_open)
{
    dst = Strands();
    dst.name = OIIO::Filesystem::filename(path);
    dst.path = path;
    if (!OIIO::Filesystem::is_regular(path)) {
        error = format("\"{}\": {}", path, OIIO::Filesystem::exists(path) ? "not a file" : "no such file");
        return false;
    }
    if (before_open)
        before_open(path);
    const StrandRequest request { path, read_head(path), params, before_open };
    const StrandFormat* const format_of_file = find_strand_format(path, request.head);
    error.clear();
    if (!format_of_file)
        error = unknown_strand_format();
    else
        run_on_deep_stack([&] { format_of_file->read(dst, request, error); }); // glTF recurses down its nodes
    if (!error.empty()) {
        error = format("\"{}\": {}", path, error);
        return false;
    }
    if (params.up == "z")
        for (Imath::V3d& p : dst.points)
            p = Imath::V3d(p.x, p.z, -p.y);
    return set_radius(dst, radius, error) && check_strands(dst, error);
}

} // namespace vmlight
