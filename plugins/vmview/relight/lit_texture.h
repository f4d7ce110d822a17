// SPDX-License-Identifier: Apache-2.0
/// Light in texture space, with all its mip levels: what the picture is drawn with. The same numbers as
/// frame/texture_pyramid.h.
#pragma once

#include "../gl/objects.h"
#include "../gl/program.h"

#include <vmlight/frame/texture_pyramid.h>

#include <string>
#include <vector>

namespace vmlight::view {

/// R, G, B times weight, and the weight, in floats.
class LitTexture
{
public:
    LitTexture() = default;
    LitTexture(int width, int height);
    /// All levels of a pyramid of three channels.
    explicit LitTexture(const TexturePyramid& pyramid, GLint wrap_s = GL_CLAMP_TO_EDGE);

    const Texture& texture() const { return m_texture; }
    /// For drawing into a level; the first row is the top of the image.
    const Framebuffer& level(int index) const { return m_levels[size_t(index)]; }
    int levels() const { return int(m_levels.size()); }
    bool fits(int width, int height) const { return m_texture.width() == width && m_texture.height() == height; }
    /// Set level 0 from an image of three floats a texel, with a weight for each.
    void fill(const float* rgb, const std::vector<float>& weights);
    /// R, G, B of level 0, times weight, and the weight.
    std::vector<float> read() const;

private:
    Texture m_texture;
    std::vector<Framebuffer> m_levels;
};

/// Makes the levels of a LitTexture from its first.
class PyramidPass
{
public:
    bool build(std::string& error);
    void run(const LitTexture& dst) const;

private:
    Program m_program;
};

} // namespace vmlight::view
