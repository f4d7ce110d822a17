// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/texel_spacing.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vmlight {

using Imath::V2d;
using Imath::V3d;

float TexelSpacing::of(uint32_t triangle)
{
    if (triangle == m_triangle)
        return m_spacing;
    m_triangle = triangle;
    const auto& corners = m_mesh.triangles[triangle];
    const auto edge
        = [&](size_t k) { return (m_mesh.positions[corners[k]] - m_mesh.positions[corners[0]]) * m_frame.scale; };
    const auto step = [&](size_t k) {
        const V2d uv = V2d(m_mesh.uvs[corners[k]]) - V2d(m_mesh.uvs[corners[0]]);
        return V2d(uv.x * m_width, uv.y * m_height);
    };
    const V3d a = edge(1), b = edge(2);
    const V2d s = step(1), t = step(2);
    const double area = s.x * t.y - s.y * t.x;
    // Along the columns and the rows of texels, up to the area.
    const V3d across = a * t.y - b * s.y, down = b * s.x - a * t.x;
    const double e = across.length2(), f = across.dot(down), g = down.length2();
    const double longest = std::sqrt((e + g + std::sqrt((e - g) * (e - g) + 4 * f * f)) / 2) / std::abs(area);
    // UVs without area cover a texel by rounding only.
    m_spacing = std::max(std::isfinite(longest) ? float(longest) : 0.0f, std::numeric_limits<float>::min());
    return m_spacing;
}

} // namespace vmlight
