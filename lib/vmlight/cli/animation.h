// SPDX-License-Identifier: Apache-2.0
/// Lightmaps over frames: which, and what changes from one to the next.
#pragma once

#include <vmlight/base/frames.h>
#include <vmlight/lightmap/lightmap.h>

#include <string>
#include <vector>

namespace vmlight {

struct Animation
{
    /// Numbers of the frames; `asked` says that the user gave them.
    std::vector<int> frames { 1 };
    bool asked = false;
    /// Degrees about y, after the object's own rotation.
    Ramp rotate_y;

    bool turns() const { return rotate_y.first != 0 || rotate_y.last != 0; }

    /// Why this cannot be written to files named `output`, or "".
    std::string fault(const std::string& output) const;

    /// Where the frame at `index` of `frames` goes.
    std::string path(const std::string& output, size_t index) const;

    /// `params` for the frame at `index`: both turns as one matrix. Their rotation must be sound, or `error` says why.
    LightmapParams at(const LightmapParams& params, size_t index, std::string& error) const;
};

} // namespace vmlight
