// SPDX-License-Identifier: Apache-2.0
#include "request.h"

#include <vmlight/base/format.h>
#include <vmlight/frame/strand_flags.h>
#include <vmlight/image/image_file.h>
#include <vmlight/image/picture_file.h>
#include <vmlight/stage/recipe/unused_flags.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>

namespace vmlight::view {
namespace {

std::vector<std::string> paths_of(const Request& request)
{
    std::vector<std::string> paths { request.mesh.mesh };
    paths.insert(paths.end(), request.view.object.begin(), request.view.object.end());
    return paths;
}

} // namespace

std::string request_fault(const Request& request)
{
    const ViewParams& view = request.view;
    if (view.headless && request.output.empty() && view.bench == 0)
        return "--headless needs -o PICTURE, or --bench";
    if (request.has_window())
        return "";
    if (request.mesh.mesh.empty())
        return "MESH is missing; only a window opens without one";
    if (request.environment.empty() && (view.show == "lit" || view.background == "environment"))
        return "ENVIRONMENT is missing; only a window, and --show other than lit, do without one";
    if (view.show != "lit" && (request.exposure_given || request.is_auto_exposed))
        return format("--exposure: --show {} has no light to expose", view.show);
    if (!request.output.empty() && !OIIO::Strutil::iends_with(request.output, ".exr")
        && (!is_picture_name(request.output) || is_animation_name(request.output)))
        return format("\"{}\": the extension must be exr, png, jpg, webp or tif", request.output);
    return "";
}

std::string unused_reason(const Request& request, const std::string& name)
{
    const auto is_one_of = [&](const std::vector<std::string>& names) {
        return std::find(names.begin(), names.end(), name) != names.end();
    };
    const std::string filter = "cfem_";
    if (OIIO::Strutil::starts_with(name, filter))
        return unused_reason(request.filter, name.substr(filter.size()));
    if (request.has_window())
        return "";
    if (is_one_of(param_names(TraceParams()))) {
        LightmapRecipe lit;
        lit.bounce_params = request.trace.bounce;
        return request.environment.empty() ? "there is no environment" : unused_reason(lit, name);
    }
    if (is_strand_flag(name))
        return unused_strand_flag(name, shows_strands(request.mesh, paths_of(request)), request.view.white,
                                  request.specular);
    if (is_one_of(param_names(VismapParams())) && name != "udim" && !request.vismap.empty()
        && request.view.object.empty())
        return "the visibility map is made already";
    if (name == "background_blur" && request.view.background != "environment")
        return "only --background environment is blurred";
    if (is_one_of(param_names(DisplayParams())) && OIIO::Strutil::iends_with(request.output, ".exr"))
        return "an EXR holds scene-linear light, as no display shows it";
    if (is_one_of(param_names(DisplayParams())) && request.view.show != "lit")
        return format("--show {} is not light, which a display would change", request.view.show);
    if (is_one_of(param_names(FileParams())) && !OIIO::Strutil::iends_with(request.output, ".exr"))
        return "only an EXR is stored so";
    const std::string reason = unused_reason(request.camera, name);
    return reason.empty() ? unused_reason(shown_recipe(request.mesh, paths_of(request)), name) : reason;
}

} // namespace vmlight::view
