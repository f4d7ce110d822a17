// SPDX-License-Identifier: Apache-2.0
#include "request.h"

#include <vmlight/base/format.h>
#include <vmlight/image/picture_file.h>

#include <OpenImageIO/strutil.h>

namespace vmlight::view {

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
    if (!request.output.empty() && !OIIO::Strutil::iends_with(request.output, ".exr")
        && (!is_picture_name(request.output) || is_animation_name(request.output)))
        return format("\"{}\": the extension must be exr, png, jpg, webp or tif", request.output);
    return "";
}

} // namespace vmlight::view
