// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/strand_curve.h>

#include <algorithm>

namespace vmlight {

using Imath::V3d;

StrandCurve::StrandCurve(const Strands& strands, size_t strand)
{
    const size_t begin = strands.begin(strand), end = strands.end(strand);
    const double thickest = thickest_radius(strands, strand);
    for (size_t p = begin; p < end; ++p)
        m_controls.push_back({ strands.points[p], std::max(strands.radii[p], kThinnestTip * thickest) });
    const auto beyond = [](const Control& last, const Control& before) {
        return Control { last.position * 2.0 - before.position, last.radius * 2 - before.radius };
    };
    m_controls.push_back(beyond(m_controls[m_controls.size() - 1], m_controls[m_controls.size() - 2]));
    m_controls.insert(m_controls.begin(), beyond(m_controls[0], m_controls[1]));
    measure();
}

// Where span k starts, and span k - 1 ends.
StrandCurve::Control StrandCurve::knot(size_t k) const
{
    const Control &a = m_controls[k], &b = m_controls[k + 1], &c = m_controls[k + 2];
    return { (a.position + b.position * 4.0 + c.position) / 6.0, (a.radius + b.radius * 4 + c.radius) / 6 };
}

void StrandCurve::measure()
{
    m_lengths.assign(1, 0.0);
    for (size_t k = 0; k < spans(); ++k)
        m_lengths.push_back(m_lengths.back() + (knot(k + 1).position - knot(k).position).length());
}

CurvePoint StrandCurve::at(double share) const
{
    const double length = std::clamp(share, 0.0, 1.0) * m_lengths.back();
    const auto after = std::upper_bound(m_lengths.begin(), m_lengths.end(), length);
    const size_t last = spans() - 1;
    const size_t span = std::min(last, size_t(std::max<std::ptrdiff_t>(1, after - m_lengths.begin())) - 1);
    const double chord = m_lengths[span + 1] - m_lengths[span];
    const double u = chord > 0 ? std::min(1.0, (length - m_lengths[span]) / chord) : 0, t = 1 - u;
    const double weights[4]
        = { t * t * t / 6, (3 * u * u * u - 6 * u * u + 4) / 6, (3 * t * t * t - 6 * t * t + 4) / 6, u * u * u / 6 };
    const double slopes[4] = { -t * t / 2, (3 * u * u - 4 * u) / 2, (4 * t - 3 * t * t) / 2, u * u / 2 };
    CurvePoint point { V3d(0), V3d(0), 0 };
    for (size_t k = 0; k < 4; ++k) {
        const Control& control = m_controls[span + k];
        point.position += control.position * weights[k];
        point.tangent += control.position * slopes[k];
        point.radius += control.radius * weights[k];
    }
    // Where points coincide the curve may stand still: its chords still have a direction, from the root on at least.
    constexpr double kStill = 1e-9;
    for (const V3d& direction :
         { knot(span + 1).position - knot(span).position, knot(spans()).position - knot(0).position, V3d(0, 1, 0) })
        if (!(point.tangent.length() > kStill * m_lengths.back()))
            point.tangent = direction;
    point.tangent.normalize();
    return point;
}

std::vector<double> StrandCurve::knot_shares() const
{
    std::vector<double> shares;
    for (const double length : m_lengths)
        shares.push_back(length / m_lengths.back());
    return shares;
}

bool StrandCurve::cut(double longest, size_t most)
{
    const auto is_long = [&](size_t k) {
        return m_lengths[k + 1] - m_lengths[k] > longest * std::min(knot(k).radius, knot(k + 1).radius);
    };
    for (;;) {
        size_t k = 0;
        while (k < spans() && !is_long(k))
            ++k;
        if (k == spans())
            return true;
        if (2 * spans() > most)
            return false;
        // Source: J. Lane, R. Riesenfeld, "A Theoretical Development for the Computer Generation and Display of
        // Piecewise Polynomial Surfaces", 1980 (the uniform cubic B-spline at half the step).
        std::vector<Control> fine;
        for (size_t i = 0; i + 1 < m_controls.size(); ++i) {
            const Control &a = m_controls[i], &b = m_controls[i + 1];
            if (i > 0) {
                const Control& before = m_controls[i - 1];
                fine.push_back({ (before.position + a.position * 6.0 + b.position) / 8.0,
                                 (before.radius + a.radius * 6 + b.radius) / 8 });
            }
            fine.push_back({ (a.position + b.position) / 2.0, (a.radius + b.radius) / 2 });
        }
        m_controls = std::move(fine);
        measure();
    }
}

} // namespace vmlight
