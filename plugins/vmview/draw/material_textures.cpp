// SPDX-License-Identifier: Apache-2.0
#include "material_textures.h"

#include "../relight/map_textures.h"

#include <algorithm>

namespace vmlight::view {
namespace {

constexpr int kUnit = 2;

GLint wrap_mode(TextureWrap wrap)
{
    return wrap == TextureWrap::clamp ? GL_CLAMP_TO_EDGE : wrap == TextureWrap::mirror ? GL_MIRRORED_REPEAT : GL_REPEAT;
}

// Four channels of a texel, and its weight, which is 1.
Texture load_texture(const TexturePyramid& pyramid)
{
    const std::vector<TexturePyramid::Level>& levels = pyramid.levels();
    Texture texture = Texture::image(levels[0].width, levels[0].height, GL_RGBA32F, int(levels.size()));
    texture.filter(GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap_mode(pyramid.wrap_s()));
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap_mode(pyramid.wrap_t()));
    for (size_t i = 0; i < levels.size(); ++i) {
        std::vector<float> rgba;
        for (size_t k = 0; k < levels[i].texels.size(); k += 5)
            rgba.insert(rgba.end(), &levels[i].texels[k], &levels[i].texels[k] + 4);
        glTexSubImage2D(GL_TEXTURE_2D, GLint(i), 0, 0, levels[i].width, levels[i].height, GL_RGBA, GL_FLOAT,
                        rgba.data());
    }
    return texture;
}

} // namespace

bool MaterialTextures::load(const std::vector<SurfaceMaterial>& materials, std::string& error)
{
    m_materials = materials;
    m_textures.clear();
    for (const SurfaceMaterial& material : materials) {
        const TexturePyramid* pyramid = material.texture.get();
        if (!pyramid || m_textures.count(pyramid) != 0)
            continue;
        error = texture_size_fault("a texture", pyramid->levels()[0].width, pyramid->levels()[0].height);
        if (!error.empty())
            return false;
        m_textures.emplace(pyramid, load_texture(*pyramid));
    }
    return true;
}

bool MaterialTextures::is_blended(int material) const
{
    return material >= 0 && m_materials[size_t(material)].alpha_mode == AlphaMode::blend;
}

int MaterialTextures::kind(int material) const
{
    return material < 0 ? 0 : m_materials[size_t(material)].texture ? 2 : 1;
}

void MaterialTextures::set(const Program& program, int index) const
{
    if (index < 0)
        return;
    const SurfaceMaterial& material = m_materials[size_t(index)];
    const float color[4] = { material.color.x, material.color.y, material.color.z, material.alpha };
    program.set_vectors("material_color", color, 1);
    program.set("alpha_mode",
                material.alpha_mode == AlphaMode::mask        ? 1
                    : material.alpha_mode == AlphaMode::blend ? 2
                                                              : 0);
    program.set("alpha_cutoff", material.alpha_cutoff);
    if (!material.texture)
        return;
    const Texture& texture = m_textures.at(material.texture.get());
    program.set("material_texture", kUnit, texture);
    program.set("material_texels", float(texture.width()), float(texture.height()));
    program.set("material_last_level", texture.levels() - 1);
    // Row vectors there, columns here: the same order of numbers.
    float numbers[9];
    for (int i = 0; i < 9; ++i)
        numbers[i] = float(material.uv_transform[i / 3][i % 3]);
    glUniformMatrix3fv(glGetUniformLocation(program.get(), "material_transform"), 1, GL_FALSE, numbers);
}

} // namespace vmlight::view
