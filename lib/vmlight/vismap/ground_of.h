// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/trace/bake_scene.h>
#include <vmlight/trace/ground_plane.h>
#include <vmlight/vismap/vismap.h>

namespace vmlight {

/// The ground that `params` ask for, in the units of the scene.
inline GroundPlane ground_of(const BakeScene& scene, const VismapParams& params)
{
    if (!params.ground)
        return {};
    const double height = params.ground_height == VismapParams::kLowest ? scene.lowest() : params.ground_height;
    const SceneFrame& frame = scene.frame();
    return { (height - frame.centre.y) * frame.scale, params.max_distance * frame.scale };
}

} // namespace vmlight
