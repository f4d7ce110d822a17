// SPDX-License-Identifier: Apache-2.0
/// What a user learns of the poses of a mesh.
#pragma once

#include <vmlight/stage/make_options.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/vismap/pose_sequence.h>

#include <string>
#include <vector>

namespace vmlight {

/// Report how a pose was baked.
void report_pose(const PoseReport& pose, const MakeOptions& options);

/// Report by how much V of the map of `recipe` changes in each of `poses`, which are the same recipe of another mesh,
/// from some of its texels. False, with the reason in `error`, if a mesh cannot be read or has other triangles or
/// texture coordinates, or the work was stopped.
/// @param error_allowed    the change of V that texels are counted above
bool report_pose_changes(const VismapRecipe& recipe, const std::vector<VismapRecipe>& poses, double error_allowed,
                         const MakeOptions& options, std::string& error);

} // namespace vmlight
