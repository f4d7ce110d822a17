// SPDX-License-Identifier: Apache-2.0
/// What a seed draws: a scene, its light, and another pose of it.
#pragma once

#include "drawn_light.h"
#include "drawn_pose.h"

namespace vmlight {

struct Drawn
{
    DrawnScene scene;
    DrawnLight light;
    DrawnPose pose;

    explicit Drawn(uint32_t seed)
        : scene(seed)
        , light(seed, scene)
        , pose(seed)
    {
    }
};

} // namespace vmlight
