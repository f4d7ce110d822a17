// SPDX-License-Identifier: Apache-2.0
/// Frame ranges, numbered file names and values that change over frames.
#pragma once

#include <string>
#include <vector>

namespace vmlight {

/// "1-48", "1-48x2", "1,3,10-12": OIIO's frame ranges, of frames up to 999999. False, with the reason in `error`, if it
/// is not one.
bool parse_frames(std::vector<int>& dst, const std::string& text, std::string& error);

/// The name of one frame's file: a run of '#' becomes the frame number, padded with zeros to at least that many digits.
/// `pattern` without '#' is returned as it is.
std::string frame_path(const std::string& pattern, int frame);

/// A value that runs evenly from its first to its last frame.
struct Ramp
{
    double first = 0, last = 0;

    /// Of the frame at `index` of `count`: `first` at 0, `last` at count - 1.
    double at(size_t index, size_t count) const
    {
        return count > 1 ? first + (last - first) * (double(index) / double(count - 1)) : first;
    }
};

/// "0:360", or one number for a value that stays. False, with the reason in `error`, if it is neither.
bool parse_ramp(Ramp& dst, const std::string& text, std::string& error);

} // namespace vmlight
