// SPDX-License-Identifier: Apache-2.0
#include <vmlight/uv/unwrap_merge.h>

#include <vmlight/base/parallel.h>
#include <vmlight/uv/unwrap_bounds.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace vmlight {

using Imath::V3d;

namespace {

// More, and the charts that are saved are not worth the texels that the stretched surface lacks.
constexpr double kMostJoinedStretch = 1.2;
// How often, on average, a triangle may be laid flat anew.
constexpr int64_t kMostEffort = 30;
// A point that a joint would close, and whose triangles turn by this much more or less than once, is left open: nothing
// flat has it inside.
constexpr double kCurved = 20 * M_PI / 180;

// Half-edges of one chart in a row whose twins are all of one other chart, from which they can be joined.
struct Joint
{
    double score;
    uint32_t a, b; // charts
    std::vector<uint32_t> edges; // of the surface
};

// Angles of the surface around each vertex of the chart.
std::vector<double> turns_of(const UnwrapChart& chart, const UnwrapSurface& surface)
{
    std::vector<double> turns(chart.points.size(), 0);
    for (size_t i = 0; i < chart.triangles.size(); ++i)
        for (int k = 0; k < 3; ++k) {
            const V3d a = surface.edge(chart.triangles[i], k, (k + 1) % 3);
            const V3d b = surface.edge(chart.triangles[i], k, (k + 2) % 3);
            turns[chart.corners[i][k]] += std::atan2(a.cross(b).length(), a.dot(b));
        }
    return turns;
}

class Merger
{
public:
    Merger(std::vector<UnwrapChart>& charts, const UnwrapSurface& surface, JoinedEdges& joined,
           std::vector<uint32_t>& place, double gap, int nthreads)
        : m_charts(charts)
        , m_surface(surface)
        , m_joined(joined)
        , m_place(place)
        , m_gap(gap)
        , m_nthreads(nthreads)
        , m_chart_of(surface.triangle_count(), UnwrapSurface::kNone)
        , m_turns(charts.size())
        , m_perimeters(charts.size())
        , m_rooms(charts.size())
    {
        for (uint32_t c = 0; c < charts.size(); ++c)
            describe(c);
    }

    // In rounds of pairs that have no chart in common, which are tried at the same time.
    void run()
    {
        int64_t effort = kMostEffort * int64_t(m_surface.triangle_count());
        while (effort > 0) {
            const std::vector<Joint> round = next_round();
            if (round.empty())
                return;
            for (const Joint& joint : round)
                effort -= int64_t(m_charts[joint.a].triangles.size() + m_charts[joint.b].triangles.size());
            std::vector<UnwrapChart> unions(round.size());
            std::vector<char> good(round.size(), 0);
            parallel_items(int64_t(round.size()), m_nthreads,
                           [&](int64_t i, int) { good[size_t(i)] = try_joint(unions[size_t(i)], round[size_t(i)]); });
            for (size_t i = 0; i < round.size(); ++i) {
                const Joint& joint = round[i];
                if (good[i]) {
                    m_charts[joint.a] = std::move(unions[i]);
                    m_charts[joint.b] = UnwrapChart();
                    describe(joint.a);
                } else {
                    m_failed.insert(joint.edges.front());
                    set_joined(joint, 0);
                    for (uint32_t c : { joint.a, joint.b }) // their triangles' places are those of the failed union
                        for (uint32_t k = 0; k < m_charts[c].triangles.size(); ++k)
                            m_place[m_charts[c].triangles[k]] = k;
                }
            }
        }
    }

private:
    void describe(uint32_t c)
    {
        const UnwrapChart& chart = m_charts[c];
        for (uint32_t t : chart.triangles)
            m_chart_of[t] = c;
        m_turns[c] = turns_of(chart, m_surface);
        m_perimeters[c] = 0;
        for (uint32_t h : chart.border)
            m_perimeters[c] += length_of(chart.surface_edge(h));
        if (!chart.triangles.empty())
            m_rooms[c] = room_of(m_charts[c]);
    }

    // What a chart takes of the map: between the chart with half a gap around it, as if all fitted together like pieces
    // of a puzzle, and its bounds.
    double room_of(UnwrapChart& chart) const
    {
        double border = 0;
        for (uint32_t h : chart.border)
            border += (chart.uvs[chart.to(h)] - chart.uvs[chart.from(h)]).length();
        const Imath::V2d size = lay_straight(chart);
        return (chart.area + border * m_gap / 2 + m_gap * m_gap + (size.x + m_gap) * (size.y + m_gap)) / 2;
    }

    double length_of(uint32_t edge) const
    {
        return m_surface.edge(edge / 3, int(edge % 3), int(edge % 3 + 1) % 3).length();
    }

    // The other chart at a half-edge of the border, or UnwrapSurface::kNone.
    uint32_t neighbour(uint32_t c, uint32_t h) const
    {
        const uint32_t twin = m_surface.twin(m_charts[c].surface_edge(h));
        const uint32_t other = twin == UnwrapSurface::kNone ? UnwrapSurface::kNone : m_chart_of[twin / 3];
        return other == c ? UnwrapSurface::kNone : other;
    }

