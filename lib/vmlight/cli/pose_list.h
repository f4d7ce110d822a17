// SPDX-License-Identifier: Apache-2.0
/// Several poses of a mesh in makevismap: --frames of a sequence or an Alembic file, and --pose.
#pragma once

#include <vmlight/cli/main.h>
#include <vmlight/stage/recipe/recipe.h>

#include <cstddef>
#include <string>
#include <vector>

namespace vmlight {

class PoseList
{
public:
    /// Adds the flags and checks to `stage`, before all others: from then on `recipe` is that of the first pose. Both
    /// must outlive this.
    PoseList(StageMain& stage, VismapRecipe& recipe);

    /// Poses to bake: 1 without these flags.
    size_t count() const;
    /// Whether they are poses of one mesh, of which texels may be kept.
    bool is_sequence() const { return count() > 1; }
    /// `recipe`, a tile or a part of the first pose, in another: its mesh, occluders, normal map and frame.
    VismapRecipe at(const VismapRecipe& recipe, size_t index) const;
    /// For messages and metadata: "frame 12", or the name of the mesh's file.
    std::string name(size_t index) const;
    /// The file of a pose.
    std::string path(const std::string& output, size_t index) const;

    /// The missing_frames_fault() of the mesh or another input, or "".
    std::string missing_fault() const;

    /// Poses that are only compared with the mesh before it is baked.
    std::vector<VismapRecipe> compared(const VismapRecipe& recipe) const;
    /// The most by which V of a kept texel may be off.
    double error() const { return m_error; }

    /// Which of these flags cannot be saved in a recipe, or "": see StageMain::recipe().
    std::string unsavable() const;

private:
    std::string fault();
    bool has_frames() const { return !m_frames.empty(); }

    StageMain& m_stage;
    VismapRecipe& m_recipe;
    std::vector<int> m_frames;
    std::vector<std::string> m_meshes; // of --pose
    double m_error = 0.02;
    bool m_has_error = false, m_has_time = false;
    // As given: with #### where each frame has a file.
    std::string m_mesh, m_normal_map;
    std::vector<std::string> m_occluders;
};

} // namespace vmlight
