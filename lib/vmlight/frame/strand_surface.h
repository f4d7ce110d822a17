// SPDX-License-Identifier: Apache-2.0
/// Where the points of strands that a camera sees are in their map.
#pragma once

#include <vmlight/mesh/strands.h>
#include <vmlight/vismap/strand_map.h>

#include <Imath/ImathVec.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace vmlight {

class StrandSurface
{
public:
    /// @param strands  with a point for each knot of their curves
    StrandSurface(std::shared_ptr<const Strands> strands, const StrandLayout& layout);

    /// Where the point at `along`, from 0 to 1, of a span is looked up; spans are counted through all strands.
    Imath::V2d uv(uint32_t span, double along) const;
    /// From the start of the span to its end, of unit length.
    Imath::V3d tangent(uint32_t span) const;
    /// That of the curve at `along`, of unit length.
    Imath::V3d tangent(uint32_t span, double along) const;

private:
    // The strand of a span, and the point where that starts.
    struct Start
    {
        size_t strand, point;
    };
    Start start_of(uint32_t span) const;

    const std::shared_ptr<const Strands> m_strands;
    const StrandLayout m_layout;
    std::vector<float> m_shares; // of the strand's length, at each knot
};

} // namespace vmlight
