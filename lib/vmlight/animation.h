// SPDX-License-Identifier: Apache-2.0
/// Lightmaps over frames: which, and what changes from one to the next.
#pragma once

#include <vmlight/export.h>
#include <vmlight/frames.h>
#include <vmlight/lightmap.h>

#include <string>
#include <vector>

namespace vmlight {

struct Animation
{
    std::vector<int> frames { 1 };
    /// Whether the user gave the frames.
    bool asked = false;
    /// Degrees about y that the object turns by, after its other turns.
    Ramp rotate_y;

    bool turns() const { return rotate_y.first != 0 || rotate_y.last != 0; }

    /// The parameters of the frame at `index` of `frames`. Sets `error` if those of `params` make no rotation.
    VMLIGHT_API LightmapParams at(const LightmapParams& params, size_t index, std::string& error) const;
};

} // namespace vmlight
