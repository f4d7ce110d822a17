// SPDX-License-Identifier: Apache-2.0
/// The meshes that rays can meet in two poses of a scene, side by side.
#pragma once

#include <vmlight/trace/bake_scene.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace vmlight {

/// What rays can meet of a mesh, or of a part of it, in both poses. In a pose whose rays cannot meet it, it need not be
/// traced: it then has no triangles there.
struct PosedPart
{
    TracedTriangles base {}, pose {};

    size_t count() const { return std::max(base.count, pose.count); }
    bool is_in_both() const { return base.count > 0 && pose.count > 0; }
};

/// The parts of all meshes that are traced in one pose or in both. A mesh that is left out of one because no ray of
/// that pose can meet it is no fault; where other meshes are given, or have other triangles or cut-outs, `fault` is set
/// to how they differ, and nothing is returned.
std::vector<PosedPart> match_parts(const BakeScene& base, const BakeScene& pose, std::string& fault);

} // namespace vmlight
