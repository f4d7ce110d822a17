// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/opacity.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vmlight {
namespace {

using Imath::V2d;
using Imath::V2f;

// Products of coordinates up to this are finite.
constexpr double kFarthestUv = 1e100;

bool is_usable(const V2d& st)
{
    return std::abs(st.x) <= kFarthestUv && std::abs(st.y) <= kFarthestUv;
}

// From v up to rows from the top.
V2d place_of(const V2f& uv, const Imath::M33d& m)
{
    const double x = uv.x, y = uv.y;
    return { x * m[0][0] + y * m[1][0] + m[2][0], 1 - (x * m[0][1] + y * m[1][1] + m[2][1]) };
}

V2d magnitude(const V2d& v)
{
    return { std::abs(v.x), std::abs(v.y) };
}

} // namespace

bool MaterialOpacity::is_opaque() const
{
    double least = factor;
    for (const Texture& texture : textures)
        least *= texture.image ? texture.image->range().low : 1;
    return opacity_of(mode, least, cutoff) >= 1;
}

std::array<V2f, 3> texture_uvs(const Mesh& mesh, uint32_t triangle, const MaterialOpacity::Texture& texture)
{
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    const size_t set = size_t(std::max(texture.uv_set, 0));
    if (mesh.opacity && set < mesh.opacity->uvs.size() && !mesh.opacity->uvs[set].empty()) {
        const V2f* uvs = &mesh.opacity->uvs[set][size_t(triangle) * 3];
        return { uvs[0], uvs[1], uvs[2] };
    }
    std::array<V2f, 3> uvs;
    for (size_t k = 0; k < 3; ++k)
        uvs[k] = mesh.uvs.empty() ? V2f(kNone, kNone) : mesh.uvs[mesh.triangles[triangle][k]];
    return uvs;
}

TriangleOpacity::TriangleOpacity(const MaterialOpacity& material, const std::array<std::array<V2f, 3>, 2>& uvs)
    : m_material(material)
{
    for (size_t k = 0; k < material.textures.size(); ++k) {
        const MaterialOpacity::Texture& texture = material.textures[k];
        if (!texture.image)
            continue;
        std::array<V2d, 3> st;
        for (size_t corner = 0; corner < 3; ++corner)
            st[corner] = place_of(uvs[k][corner], texture.uv_transform);
        if (!is_usable(st[0]) || !is_usable(st[1]) || !is_usable(st[2]))
            continue;
        Layer& layer = m_layers[size_t(m_count++)];
        layer = { texture.image.get(), st[0], st[1] - st[0], st[2] - st[0], V2d(0) };
        layer.slack
            = (magnitude(layer.start) + magnitude(layer.along_u) + magnitude(layer.along_v)) * 0x1p-48 + V2d(0x1p-60);
    }
}

double TriangleOpacity::at(double u, double v) const
{
    double alpha = m_material.factor;
    for (int k = 0; k < m_count; ++k)
        alpha *= m_layers[size_t(k)].image->lookup(m_layers[size_t(k)].at(u, v));
    return opacity_of(m_material.mode, alpha, m_material.cutoff);
}

AlphaRange TriangleOpacity::range(const std::array<V2d, 3>& corners) const
{
    // The product of the least values is rounded as that of any others is, and rounding keeps order.
    double low = m_material.factor, high = m_material.factor;
    for (int k = 0; k < m_count; ++k) {
        const Layer& layer = m_layers[size_t(k)];
        V2d least = layer.at(corners[0].x, corners[0].y), greatest = least;
        for (size_t corner = 1; corner < 3; ++corner) {
            const V2d st = layer.at(corners[corner].x, corners[corner].y);
            least = { std::min(least.x, st.x), std::min(least.y, st.y) };
            greatest = { std::max(greatest.x, st.x), std::max(greatest.y, st.y) };
        }
        const AlphaRange range = layer.image->range(least - layer.slack, greatest + layer.slack);
        low *= range.low;
        high *= range.high;
    }
    return { opacity_of(m_material.mode, low, m_material.cutoff),
             opacity_of(m_material.mode, high, m_material.cutoff) };
}

bool TriangleOpacity::is_constant() const
{
    return std::all_of(m_layers.begin(), m_layers.begin() + m_count,
                       [](const Layer& layer) { return layer.along_u == V2d(0) && layer.along_v == V2d(0); });
}

double TriangleOpacity::longest_edge() const
{
    double longest = 0;
    for (int k = 0; k < m_count; ++k) {
        const Layer& layer = m_layers[size_t(k)];
        for (const V2d& edge : { layer.along_u, layer.along_v, layer.along_u - layer.along_v })
            longest = std::max(longest, std::hypot(edge.x * layer.image->width(), edge.y * layer.image->height()));
    }
    return longest;
}

std::shared_ptr<const MeshOpacity> opacity_part(const MeshOpacity& opacity, const std::vector<size_t>& triangles)
{
    auto part = std::make_shared<MeshOpacity>();
    part->materials = opacity.materials;
    part->uvs.resize(opacity.uvs.size());
    for (size_t set = 0; set < opacity.uvs.size(); ++set)
        if (!opacity.uvs[set].empty())
            for (const size_t triangle : triangles)
                for (size_t k = 0; k < 3; ++k)
                    part->uvs[set].push_back(opacity.uvs[set][3 * triangle + k]);
    return part;
}

} // namespace vmlight
