// SPDX-License-Identifier: Apache-2.0
#include "copied_command.h"

#include <vmlight/base/format.h>
#include <vmlight/frame/lit_object.h>
#include <vmlight/frame/scene_light.h>

#include <OpenImageIO/filesystem.h>

#include <cmath>

namespace vmlight::view {
namespace {

std::string numbers(const std::vector<double>& values)
{
    std::string text;
    for (const double value : values)
        text += (text.empty() ? "" : ",") + format("{:.10g}", value == 0 ? 0.0 : value);
    return text;
}

void add_flag(std::string& line, const char* flag, const std::string& value)
{
    line += format(" {} {}", flag, shell_word(value));
}

// The object's rotation with its turn: as plain as it can be said.
void add_rotation(std::string& line, const ViewState& state)
{
    const LightmapParams& light = state.light;
    const bool only_y = light.matrix.empty() && light.quaternion.empty()
        && (light.rotate.empty() || (light.rotate[0] == 0 && light.rotate[2] == 0));
    if (only_y) {
        const double y = state.turn + (light.rotate.empty() ? 0 : light.rotate[1]);
        if (y != 0)
            add_flag(line, "--rotate", numbers({ 0, y, 0 }));
    } else {
        Rotation pose;
        std::string ignored;
        object_pose(pose, light, ignored);
        add_flag(line, "--matrix", numbers(turned_light(light, pose, state.turn).matrix));
    }
    if (!light.env_rotate.empty() && light.env_rotate != std::vector<double> { 0, 0, 0 })
        add_flag(line, "--env-rotate", numbers(light.env_rotate));
}

void add_light(std::string& line, const Request& request, const ViewState& state, const std::string& model)
{
    if (!model.empty() && model != "auto")
        add_flag(line, "--model", model);
    add_rotation(line, state);
    if (state.light.exposure != 0)
        add_flag(line, "--exposure", format("{:.4g}", state.light.exposure));
    if (!request.filter.colorconfig.empty())
        add_flag(line, "--colorconfig", request.filter.colorconfig);
    if (!request.filter.colorspace.empty())
        add_flag(line, "--colorspace", request.filter.colorspace);
}

void add_trace(std::string& line, const TraceParams& trace)
{
    const BounceParams plain;
    if (trace.suns != "off")
        add_flag(line, "--suns", trace.suns);
    if (trace.bounce.bounce == "off")
        return;
    add_flag(line, "--bounce", trace.bounce.bounce);
    if (trace.bounce.bounce_rays != plain.bounce_rays)
        add_flag(line, "--bounce-rays", format("{}", trace.bounce.bounce_rays));
    if (trace.bounce.bounce_albedo != plain.bounce_albedo)
        add_flag(line, "--bounce-albedo", format("{:.6g}", trace.bounce.bounce_albedo));
}

void add_strands(std::string& line, const Request& request, bool is_white)
{
    const StrandParams &strands = request.mesh.strand_params, plain;
    for (const std::string& path : request.view.object)
        add_flag(line, "--object", path);
    if (!strands.radius.empty())
        add_flag(line, "--radius", strands.radius);
    if (strands.strand_texels != plain.strand_texels)
        add_flag(line, "--strand-texels", format("{}", strands.strand_texels));
    if (!request.view.strand_color.empty() && !is_white)
        add_flag(line, "--strand-color", numbers(request.view.strand_color));
    const SpecularParams &specular = request.specular, none;
    if (specular.strand_specular != none.strand_specular)
        add_flag(line, "--strand-specular", format("{:.6g}", specular.strand_specular));
    if (specular.strand_exponent != none.strand_exponent)
        add_flag(line, "--strand-exponent", format("{:.6g}", specular.strand_exponent));
}

std::string stem_of(const std::string& path)
{
    const std::string file = OIIO::Filesystem::filename(path);
    return file.substr(0, file.size() - OIIO::Filesystem::extension(file).size());
}

} // namespace

std::string shell_word(const std::string& text)
{
    static const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
    if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos)
        return text;
    std::string word = "'";
    for (const char c : text)
        word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return word + "'";
}

std::string makelightmap_command(const Request& request, const ViewState& state, const std::string& model)
{
    const std::string stem = stem_of(request.mesh.mesh);
    const std::string map = request.vismap.empty() ? stem + "_vismap.exr" : request.vismap;
    std::string line = format("makelightmap {} {}", shell_word(map), shell_word(request.environment));
    add_light(line, request, state, model);
    if (state.trace.suns != "off") {
        add_flag(line, "--suns", state.trace.suns);
        add_flag(line, "--mesh", request.mesh.mesh);
    }
    add_flag(line, "-o", stem + "_lit.exr");
    return line;
}

std::string vmframes_command(const Request& request, const ViewState& state, const std::string& model)
{
    std::string line = format("vmframes {} {}", shell_word(request.mesh.mesh), shell_word(request.environment));
    if (!request.vismap.empty())
        add_flag(line, "--vismap", request.vismap);
    add_strands(line, request, state.is_white);
    const bool is_compared = !state.second.empty();
    add_light(line, request, state, is_compared ? "" : model);
    add_trace(line, state.trace);
    if (is_compared)
        add_flag(line, "--wipe", (model.empty() ? "auto" : model) + "," + state.second);
    const CameraParams plain;
    if (!state.camera.camera.empty()) {
        add_flag(line, "--camera", state.camera.camera);
    } else {
        if (state.camera.azimuth != plain.azimuth)
            add_flag(line, "--azimuth", format("{:.6g}", state.camera.azimuth));
        if (state.camera.elevation != plain.elevation)
            add_flag(line, "--elevation", format("{:.6g}", state.camera.elevation));
        if (state.camera.fov != plain.fov)
            add_flag(line, "--fov", format("{:.6g}", state.camera.fov));
        if (state.camera.fill != plain.fill)
            add_flag(line, "--fill", format("{:.4g}", state.camera.fill));
        if (!state.camera.look_at.empty())
            add_flag(line, "--look-at", numbers(state.camera.look_at));
    }
    if (state.has_background)
        add_flag(line, "--background", "environment");
    if (state.is_white)
        line += " --white";
    if (!state.display.display.empty())
        add_flag(line, "--display", state.display.display);
    if (!state.display.view.empty())
        add_flag(line, "--view", state.display.view);
    if (!state.display.look.empty())
        add_flag(line, "--look", state.display.look);
    add_flag(line, "-o", stem_of(request.mesh.mesh) + ".png");
    return line;
}

} // namespace vmlight::view
