// SPDX-License-Identifier: Apache-2.0
/// A mesh on the graphics card.
#pragma once

#include "../gl/objects.h"

#include <vmlight/frame/frame_scene.h>
#include <vmlight/mesh/mesh.h>

#include <vector>

namespace vmlight::view {

/// Triangles that are drawn together.
struct MeshPart
{
    int material = -1; ///< of the mesh's; -1: white
    GLsizei first = 0, count = 0; ///< indices
};

class MeshBuffers
{
public:
    MeshBuffers() = default;
    /// @param centre       near the mesh: positions are kept in float relative to it
    /// @param udim         the tile whose lower left corner is (0, 0) of the texture
    /// @param materials    of the mesh; empty: white
    /// @param material_uvs as FrameSurface has them
    MeshBuffers(const Mesh& mesh, const Imath::V3d& centre, int udim, const std::vector<SurfaceMaterial>& materials,
                const std::vector<std::vector<Imath::V2f>>& material_uvs);

    const Imath::V3d& centre() const { return m_centre; }
    /// Texture coordinates beside the mesh's surface area: the square root of how much of the texture a unit square
    /// covers on average.
    double texture_share() const { return m_texture_share; }
    const std::vector<MeshPart>& parts() const { return m_parts; }
    /// The mesh's triangles in the order in which they are drawn.
    const std::vector<uint32_t>& order() const { return m_order; }
    /// Draw the triangles of a part, from both sides.
    void draw(const MeshPart& part) const;

private:
    Imath::V3d m_centre { 0 };
    double m_texture_share = 0;
    VertexArray m_vertices;
    Buffer m_attributes, m_triangles;
    std::vector<MeshPart> m_parts;
    std::vector<uint32_t> m_order;
};

/// The UVs of a triangle's material if they are not the mesh's, three of them, or nullptr.
const Imath::V2f* material_uvs_of(const Mesh& mesh, uint32_t triangle, const std::vector<SurfaceMaterial>& materials,
                                  const std::vector<std::vector<Imath::V2f>>& sets);

/// The attributes' names, in order.
constexpr const char* kMeshAttributes[] = { "position", "st", "material_st" };

} // namespace vmlight::view
