// SPDX-License-Identifier: Apache-2.0
#include "figure.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace vmlight::view {

bool Figure::load(MeshPointer mesh, bool with_materials, std::string& error)
{
    m_mesh = std::move(mesh);
    m_has_materials = with_materials;
    m_exact = ExactMesh();
    m_buffers.reset();
    m_strands.reset();
    if (m_mesh->is_strands()) {
        m_strands = std::make_unique<StrandBuffers>();
        return m_strands->load(m_mesh->strands, m_mesh->subject.centre(), error);
    }
    m_buffers = std::make_unique<MeshBuffers>(*m_mesh->mesh, m_mesh->subject.centre(),
                                              m_mesh->recipe.vismap_params.udim, materials(), m_mesh->material_uvs);
    return m_materials.load(materials(), error);
}

const std::vector<SurfaceMaterial>& Figure::materials() const
{
    static const std::vector<SurfaceMaterial> kWhite;
    return m_has_materials ? m_mesh->materials : kWhite;
}

bool Figure::set_map(MapPointer map, std::string& error)
{
    m_map = std::move(map);
    if (!m_map || m_map->image.spec().width != m_map_textures.width
        || m_map->image.spec().height != m_map_textures.height)
        m_added = {};
    m_map_textures = MapTextures();
    m_lit = {};
    return !m_map || m_map_textures.load(m_map->image, m_map->weights, error);
}

void Figure::fill(int slot, const float* rgb, bool adds)
{
    std::vector<float> sum;
    const std::vector<float>& added = m_added[size_t(slot)];
    if (adds && !added.empty()) {
        sum.assign(rgb, rgb + added.size());
        std::transform(sum.begin(), sum.end(), added.begin(), sum.begin(), std::plus<>());
        rgb = sum.data();
    }
    LitTexture& texture = lit(slot);
    if (!texture.fits(m_map_textures.width, m_map_textures.height))
        texture = LitTexture(m_map_textures.width, m_map_textures.height);
    texture.fill(rgb, m_map->weights);
}

void Figure::add_light(int slot, std::vector<float> rgb)
{
    if (!rgb.empty())
        m_added_textures[size_t(slot)]
            = Texture::image(m_map_textures.width, m_map_textures.height, GL_RGB32F, GL_RGB, rgb.data());
    m_added[size_t(slot)] = std::move(rgb);
}

const Texture* Figure::added(int slot) const
{
    return m_added[size_t(slot)].empty() ? nullptr : &m_added_textures[size_t(slot)];
}

void Figure::prepare_exact(const View& view, const Subject& all)
{
    if (!m_buffers)
        return;
    // A triangle may be cut into two, of nine texels each; what has no room is drawn the quick way.
    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
    if (18 * m_mesh->mesh->triangles.size() > size_t(most))
        return;
    m_exact = ExactMesh(*m_mesh->mesh, *m_buffers, m_mesh->recipe.vismap_params.udim, materials(), m_mesh->material_uvs,
                        view.camera, view.width, view.height, depth_range_of(view.camera, all).x);
}

void Figure::draw(const DrawPass& meshes, const StrandPass& strands, int slot, const Subject& all, Show show,
                  RibbonMode ribbons, const Highlights& highlights, const View& view, int first, int end) const
{
    const Imath::C3f white(1, 1, 1);
    if (m_strands) {
        Highlights own = highlights;
        own.map = &m_map_textures.layers;
        if (!m_map)
            own.cones = nullptr;
        strands.draw(*m_strands, lit(slot), m_has_materials ? m_mesh->strand_color : white, own, all, show, ribbons,
                     view, first, end);
    } else
        meshes.draw(*m_buffers, &m_exact, m_materials, all, lit(slot), show, view, first, end);
}

} // namespace vmlight::view
