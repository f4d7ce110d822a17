// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cli/animation.h>

#include <vmlight/base/format.h>
#include <vmlight/image/image_file.h>
#include <vmlight/math/rotation.h>
#include <vmlight/uv/udim.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>

namespace vmlight {
namespace {

constexpr size_t kMostFramesNamed = 5; // of missing frames

// visit(key, name) for each input that may be a sequence.
template <class Visit> void each_input(LightmapRecipe& recipe, const Visit& visit)
{
    visit("vismap", recipe.vismap);
    visit("environment", recipe.environment);
    visit("cfem", recipe.cfem);
    visit("albedo", recipe.albedo);
    visit("mesh", recipe.mesh);
    for (std::string& occluder : recipe.occluder)
        visit("occluder", occluder);
}

} // namespace

bool is_sequence(const std::string& name)
{
    const std::string path = recipe_path(name);
    return path.find('#') != std::string::npos && !OIIO::Filesystem::exists(path);
}

std::string sequence_fault(const std::string& key, const std::string& name)
{
    return format("{}: \"{}\": no such file, and no frames: a sequence needs --frames, such as 1-48", key, name);
}

std::string missing_frames_fault(const std::string& name, const std::vector<int>& frames)
{
    if (!is_sequence(name) || has_udim_pattern(name))
        return "";
    std::vector<std::string> missing;
    std::string first;
    for (const int frame : frames) {
        const std::string path = frame_path(name, frame);
        // What a plugin generates has no file; a recipe does.
        if (recipe_stage(path).empty() ? may_be_image(path) : OIIO::Filesystem::exists(recipe_path(path)))
            continue;
        first = missing.empty() ? recipe_path(path) : first;
        missing.push_back(std::to_string(frame));
    }
    if (missing.empty())
        return "";
    const std::string fault = format("\"{}\": no such file", first);
    if (missing.size() == 1)
        return fault;
    const size_t named = std::min(missing.size(), kMostFramesNamed), more = missing.size() - named;
    missing.resize(named);
    return format("{}; frames {}{} are missing", fault, OIIO::Strutil::join(missing, ", "),
                  more ? format(" and {} more", more) : "");
}

std::string Animation::fault(const std::string& output) const
{
    if (frames.size() > 1 && !output.empty() && output.find('#') == std::string::npos)
        return format("\"{}\": {} frames need #### in the file name, for the number", output, frames.size());
    return has_frames || rotate_y.first == rotate_y.last
        ? ""
        : format("rotate_y: {} to {} degrees needs --frames", rotate_y.first, rotate_y.last);
}

std::string Animation::input_fault(const LightmapRecipe& recipe) const
{
    std::string fault;
    bool moves = rotate_y.first != rotate_y.last;
    LightmapRecipe copy = recipe;
    each_input(copy, [&](const char* key, const std::string& name) {
        moves = moves || is_sequence(name);
        if (fault.empty() && !has_frames && is_sequence(name))
            fault = sequence_fault(key, name);
    });
    if (frames.size() > 1 && !moves)
        return "frames: all frames are the same: give --rotate-y FIRST:LAST, or #### in the name of an input";
    return fault;
}

std::string Animation::missing_fault(const LightmapRecipe& recipe) const
{
    std::string fault;
    LightmapRecipe copy = recipe;
    each_input(copy, [&](const char*, const std::string& name) {
        if (fault.empty() && has_frames)
            fault = missing_frames_fault(name, frames);
    });
    return fault;
}

LightmapRecipe Animation::inputs_at(const LightmapRecipe& recipe, size_t index) const
{
    LightmapRecipe frame = recipe;
    each_input(frame, [&](const char*, std::string& name) {
        if (has_frames && is_sequence(name))
            name = frame_path(name, frames[index]);
    });
    return frame;
}

std::string Animation::path(const std::string& output, size_t index) const
{
    return has_frames ? frame_path(output, frames[index]) : output;
}

LightmapParams Animation::params_at(const LightmapParams& params, size_t index, std::string& error) const
{
    LightmapParams frame = params, own = params;
    own.env_rotate.clear();
    Rotation rotation;
    if (!rotates() || !lightmap_rotation(rotation, own, error))
        return frame;
    rotation = rotation_from_angles(0, rotate_y.at(index, frames.size()), 0) * rotation;
    frame.rotate.clear();
    frame.quaternion.clear();
    frame.matrix.assign(&rotation[0][0], &rotation[0][0] + 9);
    return frame;
}

} // namespace vmlight
