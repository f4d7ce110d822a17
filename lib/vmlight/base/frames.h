// SPDX-License-Identifier: Apache-2.0
/// Frame ranges, numbered file names and values that change over frames.
#pragma once

#include <string>
#include <vector>

namespace vmlight {

/// Parse one of OIIO's frame ranges: "1-48", "1-48x2", "1,3,10-12". Frames go up to 999999. Returns false, with the
/// reason in `error`, if `text` is not one.
bool parse_frames(std::vector<int>& dst, const std::string& text, std::string& error);

/// The name of one frame's file: a run of '#' becomes the frame number, padded with zeros to at least that many digits.
/// A `pattern` without '#' is returned unchanged.
std::string frame_path(const std::string& pattern, int frame);

/// A value that changes linearly from the first frame to the last.
struct Ramp
{
    double first = 0, last = 0;

    /// The value at frame `index` of `count`: `first` at 0, `last` at count - 1.
    double at(size_t index, size_t count) const
    {
        return count > 1 ? first + (last - first) * (double(index) / double(count - 1)) : first;
    }
};

/// Parse "0:360", or one number for a constant. Returns false, with the reason in `error`, if `text` is neither.
bool parse_ramp(Ramp& dst, const std::string& text, std::string& error);

} // namespace vmlight
