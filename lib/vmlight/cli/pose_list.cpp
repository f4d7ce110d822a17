// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cli/pose_list.h>

#include <vmlight/base/format.h>
#include <vmlight/base/frames.h>
#include <vmlight/cli/animation.h>
#include <vmlight/mesh/import/importer.h>

#include <OpenImageIO/filesystem.h>

#include <algorithm>

namespace vmlight {
PoseList::PoseList(StageMain& stage, VismapRecipe& recipe)
    : m_stage(stage)
    , m_recipe(recipe)
{
    stage.group("Frames and poses:");
    stage.option(
        "frames", "RANGE",
        "Frames to bake, such as 1-24, with #### in -o: of an Alembic mesh, or of files with #### in their names",
        [&](auto text, auto& error) { return parse_frames(m_frames, std::string(text), error); });
    stage.option(
        "pose", "MESH",
        "The same mesh in another pose: report before the bake how much the map changes in it; with #### in -o "
        "also bake it, as number 1 (the mesh is number 0). May be repeated",
        [&](auto text, auto&) {
            m_meshes.emplace_back(text);
            return true;
        });
    stage.option(
        "pose_error", "0..1",
        "With several frames or poses: the largest error of V in texels kept from another pose, for at least 99 % of "
        "them; 0 keeps only texels proven unchanged [0.02]",
        [&](auto text, auto& error) {
            m_has_error = true;
            if (parse_value(m_error, text, Range { 0, 1 }, error))
                return true;
            error = "pose_error: " + error;
            return false;
        });
    stage.check([&] { return fault(); });
}

// What is wrong with the command line, or "". Makes the recipe that of the first pose.
std::string PoseList::fault()
{
    const std::string& output = m_stage.output();
    if (has_frames() && !m_meshes.empty())
        return "give only one of --frames and --pose";
    if (m_has_error && !has_frames() && m_meshes.empty())
        return "--pose-error is for several poses: give --frames or --pose";
    if (count() > 1 && !output.empty() && output.find('#') == std::string::npos)
        return format("\"{}\": {} frames need #### in the file name, for the number", output, m_frames.size());
    if ((count() > 1 || !m_meshes.empty()) && m_recipe.time_budget > 0)
        return "--time-budget is for one map: frames and poses have as many rays as the first, see --samples";
    m_mesh = m_recipe.mesh;
    m_normal_map = m_recipe.normal_map;
    m_occluders = m_recipe.occluder;
    if (!has_frames())
        return "";
    std::vector<std::string> inputs { m_mesh, m_normal_map };
    inputs.insert(inputs.end(), m_occluders.begin(), m_occluders.end());
    const bool has_files = std::any_of(inputs.begin(), inputs.end(), vmlight::is_sequence);
    m_has_time = std::any_of(inputs.begin(), inputs.end(), [](const std::string& path) { return has_time(path); });
    if (!has_files && !m_has_time)
        return format(
            "frames: \"{}\" is the same in all frames: give an Alembic file, or #### in the name of the mesh or an "
            "occluder",
            m_mesh);
    if (m_recipe.mesh_params.frame != MeshParams::kFirstSample)
        return "give only one of --frame and --frames";
    m_recipe = at(m_recipe, 0);
    return "";
}

size_t PoseList::count() const
{
    if (has_frames())
        return m_frames.size();
    return m_stage.output().find('#') != std::string::npos ? 1 + m_meshes.size() : 1;
}

std::string PoseList::missing_fault() const
{
    std::vector<std::string> inputs { m_mesh, m_normal_map };
    inputs.insert(inputs.end(), m_occluders.begin(), m_occluders.end());
    std::string fault;
    for (const std::string& input : inputs)
        if (fault.empty())
            fault = missing_frames_fault(input, m_frames);
    return fault;
}

VismapRecipe PoseList::at(const VismapRecipe& recipe, size_t index) const
{
    VismapRecipe pose = recipe;
    if (has_frames()) {
        const auto name = [&](const std::string& path) {
            return vmlight::is_sequence(path) ? frame_path(path, m_frames[index]) : path;
        };
        pose.mesh = name(m_mesh);
        pose.normal_map = name(m_normal_map);
        std::transform(m_occluders.begin(), m_occluders.end(), pose.occluder.begin(), name);
        if (m_has_time)
            pose.mesh_params.frame = m_frames[index];
    } else if (index > 0) {
        pose.mesh = m_meshes[index - 1];
    }
    return pose;
}

std::string PoseList::name(size_t index) const
{
    return has_frames() ? format("frame {}", m_frames[index])
                        : OIIO::Filesystem::filename(index > 0 ? m_meshes[index - 1] : m_mesh);
}

std::string PoseList::path(const std::string& output, size_t index) const
{
    if (has_frames())
        return frame_path(output, m_frames[index]);
    return m_meshes.empty() ? output : frame_path(output, int(index));
}

std::vector<VismapRecipe> PoseList::compared(const VismapRecipe& recipe) const
{
    std::vector<VismapRecipe> poses(m_meshes.size(), recipe);
    for (size_t i = 0; i < poses.size(); ++i)
        poses[i].mesh = m_meshes[i];
    return poses;
}

std::string PoseList::unsavable() const
{
    return has_frames()     ? "--frames cannot be saved in a recipe: it is one image"
        : !m_meshes.empty() ? "--pose cannot be saved in a recipe: it is one image"
        : m_has_error       ? "--pose-error cannot be saved in a recipe"
                            : "";
}

} // namespace vmlight
