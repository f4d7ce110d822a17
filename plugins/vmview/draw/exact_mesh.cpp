// SPDX-License-Identifier: Apache-2.0
#include "exact_mesh.h"

#include <vmlight/uv/udim.h>

#include <array>
#include <cmath>
#include <limits>

namespace vmlight::view {
namespace {

using Imath::V2d;
using Imath::V3d;

struct Corner
{
    V3d seen; // to the right, up, and depth
    V2d st, uv;
};

Corner between(const Corner& a, const Corner& b, double share)
{
    return { a.seen + (b.seen - a.seen) * share, a.st + (b.st - a.st) * share, a.uv + (b.uv - a.uv) * share };
}

// The part of a triangle beyond a depth: up to four corners.
std::vector<Corner> cut(const std::array<Corner, 3>& corners, double nearest)
{
    std::vector<Corner> kept;
    for (size_t k = 0; k < 3; ++k) {
        const Corner &a = corners[k], &b = corners[(k + 1) % 3];
        const bool is_a = a.seen.z >= nearest, is_b = b.seen.z >= nearest;
        if (is_a)
            kept.push_back(a);
        if (is_a != is_b)
            kept.push_back(between(a, b, (nearest - a.seen.z) / (b.seen.z - a.seen.z)));
    }
    return kept;
}

double density_of(const Mesh& mesh, uint32_t triangle)
{
    const auto& t = mesh.triangles[triangle];
    if (!has_uv(mesh, t[0]) || !has_uv(mesh, t[1]) || !has_uv(mesh, t[2]))
        return 0;
    const V2d a(mesh.uvs[t[0]]), b(mesh.uvs[t[1]]), c(mesh.uvs[t[2]]);
    const double surface = triangle_area_normal(mesh, t).length();
    return surface > 0 ? std::sqrt(std::abs((b - a).cross(c - a)) / surface) : 0;
}

class Screen
{
public:
    Screen(const Camera& camera, int width, int height)
        : m_camera(camera)
        , m_width(width)
        , m_height(height)
    {
    }

    V3d seen(const V3d& position) const
    {
        const V3d p = position - m_camera.position;
        return { p.dot(m_camera.right), p.dot(m_camera.up), p.dot(m_camera.forward) };
    }

    void append(std::vector<float>& dst, const Corner& corner, double density) const
    {
        const double depth = m_camera.is_orthographic ? 1 : corner.seen.z;
        const double x = (corner.seen.x / (depth * m_camera.half_width) + 1) * 0.5 * m_width;
        const double y = (1 - corner.seen.y / (depth * m_camera.half_height)) * 0.5 * m_height;
        const double left = std::floor(x), top = std::floor(y);
        for (const double number : { left, top, x - left, y - top, 1 / depth, corner.st.x, corner.st.y, corner.seen.z,
                                     corner.uv.x, corner.uv.y, density, 0.0 })
            dst.push_back(float(number));
    }

private:
    const Camera& m_camera;
    const double m_width, m_height;
};

} // namespace

ExactMesh::ExactMesh(const Mesh& mesh, const MeshBuffers& buffers, int udim,
                     const std::vector<SurfaceMaterial>& materials,
                     const std::vector<std::vector<Imath::V2f>>& material_uvs, const Camera& camera, int width,
                     int height, double nearest)
{
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    const Screen screen(camera, width, height);
    const V2d tile(udim_corner(udim));
    std::vector<float> floats;
    GLsizei count = 0;
    for (const MeshPart& part : buffers.parts()) {
        MeshPart seen { part.material, count, 0 };
        for (GLsizei i = part.first / 3; i < (part.first + part.count) / 3; ++i) {
            const uint32_t triangle = buffers.order()[size_t(i)];
            const Imath::V2f* uvs = material_uvs_of(mesh, triangle, materials, material_uvs);
            std::array<Corner, 3> corners;
            for (size_t k = 0; k < 3; ++k) {
                const uint32_t v = mesh.triangles[triangle][k];
                const V2d uv = mesh.uvs.empty() ? V2d(kNone) : V2d(mesh.uvs[v]);
                corners[k] = { screen.seen(mesh.positions[v]), V2d(uv.x - tile.x, 1 - (uv.y - tile.y)),
                               uvs ? V2d(uvs[k]) : uv };
            }
            const std::vector<Corner> polygon = cut(corners, nearest);
            const double density = density_of(mesh, triangle);
            for (size_t k = 2; k < polygon.size(); ++k) {
                for (const size_t corner : { size_t(0), k - 1, k })
                    screen.append(floats, polygon[corner], density);
                seen.count += 3;
            }
        }
        count += seen.count;
        if (seen.count > 0)
            m_parts.push_back(seen);
    }
    if (m_parts.empty())
        return;
    m_buffer = make_buffer(GL_TEXTURE_BUFFER, floats.data(), floats.size() * sizeof(float));
    m_texture = Texture::of_buffer(m_buffer, GL_RGBA32F);
}

} // namespace vmlight::view
