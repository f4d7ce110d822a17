// SPDX-License-Identifier: Apache-2.0
/// Strands as curves in the space of a ray-tracing scene.
#pragma once

#include <vmlight/mesh/strands.h>
#include <vmlight/trace/occluder.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vmlight {

/// Measured: what Embree needs for a span of a B-spline.
constexpr double kBytesOfSpan = 160;

/// How a ray meets curves. Measured: round ones take 1.2 times as long.
enum class CurveShape
{
    round, ///< tubes, for rays that start between strands
    flat ///< ribbons that face the ray, which it cannot meet within their own width: for rays from elsewhere
};

/// The spans of strands: each has four control points in a row.
class Curves
{
public:
    /// A strand that is no one's own.
    static constexpr uint32_t kNoOwner = ~0u - 1;

    /// Add all strands, in the form that keeps their width: round ones are cut to spans of at most 2000 radii.
    ///
    /// @param first_owner  the number of the first of them in strand_of(); kNoOwner for all of them if it is that
    /// @returns false, with the reason in `error`, if a strand is so thin that it would be cut into more than 65536
    ///          spans, or memory runs out
    bool add(const Strands& strands, const SceneFrame& frame, CurveShape shape, uint32_t first_owner,
             std::string& error);

    /// x, y, z and radius of control points, and the first of each span.
    const std::vector<std::array<float, 4>>& controls() const { return m_controls; }
    const std::vector<uint32_t>& spans() const { return m_spans; }
    /// The strand of each span.
    const std::vector<uint32_t>& strand_of() const { return m_strand_of; }

private:
    std::vector<std::array<float, 4>> m_controls;
    std::vector<uint32_t> m_spans, m_strand_of;
};

} // namespace vmlight
