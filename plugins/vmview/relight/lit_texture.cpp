// SPDX-License-Identifier: Apache-2.0
#include "lit_texture.h"

#include "shader_text.h"

#include <algorithm>

namespace vmlight::view {

LitTexture::LitTexture(int width, int height)
{
    int levels = 1;
    while (std::max(width, height) >> levels)
        ++levels;
    m_texture = Texture::image(width, height, GL_RGBA32F, levels);
    for (int i = 0; i < levels; ++i)
        m_levels.emplace_back(m_texture, i);
}

LitTexture::LitTexture(const TexturePyramid& pyramid, GLint wrap_s)
    : LitTexture(pyramid.levels()[0].width, pyramid.levels()[0].height)
{
    m_texture.bind(0);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap_s);
    for (size_t i = 0; i < pyramid.levels().size(); ++i) {
        const TexturePyramid::Level& level = pyramid.levels()[i];
        glTexSubImage2D(GL_TEXTURE_2D, GLint(i), 0, 0, level.width, level.height, GL_RGBA, GL_FLOAT,
                        level.texels.data());
    }
}

void LitTexture::fill(const float* rgb, const std::vector<float>& weights)
{
    std::vector<float> texels(4 * weights.size());
    for (size_t i = 0; i < weights.size(); ++i) {
        for (size_t c = 0; c < 3; ++c)
            texels[4 * i + c] = rgb[3 * i + c] * weights[i];
        texels[4 * i + 3] = weights[i];
    }
    m_texture.fill(GL_RGBA, texels.data());
}

std::vector<float> LitTexture::read() const
{
    std::vector<float> texels(4 * size_t(m_texture.width()) * size_t(m_texture.height()));
    m_levels[0].read(texels.data());
    return texels;
}

bool PyramidPass::build(std::string& error)
{
    return m_program.build_whole({ shader_text::pyramid_frag }, error);
}

void PyramidPass::run(const LitTexture& dst) const
{
    const Texture& texture = dst.texture();
    m_program.use();
    m_program.set("finer", 0, texture);
    for (int level = 1; level < dst.levels(); ++level) {
        // Only the finer level may be read while the coarser is drawn into.
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_BASE_LEVEL, level - 1);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, level - 1);
        const Framebuffer &fine = dst.level(level - 1), &coarse = dst.level(level);
        glUniform2i(glGetUniformLocation(m_program.get(), "fine_size"), fine.width(), fine.height());
        glUniform2i(glGetUniformLocation(m_program.get(), "coarse_size"), coarse.width(), coarse.height());
        coarse.bind();
        draw_whole_viewport();
    }
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_BASE_LEVEL, 0);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, dst.levels() - 1);
}

} // namespace vmlight::view
