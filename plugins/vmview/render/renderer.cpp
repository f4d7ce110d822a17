// SPDX-License-Identifier: Apache-2.0
#include "renderer.h"

#include <vmlight/frame/strand_light.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace vmlight::view {
namespace {

Texture load_cones(const ConeLevels& levels)
{
    Texture texture = Texture::layers(levels.width, levels.height, levels.count, GL_RGB32F);
    const size_t floats = 3 * size_t(levels.width) * size_t(levels.height);
    for (int i = 0; i < levels.count; ++i)
        texture.fill_layer(i, GL_RGB, &levels.texels[size_t(i) * floats]);
    texture.filter(GL_LINEAR, GL_LINEAR);
    glTexParameteri(texture.target(), GL_TEXTURE_WRAP_S, GL_REPEAT);
    return texture;
}

} // namespace

bool Renderer::build(std::string& error)
{
    m_no_vertices = make_vertex_array();
    return m_relight.build(error) && m_draw.build(error) && m_strands.build(error);
}

void Renderer::bind_no_vertices() const
{
    glBindVertexArray(m_no_vertices.get());
}

bool Renderer::set_mesh(MeshPointer mesh, bool with_materials, std::string& error)
{
    const std::vector<MeshPointer> beside = mesh ? mesh->beside : std::vector<MeshPointer>();
    // Of the same objects, with or without materials, maps and light stay.
    if (!mesh || figures() == 0 || at(0).mesh() != mesh) {
        m_figures.clear();
        m_figures.resize(mesh ? 1 + beside.size() : 0);
    }
    for (size_t i = 0; i < figures(); ++i)
        if (!m_figures[i].load(i == 0 ? mesh : beside[i - 1], with_materials, error))
            return false;
    return true;
}

bool Renderer::set_map(MapPointer map, std::string& error)
{
    for (size_t i = 0; i < figures(); ++i) {
        MapPointer own = i == 0 ? map : nullptr;
        if (map && i > 0 && i <= map->beside.size())
            own = map->beside[i - 1];
        if (!m_figures[i].set_map(std::move(own), error))
            return false;
    }
    return true;
}

bool Renderer::set_light(LightPointer light, std::string& error)
{
    m_light = std::move(light);
    m_light_textures = LightTextures();
    m_strand_light = LightTextures();
    m_panorama = LitTexture();
    m_cones = Texture();
    if (!m_light)
        return true;
    if (m_light->cones)
        m_cones = load_cones(*m_light->cones);
    if (!m_light_textures.load(m_light->filtered(), error))
        return false;
    if (m_light->panorama) {
        const TexturePyramid::Level& level = m_light->panorama->levels()[0];
        error = texture_size_fault("an environment", level.width, level.height);
        if (!error.empty())
            return false;
        m_panorama = LitTexture(*m_light->panorama, GL_REPEAT);
    }
    return true;
}

bool Renderer::filter_for_strands(std::string& error)
{
    if (m_strand_light.cfem)
        return true;
    std::vector<OIIO::ImageBuf> filtered;
    return vmlight::filter_for_strands(filtered, m_light->light, 0, error) && m_strand_light.load(filtered, error);
}

bool Renderer::relight(int slot, const LightmapParams& params, std::string& error, size_t figure)
{
    Figure& own = m_figures[figure];
    const bool has_sine = own.mesh()->is_strands() && params.model != "sh";
    if (has_sine && !filter_for_strands(error))
        return false;
    bind_no_vertices();
    return m_relight.run(own.lit(slot), own.map_textures(), has_sine ? m_strand_light : m_light_textures,
                         &m_light->filtered().back(), own.added(slot), params, error);
}

void Renderer::add_light(int slot, AddedTexels rgb)
{
    rgb.resize(figures());
    for (size_t i = 0; i < figures(); ++i)
        m_figures[i].add_light(slot, std::move(rgb[i]));
}

bool Renderer::has_added() const
{
    return std::any_of(m_figures.begin(), m_figures.end(),
                       [](const Figure& figure) { return figure.added(0) || figure.added(1); });
}

void Renderer::set_texture(int slot, const float* rgb, bool adds, size_t figure)
{
    bind_no_vertices();
    m_figures[figure].fill(slot, rgb, adds);
    m_relight.finish(at(figure).lit(slot));
}

void Renderer::prepare_exact(const View& view)
{
    m_is_exact = true;
    for (Figure& figure : m_figures)
        figure.prepare_exact(view, at(0).mesh()->subject);
}

void Renderer::reset_exact()
{
    for (Figure& figure : m_figures)
        figure.reset_exact();
    m_is_exact = false;
}

// Strands first, so that surfaces in front of them that are blended show them.
void Renderer::draw_figures(int slot, const PictureParams& params, int first, int end) const
{
    const RibbonMode ribbons = !m_is_exact ? RibbonMode::quick
        : at(0).has_exact_mesh()           ? RibbonMode::exact_beside_exact_mesh
                                           : RibbonMode::exact;
    const Highlights highlights { &m_cones, nullptr, m_light ? m_light->specular : 0, params.to_environment };
    bind_no_vertices();
    for (size_t i = figures(); i-- > 0;)
        at(i).draw(m_draw, m_strands, slot, at(0).mesh()->subject, params.show, ribbons, highlights, params.view, first,
                   end);
}

void Renderer::draw(const PictureParams& params, const Framebuffer& target) const
{
    bind_no_vertices();
    target.bind();
    Backdrop backdrop;
    backdrop.environment = params.has_background && m_panorama.texture() ? &m_panorama : nullptr;
    backdrop.to_environment = params.to_environment;
    m_draw.begin(backdrop, params.view, m_is_exact);
    if (figures() == 0)
        return;
    const int width = params.view.width;
    const int wiped = int(std::lround(std::clamp(params.wipe, 0.0, 1.0) * width));
    draw_figures(0, params, 0, wiped);
    if (wiped < width)
        draw_figures(1, params, wiped, width);
}

void Renderer::accumulate(const Framebuffer& sum, const Texture& picture, double share) const
{
    bind_no_vertices();
    sum.bind();
    m_draw.accumulate(picture, share);
}

} // namespace vmlight::view
