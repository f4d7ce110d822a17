// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/uv/unwrap_surface.h>

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vmlight {

/// For each half-edge of a surface, whether it is joined to its twin. char, so that threads may write neighbours.
using JoinedEdges = std::vector<char>;

/// A connected piece of a surface: two triangles are neighbours where their half-edges are joined. It has its own
/// vertices: along a seam inside it they are twice there.
struct UnwrapChart
{
    std::vector<uint32_t> triangles; ///< of the surface, ascending
    std::vector<std::array<uint32_t, 3>> corners; ///< of each triangle, indices into `uvs`
    std::vector<uint32_t> points; ///< of each vertex, the surface's
    /// Counter-clockwise seen from outside. Empty until the chart is laid flat, then with the area of the surface.
    std::vector<Imath::V2d> uvs;
    /// Half-edges, 3 i + k of triangle i of the chart, that have no joined twin, loop by loop; each loop starts at an
    /// index in `loops`, which also has the end.
    std::vector<uint32_t> border, loops;
    double area = 0; ///< on the surface
    double stretch = 1; ///< see UnwrapReport

    uint32_t from(uint32_t half_edge) const { return corners[half_edge / 3][half_edge % 3]; }
    uint32_t to(uint32_t half_edge) const { return corners[half_edge / 3][(half_edge % 3 + 1) % 3]; }
    /// The surface's half-edge.
    uint32_t surface_edge(uint32_t half_edge) const { return 3 * triangles[half_edge / 3] + half_edge % 3; }
};

/// Build a chart from triangles of a surface.
/// @param place    for each triangle of the surface, its index in its chart: written here. Calls with other triangles
///                 may run at the same time
void build_chart(UnwrapChart& dst, const UnwrapSurface& surface, std::vector<uint32_t> triangles,
                 const JoinedEdges& joined, std::vector<uint32_t>& place);

/// Lay a chart flat, without fold or overlap.
/// @param most_stretch     the largest that is accepted, of the chart as a whole
/// @returns false if it cannot be; one triangle always can
bool flatten_chart(UnwrapChart& chart, const UnwrapSurface& surface, double most_stretch);

/// Least-squares conformal map: sets chart.uvs. False if the equations have no solution.
/// Source: B. Levy, S. Petitjean, N. Ray, J. Maillot, "Least Squares Conformal Maps for Automatic Texture Atlas
/// Generation", SIGGRAPH 2002, section 3.
bool map_conformally(UnwrapChart& chart, const UnwrapSurface& surface);

/// Whether no triangle is folded over, and the border nowhere meets itself: then the map is one to one.
bool is_one_to_one(const UnwrapChart& chart);

} // namespace vmlight