    // Whether two half-edges of the border, one after the other, are next to one another in the other chart too, and
    // the point between them can be flat.
    bool continues(uint32_t c, uint32_t first, uint32_t second) const
    {
        const UnwrapChart &chart = m_charts[c], &other = m_charts[neighbour(c, first)];
        const uint32_t twin0 = m_surface.twin(chart.surface_edge(first));
        const uint32_t twin1 = m_surface.twin(chart.surface_edge(second));
        const uint32_t vertex0 = other.corners[m_place[twin0 / 3]][twin0 % 3];
        const uint32_t vertex1 = other.corners[m_place[twin1 / 3]][(twin1 % 3 + 1) % 3];
        if (vertex0 != vertex1)
            return false;
        const double turn = m_turns[c][chart.to(first)] + m_turns[neighbour(c, first)][vertex0];
        return std::abs(turn - 2 * M_PI) < kCurved;
    }

    void add_joints(std::vector<Joint>& dst, uint32_t c) const
    {
        const UnwrapChart& chart = m_charts[c];
        for (size_t loop = 0; loop + 1 < chart.loops.size(); ++loop) {
            const uint32_t first = chart.loops[loop], count = chart.loops[loop + 1] - first;
            const auto at = [&](uint32_t i) { return chart.border[first + i % count]; };
            const auto is_joint_end = [&](uint32_t i) { // before half-edge i
                const uint32_t before = at(i + count - 1);
                return neighbour(c, before) != neighbour(c, at(i)) || neighbour(c, before) == UnwrapSurface::kNone
                    || !continues(c, before, at(i));
            };
            uint32_t start = 0;
            while (start < count && !is_joint_end(start))
                ++start;
            Joint joint { 0, c, UnwrapSurface::kNone, {} };
            for (uint32_t i = start; i < start + count; ++i) {
                if (is_joint_end(i))
                    joint.edges.clear();
                joint.b = neighbour(c, at(i));
                if (joint.b == UnwrapSurface::kNone)
                    continue;
                joint.edges.push_back(chart.surface_edge(at(i)));
                if (i + 1 == start + count || is_joint_end(i + 1))
                    add(dst, joint);
            }
        }
    }

    void add(std::vector<Joint>& dst, Joint joint) const
    {
        if (m_failed.count(joint.edges.front()))
            return;
        double length = 0;
        for (uint32_t edge : joint.edges)
            length += length_of(edge);
        // Small charts first, and those of whose border most goes.
        joint.score = length / m_perimeters[joint.a] / std::sqrt(m_charts[joint.a].area);
        dst.push_back(std::move(joint));
    }

    std::vector<Joint> next_round() const
    {
        std::vector<Joint> joints;
        for (uint32_t c = 0; c < m_charts.size(); ++c)
            if (!m_charts[c].triangles.empty())
                add_joints(joints, c);
        std::stable_sort(joints.begin(), joints.end(),
                         [](const Joint& a, const Joint& b) { return a.score > b.score; });
        std::vector<char> is_taken(m_charts.size(), 0);
        std::vector<Joint> round;
        for (Joint& joint : joints)
            if (!is_taken[joint.a] && !is_taken[joint.b]) {
                is_taken[joint.a] = is_taken[joint.b] = 1;
                round.push_back(std::move(joint));
            }
        return round;
    }

    void set_joined(const Joint& joint, char is_joined)
    {
        for (uint32_t edge : joint.edges)
            m_joined[edge] = m_joined[m_surface.twin(edge)] = is_joined;
    }

    bool try_joint(UnwrapChart& dst, const Joint& joint)
    {
        std::vector<uint32_t> triangles = m_charts[joint.a].triangles;
        const std::vector<uint32_t>& others = m_charts[joint.b].triangles;
        triangles.insert(triangles.end(), others.begin(), others.end());
        set_joined(joint, 1);
        build_chart(dst, m_surface, std::move(triangles), m_joined, m_place);
        return flatten_chart(dst, m_surface, kMostJoinedStretch) && room_of(dst) < m_rooms[joint.a] + m_rooms[joint.b];
    }

    std::vector<UnwrapChart>& m_charts;
    const UnwrapSurface& m_surface;
    JoinedEdges& m_joined;
    std::vector<uint32_t>& m_place;
    const double m_gap;
    const int m_nthreads;
    std::vector<uint32_t> m_chart_of;
    std::vector<std::vector<double>> m_turns;
    std::vector<double> m_perimeters, m_rooms;
    std::set<uint32_t> m_failed; // first half-edges of joints that did not stay flat
};

} // namespace

void merge_charts(std::vector<UnwrapChart>& charts, const UnwrapSurface& surface, JoinedEdges& joined,
                  std::vector<uint32_t>& place, double gap, int nthreads)
{
    Merger(charts, surface, joined, place, gap, nthreads).run();
    charts.erase(std::remove_if(charts.begin(), charts.end(), [](const UnwrapChart& c) { return c.triangles.empty(); }),
                 charts.end());
}

} // namespace vmlight
