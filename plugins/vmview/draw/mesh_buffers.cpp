// SPDX-License-Identifier: Apache-2.0
#include "mesh_buffers.h"

#include <vmlight/uv/udim.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace vmlight::view {
namespace {

constexpr int kFloats = 7; // of a vertex: position, st, uv of the material

void append_vertex(std::vector<float>& dst, const Mesh& mesh, uint32_t v, const Imath::V3d& centre,
                   const Imath::V2f& corner, const Imath::V2f* material_uv)
{
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    const Imath::V3f p(mesh.positions[v] - centre);
    const Imath::V2f uv = mesh.uvs.empty() ? Imath::V2f(kNone) : mesh.uvs[v], st = uv - corner;
    const Imath::V2f& other = material_uv ? *material_uv : uv;
    dst.insert(dst.end(), { p.x, p.y, p.z, st.x, 1 - st.y, other.x, other.y });
}

// Triangles in the order of their materials, those that are blended last.
std::vector<uint32_t> draw_order(const Mesh& mesh, const std::vector<SurfaceMaterial>& materials,
                                 std::vector<MeshPart>& parts)
{
    std::vector<uint32_t> order(mesh.triangles.size());
    std::iota(order.begin(), order.end(), 0u);
    if (materials.empty() || mesh.triangle_materials.empty()) {
        parts = { { -1, 0, GLsizei(3 * order.size()) } };
        return order;
    }
    const auto key = [&](uint32_t triangle) {
        const uint32_t material = mesh.triangle_materials[triangle];
        return std::make_pair(materials[material].alpha_mode == AlphaMode::blend, material);
    };
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
    for (size_t i = 0; i < order.size(); ++i) {
        const int material = int(mesh.triangle_materials[order[i]]);
        if (parts.empty() || parts.back().material != material)
            parts.push_back({ material, GLsizei(3 * i), 0 });
        parts.back().count += 3;
    }
    return order;
}

double texture_share_of(const Mesh& mesh)
{
    double surface = 0, texture = 0;
    for (const auto& t : mesh.triangles) {
        if (!has_uv(mesh, t[0]) || !has_uv(mesh, t[1]) || !has_uv(mesh, t[2]))
            continue;
        const Imath::V2d a(mesh.uvs[t[0]]), b(mesh.uvs[t[1]]), c(mesh.uvs[t[2]]);
        surface += triangle_area_normal(mesh, t).length();
        texture += std::abs((b - a).cross(c - a));
    }
    return surface > 0 ? std::sqrt(texture / surface) : 0;
}

} // namespace

const Imath::V2f* material_uvs_of(const Mesh& mesh, uint32_t triangle, const std::vector<SurfaceMaterial>& materials,
                                  const std::vector<std::vector<Imath::V2f>>& sets)
{
    if (materials.empty() || mesh.triangle_materials.empty())
        return nullptr;
    const size_t set = size_t(materials[mesh.triangle_materials[triangle]].uv_set);
    return set < sets.size() && !sets[set].empty() ? &sets[set][3 * size_t(triangle)] : nullptr;
}

MeshBuffers::MeshBuffers(const Mesh& mesh, const Imath::V3d& centre, int udim,
                         const std::vector<SurfaceMaterial>& materials,
                         const std::vector<std::vector<Imath::V2f>>& material_uvs)
    : m_centre(centre)
    , m_texture_share(texture_share_of(mesh))
    , m_vertices(make_vertex_array())
{
    const Imath::V2f corner = udim_corner(udim);
    m_order = draw_order(mesh, materials, m_parts);
    std::vector<float> floats;
    std::vector<uint32_t> indices;
    indices.reserve(3 * m_order.size());
    // Corners of a triangle have UVs of their own only where a material asks for another set.
    const bool is_shared = material_uvs.empty();
    if (is_shared)
        for (uint32_t v = 0; v < mesh.positions.size(); ++v)
            append_vertex(floats, mesh, v, centre, corner, nullptr);
    for (const uint32_t triangle : m_order) {
        const Imath::V2f* uvs = material_uvs_of(mesh, triangle, materials, material_uvs);
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t v = mesh.triangles[triangle][k];
            indices.push_back(is_shared ? v : uint32_t(indices.size()));
            if (!is_shared)
                append_vertex(floats, mesh, v, centre, corner, uvs ? uvs + k : nullptr);
        }
    }
    glBindVertexArray(m_vertices.get());
    m_attributes = make_buffer(GL_ARRAY_BUFFER, floats.data(), floats.size() * sizeof(float));
    const GLint sizes[] = { 3, 2, 2 };
    size_t offset = 0;
    for (GLuint i = 0; i < 3; ++i) {
        glEnableVertexAttribArray(i);
        glVertexAttribPointer(i, sizes[i], GL_FLOAT, GL_FALSE, kFloats * sizeof(float),
                              reinterpret_cast<const void*>(offset * sizeof(float)));
        offset += size_t(sizes[i]);
    }
    m_triangles = make_buffer(GL_ELEMENT_ARRAY_BUFFER, indices.data(), indices.size() * sizeof(indices[0]));
}

void MeshBuffers::draw(const MeshPart& part) const
{
    glBindVertexArray(m_vertices.get());
    glDrawElements(GL_TRIANGLES, part.count, GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(size_t(part.first) * sizeof(uint32_t)));
}

} // namespace vmlight::view
