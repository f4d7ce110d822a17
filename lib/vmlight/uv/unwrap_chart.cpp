// SPDX-License-Identifier: Apache-2.0
#include <vmlight/uv/unwrap_chart.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vmlight {

using Imath::V2d;
using Imath::V3d;

namespace {

uint32_t root_of(std::vector<uint32_t>& parents, uint32_t i)
{
    while (parents[i] != i)
        i = parents[i] = parents[parents[i]];
    return i;
}

uint32_t next_in_triangle(uint32_t half_edge)
{
    return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1;
}

// Half-edges without a joined twin, each followed by the one that starts where it ends.
void find_border(UnwrapChart& chart, const std::vector<char>& is_inside)
{
    std::vector<uint32_t> leaving(chart.points.size(), UnwrapSurface::kNone);
    for (uint32_t h = 0; h < is_inside.size(); ++h)
        if (!is_inside[h])
            leaving[chart.from(h)] = h; // one each: vertices are of one fan of triangles
    for (uint32_t h = 0; h < is_inside.size(); ++h) {
        if (is_inside[h] || leaving[chart.from(h)] == UnwrapSurface::kNone)
            continue;
        chart.loops.push_back(uint32_t(chart.border.size()));
        for (uint32_t at = h; at != UnwrapSurface::kNone; at = leaving[chart.to(at)]) {
            chart.border.push_back(at);
            leaving[chart.from(at)] = UnwrapSurface::kNone;
        }
    }
    chart.loops.push_back(uint32_t(chart.border.size()));
}

V3d mean_normal(const UnwrapChart& chart, const UnwrapSurface& surface)
{
    V3d sum(0);
    for (uint32_t t : chart.triangles)
        sum += surface.normal(t) * surface.area(t);
    return sum.normalized();
}

bool faces(const UnwrapChart& chart, const UnwrapSurface& surface, const V3d& axis, double least_cosine)
{
    return std::all_of(chart.triangles.begin(), chart.triangles.end(),
                       [&](uint32_t t) { return surface.normal(t).dot(axis) > least_cosine; });
}

void project(UnwrapChart& chart, const UnwrapSurface& surface, const V3d& axis)
{
    const V3d aside = std::abs(axis.x) < 0.6 ? V3d(1, 0, 0) : V3d(0, 1, 0);
    const V3d u = aside.cross(axis).normalized(), v = axis.cross(u);
    chart.uvs.clear();
    for (uint32_t point : chart.points) {
        const V3d p = surface.position(point);
        chart.uvs.push_back({ p.dot(u), p.dot(v) });
    }
}

double doubled_uv_area(const UnwrapChart& chart, const std::array<uint32_t, 3>& c)
{
    return (chart.uvs[c[1]] - chart.uvs[c[0]]).cross(chart.uvs[c[2]] - chart.uvs[c[0]]);
}

// Give the chart the area of its surface, and measure its stretch. False if it has none.
bool scale_to_surface(UnwrapChart& chart, const UnwrapSurface& surface)
{
    double area = 0;
    for (const auto& corners : chart.corners)
        area += doubled_uv_area(chart, corners) / 2;
    if (!(area > 0) || !std::isfinite(area))
        return false;
    const double scale = std::sqrt(chart.area / area);
    for (V2d& uv : chart.uvs)
        uv *= scale;
    double sum = 0;
    for (size_t i = 0; i < chart.triangles.size(); ++i) {
        const uint32_t t = chart.triangles[i];
        const auto& c = chart.corners[i];
        const V2d a = chart.uvs[c[1]] - chart.uvs[c[0]], b = chart.uvs[c[2]] - chart.uvs[c[0]];
        const V3d p = surface.edge(t, 0, 1), q = surface.edge(t, 0, 2);
        const double doubled = a.cross(b);
        // The derivatives of the surface along u and v; half the sum of their squares is that of the singular values.
        const V3d du = (p * b.y - q * a.y) / doubled, dv = (q * a.x - p * b.x) / doubled;
        sum += surface.area(t) * (du.length2() + dv.length2()) / 2;
    }
    chart.stretch = std::sqrt(sum / chart.area);
    return std::isfinite(chart.stretch);
}

// A triangle alone is laid down as it is.
void lay_triangle(UnwrapChart& chart, const UnwrapSurface& surface)
{
    const std::array<V2d, 3> corners = surface.flat_corners(chart.triangles[0]);
    chart.uvs.resize(3);
    for (size_t k = 0; k < 3; ++k)
        chart.uvs[chart.corners[0][k]] = corners[k];
    chart.stretch = 1;
}

} // namespace

void build_chart(UnwrapChart& dst, const UnwrapSurface& surface, std::vector<uint32_t> triangles,
                 const JoinedEdges& joined, std::vector<uint32_t>& place)
{
    dst = UnwrapChart();
    std::sort(triangles.begin(), triangles.end());
    dst.triangles = std::move(triangles);
    const uint32_t count = uint32_t(dst.triangles.size());
    for (uint32_t i = 0; i < count; ++i) {
        place[dst.triangles[i]] = i;
        dst.area += surface.area(dst.triangles[i]);
    }
    std::vector<uint32_t> parents(3 * size_t(count));
    std::iota(parents.begin(), parents.end(), 0u);
    std::vector<char> is_inside(parents.size(), 0);
    for (uint32_t h = 0; h < parents.size(); ++h) {
        const uint32_t edge = dst.surface_edge(h), twin = surface.twin(edge);
        if (twin == UnwrapSurface::kNone || !joined[edge])
            continue;
        is_inside[h] = 1;
        const uint32_t other = 3 * place[twin / 3] + twin % 3;
        parents[root_of(parents, h)] = root_of(parents, next_in_triangle(other));
        parents[root_of(parents, next_in_triangle(h))] = root_of(parents, other);
    }
    std::vector<uint32_t> vertices(parents.size(), UnwrapSurface::kNone);
    dst.corners.resize(count);
    for (uint32_t corner = 0; corner < parents.size(); ++corner) {
        uint32_t& vertex = vertices[root_of(parents, corner)];
        if (vertex == UnwrapSurface::kNone) {
            vertex = uint32_t(dst.points.size());
            dst.points.push_back(surface.point(dst.triangles[corner / 3], int(corner % 3)));
        }
        dst.corners[corner / 3][corner % 3] = vertex;
    }
    find_border(dst, is_inside);
}

bool flatten_chart(UnwrapChart& chart, const UnwrapSurface& surface, double most_stretch)
{
    if (chart.triangles.size() == 1) {
        lay_triangle(chart, surface);
        return true;
    }
    if (chart.border.empty())
        return false;
    const auto is_good
        = [&] { return scale_to_surface(chart, surface) && chart.stretch <= most_stretch && is_one_to_one(chart); };
    // A projection keeps what is flat as it is, bit for bit on all machines, and is quick.
    const V3d axis = mean_normal(chart, surface);
    constexpr double kNearlyFlat = 0.97;
    if (faces(chart, surface, axis, kNearlyFlat)) {
        project(chart, surface, axis);
        if (is_good())
            return true;
    }
    if (map_conformally(chart, surface) && is_good())
        return true;
    if (!faces(chart, surface, axis, 0))
        return false;
    project(chart, surface, axis);
    return is_good();
}

} // namespace vmlight
