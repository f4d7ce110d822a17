// SPDX-License-Identifier: Apache-2.0
/// Maps in parts in makevismap: --part, --join and --resume.
#pragma once

#include <vmlight/cli/main.h>
#include <vmlight/cli/pose_list.h>
#include <vmlight/stage/recipe/recipe.h>

#include <string>
#include <vector>

namespace vmlight {

class PartRun
{
public:
    /// Adds the flags and checks to `stage`. All must outlive this.
    PartRun(StageMain& stage, const VismapRecipe& recipe, const PoseList& poses);

    /// Whether maps are baked in parts: --part or --resume.
    bool is_given() const { return m_count > 0 || m_resumes; }
    /// With --part, bake the parts of a map and write each beside `output`; with --resume, bake what is not there of
    /// all parts, join them and write `output`. False, with the reason in `error`, on failure: finished parts stay.
    bool make(const VismapRecipe& recipe, const std::string& output, const MakeOptions& options, std::string& error);
    /// Remove the parts of maps that are written. To be called once all are, so that none is baked again if the run is
    /// interrupted before.
    void remove_kept() const;

    /// With --join, which is StageMain::is_form(): join the parts that are the operands and write the maps.
    bool join(std::string& error) const;

    /// Which of these flags cannot be saved in a recipe, or "": see StageMain::recipe().
    std::string unsavable() const;

private:
    std::string fault() const;
    bool write_joined(const std::vector<std::string>& parts, const std::string& output, std::string& error) const;

    StageMain& m_stage;
    const VismapRecipe& m_recipe;
    const PoseList& m_poses;
    int m_count = 0; // of --part; 0 without
    std::vector<int> m_parts;
    bool m_resumes = false;
    std::vector<std::string> m_kept; // of maps that are written
};

} // namespace vmlight
