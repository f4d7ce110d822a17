// SPDX-License-Identifier: Apache-2.0
/// Triangles whose texels need no ray: nothing in the scene rises above their tangent plane.
#pragma once

#include <vmlight/trace/bake_scene.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vmlight {

/// What was proven, and what that took.
struct OpenReport
{
    int64_t triangles = 0; ///< of the baked mesh, with UVs and an area
    int64_t open = 0; ///< of them, proven
    double open_share = 0; ///< of the area in UV
    bool searched = false; ///< whether every triangle was looked at; the counts are 0 otherwise
    int64_t tests = 0; ///< boxes, triangles and vertices that a horizon was compared with
    double seconds = 0;
};

class OpenTriangles
{
public:
    /// Prove what can be, where that is likely to save more than it costs: a closed mesh without a hollow is proven
    /// whole, a mesh without an open part costs a look at 64 of its triangles.
    ///
    /// @param reach    length of rays, in scene units
    /// @param rays     that the bake would trace without, at most
    void find(const BakeScene& scene, double reach, double rays);

    /// Whether nothing can block a ray of this triangle's texels. False for all before find().
    bool is_open(uint32_t triangle) const { return !m_open.empty() && m_open[triangle]; }
    const OpenReport& report() const { return m_report; }

private:
    std::vector<uint8_t> m_open; // empty: none
    OpenReport m_report;
};

} // namespace vmlight
