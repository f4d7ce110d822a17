// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/strand_surface.h>

#include <vmlight/mesh/strand_curve.h>

#include <algorithm>

namespace vmlight {

StrandSurface::StrandSurface(std::shared_ptr<const Strands> strands, const StrandLayout& layout)
    : m_strands(std::move(strands))
    , m_layout(layout)
{
    m_shares.reserve(m_strands->points.size());
    for (size_t strand = 0; strand < m_strands->count(); ++strand)
        for (const double share : StrandCurve(*m_strands, strand).knot_shares())
            m_shares.push_back(float(share));
}

// A strand has one span less than points.
StrandSurface::Start StrandSurface::start_of(uint32_t span) const
{
    size_t first = 0, last = m_strands->count() - 1; // binary search for the strand whose spans it is among
    while (first < last) {
        const size_t middle = (first + last) / 2;
        if (m_strands->end(middle) - (middle + 1) > span)
            last = middle;
        else
            first = middle + 1;
    }
    return { first, size_t(span) + first };
}

Imath::V2d StrandSurface::uv(uint32_t span, double along) const
{
    const auto [strand, point] = start_of(span);
    const double from = double(m_shares[point]), to = double(m_shares[point + 1]);
    return m_layout.uv(int64_t(strand), from + (to - from) * along);
}

Imath::V3d StrandSurface::tangent(uint32_t span) const
{
    const size_t point = start_of(span).point;
    return (m_strands->points[point + 1] - m_strands->points[point]).normalized();
}

} // namespace vmlight
