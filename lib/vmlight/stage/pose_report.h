// SPDX-License-Identifier: Apache-2.0
/// What a user learns of the poses of a mesh.
#pragma once

#include <vmlight/stage/make_options.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/vismap/pose_sequence.h>

#include <string>
#include <vector>

namespace vmlight {

/// What each pose took, one by one.
class PoseTimes
{
public:
    /// A pose was compared before the bake.
    void add(const std::string& name, double seconds, const PoseChange& change);
    /// A pose was baked.
    void add(const std::string& name, double seconds, const PoseReport& pose);

    /// Report them as a table; nothing if there are none.
    void report(const MakeOptions& options) const;

private:
    void add(double seconds, const std::string& line);

    double m_seconds = 0;
    std::vector<std::string> m_lines;
};

/// Report how a pose was baked.
void report_pose(const PoseReport& pose, const MakeOptions& options);

/// Report by how much V of the map of `recipe` changes in each of `poses`, which are the same recipe of another mesh,
/// from some of its texels. False, with the reason in `error`, if a mesh cannot be read or has other triangles or
/// texture coordinates, or the work was stopped.
/// @param error_allowed    the change of V that texels are counted above
/// @param times            gets what each took
bool report_pose_changes(const VismapRecipe& recipe, const std::vector<VismapRecipe>& poses, double error_allowed,
                         PoseTimes& times, const MakeOptions& options, std::string& error);

} // namespace vmlight
