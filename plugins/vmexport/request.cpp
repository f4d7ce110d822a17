// SPDX-License-Identifier: Apache-2.0
#include "request.h"

#include <vmlight/base/format.h>
#include <vmlight/base/param_text.h>
#include <vmlight/uv/udim.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

namespace vmlight::exporting {
namespace {

bool writes_tangent_normals(const Request& request)
{
    return request.writes("bent_normal") && request.params.space == "tangent";
}

std::string gltf_fault(const Request& request)
{
    const std::string& path = request.files.gltf;
    if (path.empty())
        return "";
    if (OIIO::Strutil::lower(OIIO::Filesystem::extension(path)) != ".glb")
        return format("--gltf \"{}\": the extension must be .glb", path);
    if (request.files.mesh.empty())
        return "--gltf needs --mesh, the mesh that the map was baked from";
    if (request.params.ao_gamma != 1)
        return "--ao-gamma: the occlusion of a glTF is linear";
    return has_udim_pattern(request.vismap) ? "--gltf: one tile at a time; glTF knows no UDIM" : "";
}

std::string html_fault(const Request& request)
{
    const std::string& path = request.files.html;
    if (path.empty())
        return "";
    if (OIIO::Strutil::lower(OIIO::Filesystem::extension(path)) != ".html")
        return format("--html \"{}\": the extension must be .html", path);
    if (request.files.mesh.empty())
        return "--html needs --mesh, the mesh that the map was baked from";
    if (request.files.environment.empty())
        return "--html needs --environment, the light to show the mesh in; it may be repeated";
    return has_udim_pattern(request.vismap) ? "--html: one tile at a time" : "";
}

std::string textures_fault(const Request& request)
{
    const ExportTarget* target = request.target();
    if (request.folder.empty())
        return "";
    if (!target)
        return "--for is missing, the engine whose conventions the textures follow: "
            + OIIO::Strutil::join(words_of(export_target_choices().choices), ", ");
    if (request.params.target == "gltf" && request.params.ao_gamma != 1)
        return "--ao-gamma: the occlusion of a glTF is linear";
    if (request.writes("bent_normal") && request.params.space == "object"
        && target->bent_normal == BentNormalSlot::Tangent)
        return format("--space object: {} reads bent normals in tangent space only", target->name);
    return writes_tangent_normals(request) && request.files.mesh.empty()
        ? "bent normals in tangent space need --mesh, the mesh that the map was baked from"
        : "";
}

} // namespace

bool Request::writes(const std::string& map) const
{
    if (folder.empty() || !target())
        return false;
    if (!params.maps.empty())
        return params.has(map);
    return map == "ao" || (map == "bent_normal" && target()->bent_normal != BentNormalSlot::None);
}

std::string request_fault(const Request& request)
{
    if (request.folder.empty() && request.files.gltf.empty() && request.files.html.empty())
        return "-o FOLDER is missing (or --gltf, or --html)";
    if (request.files.name.find('/') != std::string::npos)
        return format("--name \"{}\": the start of a file's name, without a folder", request.files.name);
    for (const std::string& fault : { gltf_fault(request), html_fault(request) })
        if (!fault.empty())
            return fault;
    return textures_fault(request);
}

std::string unused_reason(const Request& request, const std::string& name)
{
    const bool of_folder = name == "for" || name == "maps" || name == "depth" || name == "ao_gamma" || name == "space"
        || name == "green" || name == "sh_file" || name == "pack" || name == "name" || name == "lightmap_encoding"
        || name == "rgbm_range";
    if (request.folder.empty() && request.files.gltf.empty() && request.files.html.empty())
        return ""; // nothing is written at all
    const bool of_html
        = name == "environment" || name == "colorspace" || name == "colorconfig" || name == "layer" || name == "layout";
    if (of_html && request.files.html.empty())
        return "no --html is given";
    if (of_folder && request.folder.empty())
        return "no textures are written without -o";
    if (request.folder.empty() || !request.target())
        return name == "gltf_light" && request.files.lightmap.empty() ? "no --lightmap is given" : "";
    if ((name == "ao_gamma" || name == "pack") && !request.writes("ao"))
        return "no ambient occlusion is written";
    if (name == "space" && !request.writes("bent_normal"))
        return "no bent normal is written";
    if (name == "green" && !writes_tangent_normals(request))
        return "no bent normal in tangent space is written";
    if (name == "sh_file" && !request.writes("sh"))
        return "no spherical harmonics are written";
    if ((name == "lightmap_encoding" || name == "gltf_light") && request.files.lightmap.empty())
        return "no --lightmap is given";
    if (name == "gltf_light" && request.files.gltf.empty())
        return "no --gltf is given";
    if (name == "rgbm_range" && (request.files.lightmap.empty() || request.params.lightmap_encoding != "rgbm"))
        return "no lightmap is encoded as RGBM";
    return "";
}

} // namespace vmlight::exporting
