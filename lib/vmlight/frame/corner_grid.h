// SPDX-License-Identifier: Apache-2.0
/// The corners of a tile's pixels, each seen once: where a surface goes on smoothly all around a pixel, they are enough
/// for it.
#pragma once

#include <vmlight/frame/sample_shader.h>

#include <array>
#include <string>
#include <vector>

namespace vmlight {

class CornerGrid
{
public:
    /// Corners around a pixel, along an axis.
    static constexpr int kAround = 4;
    /// Weights of the corners along an axis, from the farthest on one side to that on the other: those whose sum is 1
    /// and whose variance is that of a pixel filter, in square pixels.
    static std::array<double, kAround> weights(double variance);

    /// See through the corners of the pixels of a tile and one farther.
    /// @param only_color   what else is seen need not be smooth
    /// @returns false, with the reason in `error`, if a texture cannot be read
    bool fill(const SampleShader& shader, const Camera& camera, const Size& picture, int left, int top, int width,
              int height, bool only_color, std::string& error);

    /// Whether around pixel (x, y) of the picture one opaque surface goes on without an edge or a seam that shows: uvs
    /// are where those of each corner's neighbours say, or, with `only_color`, colours are alike and points side by
    /// side. What is thinner than a pixel may lie between corners unseen.
    bool is_smooth(int x, int y) const;
    /// Corner (i, j), from 0 to kAround - 1, around the pixel.
    const FrameSample& around(int x, int y, int i, int j) const
    {
        return m_samples[index(x - m_left + i, y - m_top + j)];
    }

private:
    size_t index(int column, int row) const { return size_t(row) * size_t(m_columns) + size_t(column); }

    int m_left = 0, m_top = 0, m_columns = 0;
    std::vector<FrameSample> m_samples;
    std::vector<bool> m_to_right, m_to_below; // whether a corner and its neighbour are of one smooth surface
};

} // namespace vmlight
