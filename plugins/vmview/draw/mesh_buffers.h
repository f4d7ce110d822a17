// SPDX-License-Identifier: Apache-2.0
/// A mesh on the graphics card.
#pragma once

#include "../gl/objects.h"

#include <vmlight/mesh/mesh.h>

namespace vmlight::view {

class MeshBuffers
{
public:
    MeshBuffers() = default;
    /// @param centre   near the mesh: positions are kept in float relative to it
    MeshBuffers(const Mesh& mesh, const Imath::V3d& centre);

    const Imath::V3d& centre() const { return m_centre; }
    /// Texture coordinates beside the mesh's surface area: the square root of how much of the texture a unit square
    /// covers on average.
    double texture_share() const { return m_texture_share; }
    /// Draw all triangles, from both sides.
    void draw() const;

private:
    Imath::V3d m_centre { 0 };
    double m_texture_share = 0;
    VertexArray m_vertices;
    Buffer m_attributes, m_triangles;
    GLsizei m_count = 0;
};

/// The attributes' names, in order.
constexpr const char* kMeshAttributes[] = { "position", "st", "normal" };

} // namespace vmlight::view
