// SPDX-License-Identifier: Apache-2.0
/// The numbers of a visibility map as colours to look at.
#pragma once

#include <OpenImageIO/imagebuf.h>

#include <string>
#include <vector>

namespace vmlight::view {

struct FalseColor
{
    const char *word, *label, *meaning;
    /// The channel that a map must have; "" for none but V and B.
    const char* channel;
    /// Sets `rgb` from V and B, and the channel's value.
    void (*color)(const float* seen, float value, float* rgb);
};

const std::vector<FalseColor>& false_colors();
/// The row of that word, or nullptr.
const FalseColor* find_false_color(const std::string& word);

/// Three floats for each texel of `map`, a visibility map, float and in memory; none if it lacks the channel.
std::vector<float> false_color_image(const OIIO::ImageBuf& map, const FalseColor& color);

} // namespace vmlight::view
