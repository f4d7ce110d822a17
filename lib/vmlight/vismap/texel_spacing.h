// SPDX-License-Identifier: Apache-2.0
/// How far apart texels are on the surface.
#pragma once

#include <vmlight/mesh/mesh.h>
#include <vmlight/trace/occluder.h>

#include <cstdint>

namespace vmlight {

/// Caches the last triangle: use one per thread.
class TexelSpacing
{
public:
    /// @param mesh     must outlive this, and so must `frame`
    /// @param width, height    of the map, in texels
    TexelSpacing(const Mesh& mesh, const SceneFrame& frame, int width, int height)
        : m_mesh(mesh)
        , m_frame(frame)
        , m_width(width)
        , m_height(height)
    {
    }

    /// The length on the surface of a step of one texel where it is longest, in the scene's space; above 0.
    float of(uint32_t triangle);

private:
    const Mesh& m_mesh;
    const SceneFrame& m_frame;
    int m_width, m_height;
    uint32_t m_triangle = ~0u;
    float m_spacing = 0;
};

} // namespace vmlight
