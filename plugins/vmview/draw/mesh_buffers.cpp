// SPDX-License-Identifier: Apache-2.0
#include "mesh_buffers.h"

#include <cmath>
#include <limits>
#include <vector>

namespace vmlight::view {
namespace {

constexpr int kFloats = 8; // of a vertex: position, st, normal

std::vector<float> attributes(const Mesh& mesh, const Imath::V3d& centre)
{
    std::vector<float> floats;
    floats.reserve(kFloats * mesh.positions.size());
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
        const Imath::V3f p(mesh.positions[v] - centre), n = mesh.normals[v];
        const float none = std::numeric_limits<float>::quiet_NaN();
        const Imath::V2f uv = mesh.uvs.empty() ? Imath::V2f(none) : mesh.uvs[v];
        floats.insert(floats.end(), { p.x, p.y, p.z, uv.x, 1 - uv.y, n.x, n.y, n.z });
    }
    return floats;
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

MeshBuffers::MeshBuffers(const Mesh& mesh, const Imath::V3d& centre)
    : m_centre(centre)
    , m_texture_share(texture_share_of(mesh))
    , m_vertices(make_vertex_array())
    , m_count(GLsizei(3 * mesh.triangles.size()))
{
    glBindVertexArray(m_vertices.get());
    const std::vector<float> floats = attributes(mesh, centre);
    m_attributes = make_buffer(GL_ARRAY_BUFFER, floats.data(), floats.size() * sizeof(float));
    const GLint sizes[] = { 3, 2, 3 };
    size_t offset = 0;
    for (GLuint i = 0; i < 3; ++i) {
        glEnableVertexAttribArray(i);
        glVertexAttribPointer(i, sizes[i], GL_FLOAT, GL_FALSE, kFloats * sizeof(float),
                              reinterpret_cast<const void*>(offset * sizeof(float)));
        offset += size_t(sizes[i]);
    }
    m_triangles = make_buffer(GL_ELEMENT_ARRAY_BUFFER, mesh.triangles.data(),
                              mesh.triangles.size() * sizeof(mesh.triangles[0]));
}

void MeshBuffers::draw() const
{
    glBindVertexArray(m_vertices.get());
    glDrawElements(GL_TRIANGLES, m_count, GL_UNSIGNED_INT, nullptr);
}

} // namespace vmlight::view
