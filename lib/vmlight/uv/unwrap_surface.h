// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/mesh/mesh.h>

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vmlight {

/// Which triangles of a mesh continue each other. Half-edge 3 t + k runs from corner k of triangle t to corner k + 1.
/// Lengths are in units of the mesh's size.
class UnwrapSurface
{
public:
    static constexpr uint32_t kNone = ~0u;

    explicit UnwrapSurface(const Mesh& mesh);

    size_t triangle_count() const { return m_points.size(); }
    /// The triangle has an area in space.
    bool has_area(uint32_t triangle) const { return m_areas[triangle] > 0; }
    double area(uint32_t triangle) const { return m_areas[triangle]; }
    /// Of unit length; zero without area.
    const Imath::V3d& normal(uint32_t triangle) const { return m_normals[triangle]; }
    Imath::V3d centroid(uint32_t triangle) const;
    /// Corners in the same place have the same point.
    uint32_t point(uint32_t triangle, int corner) const { return m_points[triangle][corner]; }
    Imath::V3d position(uint32_t point) const { return (m_positions[point] - m_centre) * m_scale; }
    /// From one corner to another, as exact as the mesh has them.
    Imath::V3d edge(uint32_t triangle, int from, int to) const
    {
        return (m_positions[m_points[triangle][to]] - m_positions[m_points[triangle][from]]) * m_scale;
    }
    /// The corners in the triangle's own plane: its longest edge is along u, from 0, and the third corner above it.
    std::array<Imath::V2d, 3> flat_corners(uint32_t triangle) const;
    /// The half-edge on the other side, of the triangle that continues this one; kNone where there is none.
    uint32_t twin(uint32_t half_edge) const { return m_twins[half_edge]; }
    /// Of one unit of length here, in the mesh's units.
    double unit() const { return 1 / m_scale; }

private:
    void pair_half_edges();

    std::vector<Imath::V3d> m_positions;
    Imath::V3d m_centre { 0 };
    double m_scale = 1;
    std::vector<std::array<uint32_t, 3>> m_points;
    std::vector<double> m_areas;
    std::vector<Imath::V3d> m_normals;
    std::vector<uint32_t> m_twins;
};

} // namespace vmlight
