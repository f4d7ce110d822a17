// SPDX-License-Identifier: Apache-2.0
/// The texels of a mesh, and the tangent frame of each.
#pragma once

#include <vmlight/mesh/mesh.h>
#include <vmlight/mesh/tangents.h>
#include <vmlight/uv/margin.h>

#include <cstdint>
#include <functional>
#include <vector>

namespace vmlight {

/// The texels of one UDIM tile that a mesh covers, as a bake of that size has them.
class TexelSurface
{
public:
    /// @param mesh     has UVs; must outlive it
    /// @param nthreads 0 means OIIO's default
    TexelSurface(const Mesh& mesh, int width, int height, int udim, int nthreads);

    const Coverage& coverage() const { return m_coverage; }
    int64_t covered() const { return m_covered; }

    /// Call `visit` for each covered texel, with its index, row by row, and its frame. Rows of texels at once on
    /// several threads.
    void for_each(const std::function<void(size_t index, const TangentSpace& frame)>& visit) const;

private:
    const Mesh& m_mesh;
    int m_threads;
    Coverage m_coverage;
    int64_t m_covered = 0;
    std::vector<uint32_t> m_triangle;
    std::vector<float> m_weight1, m_weight2;
};

} // namespace vmlight
