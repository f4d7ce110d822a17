// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cfem/grid.h>

#include <vmlight/math/latlong.h>

#include <algorithm>
#include <cmath>

namespace vmlight {

using latlong::pi;

namespace {

// Edge i of n cells, in [0, 1].
double cell_edge(int i, int n, bool border)
{
    if (i <= 0)
        return 0;
    if (i >= n)
        return 1;
    return border ? (i - 0.5) / (n - 1) : double(i) / n;
}

} // namespace

double EnvironmentGrid::column_edge(int i) const
{
    return 2 * pi * cell_edge(i, width, border);
}

double EnvironmentGrid::row_edge(int j) const
{
    return pi * cell_edge(j, height, border);
}

double EnvironmentGrid::column_scale() const
{
    return (border ? width - 1 : width) / (2 * pi);
}

double EnvironmentGrid::column_offset() const
{
    return border ? 0.5 : 0;
}

LatitudeRule::LatitudeRule(int nodes)
    : m_position(nodes)
    , m_weight(nodes)
{
    // Roots of the Legendre polynomial of degree `nodes` by Newton's method; it converges from this start for each.
    for (int k = 0; k < nodes; ++k) {
        double x = -std::cos(pi * (k + 0.75) / (nodes + 0.5)), slope = 1;
        for (int iteration = 0; iteration < 8; ++iteration) {
            double p = 1, previous = 0;
            for (int degree = 1; degree <= nodes; ++degree) {
                const double next = ((2 * degree - 1) * x * p - (degree - 1) * previous) / degree;
                previous = p;
                p = next;
            }
            slope = nodes * (x * p - previous) / (x * x - 1);
            x -= p / slope;
        }
        m_position[k] = x;
        m_weight[k] = 2 / ((1 - x * x) * slope * slope);
    }
}

void LatitudeRule::append(std::vector<LatitudeNode>& dst, double theta0, double theta1) const
{
    const double middle = 0.5 * (theta0 + theta1), half = 0.5 * (theta1 - theta0);
    const size_t first = dst.size();
    double sum = 0;
    for (size_t k = 0; k < m_position.size(); ++k) {
        const double theta = middle + half * m_position[k];
        const double sin_theta = std::sin(theta);
        dst.push_back({ std::cos(theta), sin_theta, m_weight[k] * sin_theta });
        sum += dst.back().weight;
    }
    // cos theta0 - cos theta1 as a product: exact near the poles, where the difference of cosines cancels.
    const double extent = 2 * std::sin(middle) * std::sin(half);
    for (size_t k = first; k < dst.size(); ++k)
        dst[k].weight *= sum > 0 ? extent / sum : 0;
}

} // namespace vmlight
