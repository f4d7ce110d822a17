// SPDX-License-Identifier: Apache-2.0
/// A mesh as one camera sees it, for pictures that must be right at every edge: corners on the screen in double, kept
/// as whole pixels and the rest, each a float.
#pragma once

#include "mesh_buffers.h"

#include <vmlight/frame/camera.h>

#include <vector>

namespace vmlight::view {

class ExactMesh
{
public:
    ExactMesh() = default;
    /// @param nearest  triangles are cut at this depth, which is above 0 in perspective
    ExactMesh(const Mesh& mesh, const MeshBuffers& buffers, int udim, const std::vector<SurfaceMaterial>& materials,
              const std::vector<std::vector<Imath::V2f>>& material_uvs, const Camera& camera, int width, int height,
              double nearest);

    bool is_empty() const { return m_parts.empty(); }
    const std::vector<MeshPart>& parts() const { return m_parts; }
    /// Nine texels of four floats a triangle, three a corner: place on the screen in pixels from the upper left corner,
    /// whole (x, y) and the rest (x, y); 1 over depth (1 if orthographic), st, depth; uv of the material, the square
    /// root of texture area over surface area, 0.
    const Texture& corners() const { return m_texture; }

private:
    Buffer m_buffer;
    Texture m_texture;
    std::vector<MeshPart> m_parts;
};

} // namespace vmlight::view
