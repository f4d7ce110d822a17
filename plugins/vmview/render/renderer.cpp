// SPDX-License-Identifier: Apache-2.0
#include "renderer.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace vmlight::view {

bool Renderer::build(std::string& error)
{
    m_no_vertices = make_vertex_array();
    return m_relight.build(error) && m_draw.build(error);
}

void Renderer::bind_no_vertices() const
{
    glBindVertexArray(m_no_vertices.get());
}

bool Renderer::set_mesh(MeshPointer mesh, bool with_materials, std::string& error)
{
    m_mesh = std::move(mesh);
    m_buffers.reset();
    m_exact = ExactMesh();
    m_materials = MaterialTextures();
    if (!m_mesh)
        return true;
    m_has_materials = with_materials;
    m_buffers = std::make_unique<MeshBuffers>(*m_mesh->mesh, m_mesh->subject.centre(),
                                              m_mesh->recipe.vismap_params.udim, materials(), m_mesh->material_uvs);
    return m_materials.load(materials(), error);
}

const std::vector<SurfaceMaterial>& Renderer::materials() const
{
    static const std::vector<SurfaceMaterial> kWhite;
    return m_has_materials ? m_mesh->materials : kWhite;
}

void Renderer::prepare_exact(const View& view)
{
    m_is_exact = true;
    if (!m_buffers)
        return;
    // A triangle may be cut into two, of nine texels each; what has no room is drawn the quick way.
    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
    if (18 * m_mesh->mesh->triangles.size() > size_t(most))
        return;
    m_exact = ExactMesh(*m_mesh->mesh, *m_buffers, m_mesh->recipe.vismap_params.udim, materials(), m_mesh->material_uvs,
                        view.camera, view.width, view.height, depth_range_of(view.camera, m_mesh->subject).x);
}

bool Renderer::set_map(MapPointer map, std::string& error)
{
    m_map = std::move(map);
    // A map that is baked step by step keeps what was added to the step before.
    if (!m_map || m_map->image.spec().width != m_map_textures.width
        || m_map->image.spec().height != m_map_textures.height)
        m_added = {};
    m_map_textures = MapTextures();
    m_lit = {};
    return !m_map || m_map_textures.load(m_map->image, m_map->weights, error);
}

bool Renderer::set_light(LightPointer light, std::string& error)
{
    m_light = std::move(light);
    m_light_textures = LightTextures();
    m_panorama = LitTexture();
    if (!m_light)
        return true;
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

bool Renderer::relight(int slot, const LightmapParams& params, std::string& error)
{
    bind_no_vertices();
    return m_relight.run(m_lit[size_t(slot)], m_map_textures, m_light_textures, &m_light->filtered().back(),
                         m_added[size_t(slot)].empty() ? nullptr : &m_added_textures[size_t(slot)], params, error);
}

void Renderer::add_light(int slot, std::vector<float> rgb)
{
    if (!rgb.empty())
        m_added_textures[size_t(slot)]
            = Texture::image(m_map_textures.width, m_map_textures.height, GL_RGB32F, GL_RGB, rgb.data());
    m_added[size_t(slot)] = std::move(rgb);
}

void Renderer::set_texture(int slot, const float* rgb, bool adds)
{
    std::vector<float> sum;
    const std::vector<float>& added = m_added[size_t(slot)];
    if (adds && !added.empty()) {
        sum.assign(rgb, rgb + added.size());
        std::transform(sum.begin(), sum.end(), added.begin(), sum.begin(), std::plus<>());
        rgb = sum.data();
    }
    LitTexture& lit = m_lit[size_t(slot)];
    if (!lit.fits(m_map_textures.width, m_map_textures.height))
        lit = LitTexture(m_map_textures.width, m_map_textures.height);
    bind_no_vertices();
    lit.fill(rgb, m_map->weights);
    m_relight.finish(lit);
}

void Renderer::draw(const PictureParams& params, const Framebuffer& target) const
{
    bind_no_vertices();
    target.bind();
    Backdrop backdrop;
    backdrop.environment = params.has_background && m_panorama.texture() ? &m_panorama : nullptr;
    backdrop.to_environment = params.to_environment;
    m_draw.begin(backdrop, params.view, m_is_exact);
    if (!m_buffers)
        return;
    const int width = params.view.width;
    const int wiped = int(std::lround(std::clamp(params.wipe, 0.0, 1.0) * width));
    m_draw.draw(*m_buffers, &m_exact, m_materials, m_mesh->subject, m_lit[0], params.show, params.view, 0, wiped);
    if (wiped < width)
        m_draw.draw(*m_buffers, &m_exact, m_materials, m_mesh->subject, m_lit[1], params.show, params.view, wiped,
                    width);
}

void Renderer::accumulate(const Framebuffer& sum, const Texture& picture, double share) const
{
    bind_no_vertices();
    sum.bind();
    m_draw.accumulate(picture, share);
}

} // namespace vmlight::view
