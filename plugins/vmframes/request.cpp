// SPDX-License-Identifier: Apache-2.0
#include "request.h"

#include "film.h"

#include <vmlight/base/format.h>
#include <vmlight/base/frames.h>
#include <vmlight/base/output_file.h>
#include <vmlight/cli/animation.h>
#include <vmlight/frame/strand_flags.h>
#include <vmlight/image/image_file.h>
#include <vmlight/image/picture_file.h>
#include <vmlight/stage/recipe/unused_flags.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>

namespace vmlight::frames {
namespace {

std::string output_fault_of(const Request& request)
{
    const std::string& output = request.output;
    if (!is_exr_name(output) && !is_picture_name(output) && !is_film_name(output))
        return format("\"{}\": the extension must be exr, png, jpg, webp, tif, gif, mp4, mov or webm", output);
    if (is_film_name(output))
        if (const std::string fault = film_fault(); !fault.empty())
            return format("\"{}\": {}", output, fault);
    const bool has_number = output.find('#') != std::string::npos;
    if (request.frames.size() > 1 && !has_number && !holds_all_frames(output))
        return format("\"{}\": {} frames need #### in the file name, for the number", output, request.frames.size());
    const std::string& sheet = request.sheet.contact_sheet;
    if (!sheet.empty() && (!is_picture_name(sheet) || is_animation_name(sheet)))
        return format("--contact-sheet: \"{}\": the extension must be png, jpg, webp or tif", sheet);
    for (const int frame : request.frames)
        if (!sheet.empty() && frame_path(output, frame) == sheet)
            return format("--contact-sheet: \"{}\" is the file of frame {} too", sheet, frame);
    return sheet.empty() ? "" : output_file_fault(sheet);
}

// visit(key, name) for each input that may have a file for each frame.
template <class Visit> void each_moving(Request& request, const Visit& visit)
{
    visit("mesh", request.object.map.mesh);
    for (std::string& object : request.stage.object)
        visit("object", object);
    visit("vismap", request.object.vismap);
}

// What is wrong with files for each frame, or "".
std::string sequence_fault_of(const Request& request)
{
    std::string fault;
    Request copy = request;
    each_moving(copy, [&](const char* key, const std::string& name) {
        if (fault.empty() && !request.has_frames && is_sequence(name))
            fault = sequence_fault(key, name);
    });
    if (fault.empty() && request.moves() && !request.sheet.keep.empty())
        return "--keep is for one map of each object: not with a file for each frame; makevismap --frames and "
               "makelightmap --frames make those of all";
    return fault;
}

std::string models_fault(const Request& request)
{
    if (!request.sheet.wipe.empty() && !request.sheet.side_by_side.empty())
        return "give only one of --wipe and --side-by-side";
    if (!request.sheet.wipe.empty() && request.sheet.wipe.size() != 2)
        return format("--wipe needs two models, such as paper,reference; it has {}", request.sheet.wipe.size());
    if (request.sheet.side_by_side.size() == 1)
        return "--side-by-side needs two models or more, such as ao,paper,reference";
    Choices known = model_choices();
    known.choices.push_back({ kReferenceModel, "" });
    for (const std::string& model : request.models()) {
        std::string word, error;
        if (!parse_value(word, model, known, error))
            return format("model: {}", error);
    }
    return "";
}

bool is_any(const std::vector<std::string>& words, const std::string& word)
{
    return std::find(words.begin(), words.end(), word) != words.end();
}

std::string unused_light(const Request& request, const std::string& name)
{
    const bool is_shown_alone
        = !request.object.texture.empty() && request.stage.object.empty() && request.stage.ground == "none";
    const std::string filter = "cfem_", reference = "reference_";
    if (OIIO::Strutil::starts_with(name, reference) && !is_any(request.models(), kReferenceModel))
        return "only the model reference uses it";
    if (OIIO::Strutil::starts_with(name, filter) && request.environment.empty())
        return "there is no environment";
    if (OIIO::Strutil::starts_with(name, filter))
        return unused_reason(request.filter, name.substr(filter.size()));
    const bool is_traced = is_any(param_names(TraceParams()), name);
    const bool is_mirrored = is_any(param_names(SpecularParams()), name);
    if ((is_traced || is_mirrored
         || is_any({ "model", "env_rotate", "turn_environment", "colorspace", "layer", "layout" }, name))
        && request.environment.empty())
        return "there is no environment";
    if ((is_traced || is_mirrored || name == "model") && is_shown_alone)
        return "the texture is shown as it is";
    const std::vector<std::string> models = request.models();
    if (name == "suns" && size_t(std::count(models.begin(), models.end(), kReferenceModel)) == models.size())
        return "the model reference traces the whole environment";
    if (is_traced) {
        LightmapRecipe lit;
        lit.bounce_params = request.object.trace.bounce;
        return unused_reason(lit, name);
    }
    if (name == "model" && (!request.sheet.wipe.empty() || !request.sheet.side_by_side.empty()))
        return "the models are those that are compared";
    return "";
}

std::vector<std::string> paths_of(const Request& request)
{
    std::vector<std::string> paths { request.object.map.mesh };
    paths.insert(paths.end(), request.stage.object.begin(), request.stage.object.end());
    return paths;
}

std::string unused_map(const Request& request, const std::string& name)
{
    if (is_strand_flag(name))
        return unused_strand_flag(name, has_strands(request), request.stage.white, request.specular);
    const bool is_only_one = request.stage.object.empty() && request.stage.ground == "none";
    if (is_any(param_names(VismapParams()), name) && is_only_one && !request.object.vismap.empty())
        return "the visibility map is made already";
    if (is_any(param_names(VismapParams()), name) && is_only_one && !request.object.texture.empty())
        return "the texture is shown as it is: no visibility map is baked";
    return name == "fps" ? "" : unused_reason(shown_recipe(request.object.map, paths_of(request)), name);
}

std::string unused_picture(const Request& request, const std::string& name)
{
    if (name == "background_blur" && request.stage.background != "environment")
        return "only --background environment is blurred";
    if (name == "fps" && !holds_all_frames(request.output)
        && request.object.map.mesh_params.frame == MeshParams::kFirstSample)
        return "only films and GIFs have a speed";
    if (is_any(param_names(DisplayParams()), name) && is_exr_name(request.output)
        && request.sheet.contact_sheet.empty())
        return "an EXR holds scene-linear light, as no display shows it";
    if (is_any(param_names(FileParams()), name) && !is_exr_name(request.output))
        return "only an EXR is stored so";
    return "";
}

} // namespace

bool Request::moves() const
{
    bool found = false;
    Request copy = *this;
    each_moving(copy,
                [&](const char*, const std::string& name) { found = found || (has_frames && is_sequence(name)); });
    return found;
}

std::string Request::missing_fault() const
{
    std::string fault;
    Request copy = *this;
    each_moving(copy, [&](const char*, const std::string& name) {
        if (fault.empty() && has_frames)
            fault = missing_frames_fault(name, frames);
    });
    return fault.empty() && has_frames ? missing_frames_fault(object.texture, frames) : fault;
}

Request Request::at(size_t index) const
{
    Request frame = *this;
    each_moving(frame, [&](const char*, std::string& name) {
        if (has_frames && is_sequence(name))
            name = frame_path(name, frames[index]);
    });
    return frame;
}

bool has_strands(const Request& request)
{
    return shows_strands(request.object.map, paths_of(request));
}

bool is_exr_name(const std::string& path)
{
    return OIIO::Strutil::iends_with(path, ".exr");
}

bool holds_all_frames(const std::string& path)
{
    return is_animation_name(path) || is_film_name(path);
}

std::string request_fault(const Request& request)
{
    const bool has_light = !request.environment.empty();
    if (!has_light && request.object.texture.empty())
        return "ENVIRONMENT is missing, and there is no --texture";
    if (request.object.texture.find('#') != std::string::npos && !request.has_frames)
        return format("--texture: \"{}\" is a sequence: --frames is missing, such as 1-48", request.object.texture);
    if (const std::string fault = sequence_fault_of(request); !fault.empty())
        return fault;
    if (!request.object.vismap.empty() && !request.object.texture.empty())
        return "give only one of --vismap and --texture";
    if (!has_light && request.stage.background == "environment")
        return "--background environment: there is no environment";
    if (!has_light && request.is_auto_exposed)
        return "--exposure auto: there is no environment to expose for";
    const std::string& ground = request.stage.ground;
    if (ground != "none" && ground != "white" && ground != "shadow" && !OIIO::Filesystem::is_regular(ground))
        return format("--ground: \"{}\" is neither none, white, shadow nor a file", ground);
    if (!request.sheet.keep.empty())
        if (const std::string fault = output_folder_fault(request.sheet.keep); !fault.empty())
            return "--keep: " + fault;
    if ((request.turn.turntable || request.turn.turn_environment) && !request.has_frames)
        return "--turntable and --turn-environment need --frames, such as 1-48";
    if (request.stage.background != "none" && request.stage.background != "environment") {
        std::vector<double> color;
        std::string error;
        if (!parse_value(color, request.stage.background, Numbers { 3 }, error))
            return format("--background: \"{}\" is neither none, environment nor a colour such as 0.2,0.2,0.2",
                          request.stage.background);
    }
    if (!request.render.layers.empty() && !is_exr_name(request.output))
        return format("--layers need an .exr to be written to; -o is \"{}\"", request.output);
    const std::string fault = models_fault(request);
    return fault.empty() ? output_fault_of(request) : fault;
}

std::string unused_reason(const Request& request, const std::string& name)
{
    for (const std::string& reason : { unused_reason(request.camera, name), unused_picture(request, name),
                                       unused_light(request, name), unused_map(request, name) })
        if (!reason.empty())
            return reason;
    return "";
}

} // namespace vmlight::frames
