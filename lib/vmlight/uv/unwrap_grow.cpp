// SPDX-License-Identifier: Apache-2.0
#include <vmlight/uv/unwrap_grow.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>

namespace vmlight {

using Imath::V3d;

namespace {

// A triangle that may be next, the one of the least cost first; of equal ones, the one found first.
struct Candidate
{
    double cost;
    uint64_t order;
    uint32_t triangle, source;
    bool operator<(const Candidate& other) const
    {
        return cost != other.cost ? cost > other.cost : order > other.order;
    }
};

/// Grows one chart after the other.
class Growth
{
public:
    Growth(const UnwrapSurface& surface)
        : m_surface(surface)
        , m_chart(surface.triangle_count(), UnwrapSurface::kNone)
    {
    }

    uint32_t chart_of(uint32_t triangle) const { return m_chart[triangle]; }

    std::vector<uint32_t> grow(uint32_t seed, uint32_t number)
    {
        // Half the angle of the cone. A wider one gives fewer charts, but more stretch.
        static const double kLeastCosine = std::cos(65 * M_PI / 180);
        std::vector<uint32_t> triangles;
        std::priority_queue<Candidate> queue;
        uint64_t order = 0;
        V3d sum(0), axis = m_surface.normal(seed);
        queue.push({ 0, 0, seed, UnwrapSurface::kNone });
        while (!queue.empty()) {
            const Candidate candidate = queue.top();
            queue.pop();
            const uint32_t t = candidate.triangle;
            if (m_chart[t] != UnwrapSurface::kNone)
                continue;
            const double cosine = m_surface.normal(t).dot(axis);
            if (cosine < kLeastCosine && !is_sliver(t))
                continue;
            if (1 - cosine > candidate.cost + 0.1 && !is_sliver(t)) { // the axis has turned away since
                queue.push({ 1 - cosine, ++order, t, candidate.source });
                continue;
            }
            m_chart[t] = number;
            triangles.push_back(t);
            sum += m_surface.normal(t) * m_surface.area(t);
            axis = sum.normalized();
            for (uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
                const uint32_t twin = m_surface.twin(h);
                if (twin != UnwrapSurface::kNone && m_chart[twin / 3] == UnwrapSurface::kNone)
                    queue.push({ cost_of(twin / 3, axis), ++order, twin / 3, t });
            }
        }
        return triangles;
    }

private:
    // So thin that its normal says little, and that a chart of its own would be mostly margin.
    bool is_sliver(uint32_t t) const
    {
        double longest = 0;
        for (int k = 0; k < 3; ++k)
            longest = std::max(longest, m_surface.edge(t, k, (k + 1) % 3).length2());
        constexpr double kThin = 0.01;
        return 2 * m_surface.area(t) < kThin * longest;
    }
    double cost_of(uint32_t t, const V3d& axis) const { return is_sliver(t) ? 0 : 1 - m_surface.normal(t).dot(axis); }

    const UnwrapSurface& m_surface;
    std::vector<uint32_t> m_chart;
};

// Distances over the chart from one triangle to all, along lines between centroids, with a detour for each bend.
class Distances
{
public:
    Distances(const UnwrapChart& chart, const UnwrapSurface& surface, const JoinedEdges& joined,
              const std::vector<uint32_t>& place)
        : m_chart(chart)
        , m_surface(surface)
        , m_joined(joined)
        , m_place(place)
    {
    }

    /// For each triangle, the source that is nearest; `distance` is set to how far.
    std::vector<uint32_t> nearest(const std::vector<uint32_t>& sources, std::vector<double>& distance) const
    {
        std::vector<uint32_t> source_of(m_chart.triangles.size(), UnwrapSurface::kNone);
        distance.assign(source_of.size(), 0);
        std::priority_queue<Candidate> queue;
        uint64_t order = 0;
        for (uint32_t i = 0; i < sources.size(); ++i)
            queue.push({ 0, ++order, sources[i], i });
        const double bend = std::sqrt(m_chart.area);
        while (!queue.empty()) {
            const Candidate at = queue.top();
            queue.pop();
            if (source_of[at.triangle] != UnwrapSurface::kNone)
                continue;
            source_of[at.triangle] = at.source;
            distance[at.triangle] = at.cost;
            const uint32_t t = m_chart.triangles[at.triangle];
            for (uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
                if (!m_joined[h])
                    continue;
                const uint32_t other = m_surface.twin(h) / 3;
                if (source_of[m_place[other]] != UnwrapSurface::kNone)
                    continue;
                const double step = (m_surface.centroid(other) - m_surface.centroid(t)).length()
                    + bend * (1 - m_surface.normal(t).dot(m_surface.normal(other)));
                queue.push({ at.cost + step, ++order, m_place[other], at.source });
            }
        }
        return source_of;
    }

private:
    const UnwrapChart& m_chart;
    const UnwrapSurface& m_surface;
    const JoinedEdges& m_joined;
    const std::vector<uint32_t>& m_place;
};

uint32_t farthest(const std::vector<double>& distance)
{
    return uint32_t(std::max_element(distance.begin(), distance.end()) - distance.begin());
}

} // namespace

std::vector<std::vector<uint32_t>> grow_charts(const UnwrapSurface& surface, JoinedEdges& joined)
{
    const uint32_t count = uint32_t(surface.triangle_count());
    std::vector<uint32_t> seeds(count);
    std::iota(seeds.begin(), seeds.end(), 0u);
    std::stable_sort(seeds.begin(), seeds.end(),
                     [&](uint32_t a, uint32_t b) { return surface.area(a) > surface.area(b); });
    Growth growth(surface);
    std::vector<std::vector<uint32_t>> charts;
    for (uint32_t seed : seeds)
        if (surface.has_area(seed) && growth.chart_of(seed) == UnwrapSurface::kNone)
            charts.push_back(growth.grow(seed, uint32_t(charts.size())));
    for (uint32_t h = 0; h < 3 * count; ++h)
        if (surface.twin(h) != UnwrapSurface::kNone)
            joined[h] = growth.chart_of(h / 3) == growth.chart_of(surface.twin(h) / 3);
    return charts;
}

std::array<std::vector<uint32_t>, 2> split_chart(const UnwrapChart& chart, const UnwrapSurface& surface,
                                                 JoinedEdges& joined, const std::vector<uint32_t>& place)
{
    const Distances distances(chart, surface, joined, place);
    std::vector<double> distance;
    distances.nearest({ 0 }, distance);
    const uint32_t a = farthest(distance);
    distances.nearest({ a }, distance);
    const uint32_t b = farthest(distance) != a ? farthest(distance) : a == 0 ? 1 : 0;
    const std::vector<uint32_t> side = distances.nearest({ a, b }, distance);
    std::array<std::vector<uint32_t>, 2> parts;
    for (size_t i = 0; i < side.size(); ++i) {
        const uint32_t t = chart.triangles[i];
        parts[side[i]].push_back(t);
        for (uint32_t h = 3 * t; h < 3 * t + 3; ++h)
            if (joined[h] && side[place[surface.twin(h) / 3]] != side[i])
                joined[h] = joined[surface.twin(h)] = 0;
    }
    return parts;
}

} // namespace vmlight
