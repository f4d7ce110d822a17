// SPDX-License-Identifier: Apache-2.0
#include <vmlight/uv/unwrap_surface.h>

#include <vmlight/base/unique_index.h>

#include <Imath/ImathBox.h>

#include <algorithm>

namespace vmlight {

using Imath::V3d;

UnwrapSurface::UnwrapSurface(const Mesh& mesh)
{
    const size_t count = mesh.triangles.size();
    UniqueIndex<V3d> points(mesh.positions.size());
    std::vector<uint32_t> point_of_vertex;
    for (const V3d& position : mesh.positions)
        point_of_vertex.push_back(points.index_of(position + V3d(0))); // -0 becomes 0
    m_positions = points.keys();

    Imath::Box3d bounds;
    std::vector<V3d> area_normals(count, V3d(0));
    for (uint32_t t = 0; t < count; ++t) {
        const auto& triangle = mesh.triangles[t];
        m_points.push_back(
            { point_of_vertex[triangle[0]], point_of_vertex[triangle[1]], point_of_vertex[triangle[2]] });
        area_normals[t] = triangle_area_normal(mesh, triangle);
        if (area_normals[t].length() > 0)
            for (uint32_t point : m_points[t])
                bounds.extendBy(m_positions[point]);
    }
    m_areas.assign(count, 0);
    m_normals.assign(count, V3d(0));
    m_twins.assign(3 * count, kNone);
    if (bounds.isEmpty())
        return;
    const V3d size = bounds.size();
    m_centre = bounds.min + size * 0.5;
    m_scale = 1 / std::max({ size.x, size.y, size.z });
    for (uint32_t t = 0; t < count; ++t) {
        if (!(area_normals[t].length() > 0))
            continue;
        m_normals[t] = area_normals[t].normalized();
        m_areas[t] = area_normals[t].length() * m_scale * m_scale / 2;
    }
    pair_half_edges();
}

V3d UnwrapSurface::centroid(uint32_t triangle) const
{
    return position(point(triangle, 0)) + (edge(triangle, 0, 1) + edge(triangle, 0, 2)) / 3;
}

// Where an edge has more than two triangles, as where a wall stands on a floor, those continue each other whose normals
// differ least.
std::array<Imath::V2d, 3> UnwrapSurface::flat_corners(uint32_t triangle) const
{
    int k = 0;
    for (int other = 1; other < 3; ++other)
        if (edge(triangle, other, (other + 1) % 3).length2() > edge(triangle, k, (k + 1) % 3).length2())
            k = other;
    const V3d along = edge(triangle, k, (k + 1) % 3), other = edge(triangle, k, (k + 2) % 3);
    const double length = along.length();
    std::array<Imath::V2d, 3> corners { Imath::V2d(0), Imath::V2d(0), Imath::V2d(0) };
    corners[(k + 1) % 3] = { length, 0 };
    corners[(k + 2) % 3] = { other.dot(along) / length, 2 * area(triangle) / length };
    return corners;
}

void UnwrapSurface::pair_half_edges()
{
    struct Side
    {
        uint64_t edge; // both points, the lower first
        uint32_t half_edge;
        bool is_forward;
    };
    std::vector<Side> sides;
    for (uint32_t t = 0; t < triangle_count(); ++t)
        for (int k = 0; k < 3 && has_area(t); ++k) {
            const uint32_t from = point(t, k), to = point(t, (k + 1) % 3);
            sides.push_back(
                { uint64_t(std::min(from, to)) << 32 | std::max(from, to), 3 * t + uint32_t(k), from < to });
        }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return a.edge != b.edge ? a.edge < b.edge : a.half_edge < b.half_edge;
    });
    struct Pair
    {
        double agreement;
        uint32_t a, b;
    };
    std::vector<Pair> pairs;
    constexpr size_t kMostSides = 64; // of a fan: beyond, all pairs would take too long
    for (size_t first = 0, end = 0; first < sides.size(); first = end) {
        while (end < sides.size() && sides[end].edge == sides[first].edge)
            ++end;
        pairs.clear();
        for (size_t i = first; i < end && end - first <= kMostSides; ++i)
            for (size_t j = i + 1; j < end; ++j)
                if (sides[i].is_forward != sides[j].is_forward) {
                    const uint32_t a = sides[i].half_edge, b = sides[j].half_edge;
                    pairs.push_back({ m_normals[a / 3].dot(m_normals[b / 3]), a, b });
                }
        std::stable_sort(pairs.begin(), pairs.end(),
                         [](const Pair& a, const Pair& b) { return a.agreement > b.agreement; });
        for (const Pair& pair : pairs)
            if (m_twins[pair.a] == kNone && m_twins[pair.b] == kNone) {
                m_twins[pair.a] = pair.b;
                m_twins[pair.b] = pair.a;
            }
    }
}

} // namespace vmlight
