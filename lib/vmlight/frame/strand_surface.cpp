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

Imath::V3d StrandSurface::tangent(uint32_t span, double along) const
{
    const auto [strand, point] = start_of(span);
    const Imath::V3d* p = &m_strands->points[point];
    // The curve is extended beyond its ends as StrandCurve has it.
    const Imath::V3d before = point > m_strands->begin(strand) ? p[-1] : p[0] * 2.0 - p[1];
    const Imath::V3d after = point + 2 < m_strands->end(strand) ? p[2] : p[1] * 2.0 - p[0];
    const double u = along, t = 1 - along;
    const Imath::V3d slope = before * (-t * t) + p[0] * ((3 * u - 4) * u) + p[1] * ((4 - 3 * t) * t) + after * (u * u);
    return slope.length() > 0 ? slope.normalized() : tangent(span);
}

} // namespace vmlight
