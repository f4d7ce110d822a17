// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/height_grid.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>

#include <algorithm>
#include <array>
#include <cstdint>

namespace vmlight {
namespace {

using Imath::V2f;
using Imath::V3d;

// Of the heights along a row or a column, from the neighbours that exist.
double slope(const HeightGrid& grid, int column, int row, int right, int down)
{
    const bool before = grid.has(column - right, row - down), after = grid.has(column + right, row + down);
    const double here = grid.at(column, row);
    const double first = before ? grid.at(column - right, row - down) : here;
    const double last = after ? grid.at(column + right, row + down) : here;
    return before || after ? (last - first) / (grid.spacing * (int(before) + int(after))) : 0;
}

/// The triangles of a grid, whose vertices are those of pixels with a height, in their order.
class GridTriangles
{
public:
    explicit GridTriangles(const HeightGrid& grid)
        : m_grid(grid)
    {
        const auto holes
            = std::count_if(grid.heights.begin(), grid.heights.end(), [](float height) { return std::isnan(height); });
        m_holes = size_t(holes);
        if (!holes)
            return;
        uint32_t next = 0;
        for (const float height : grid.heights)
            m_numbers.push_back(std::isnan(height) ? kNone : next++);
    }

    size_t holes() const { return m_holes; }

    template <class Add> void visit(const Add& add) const
    {
        for (int row = 0; row + 1 < m_grid.rows; ++row)
            for (int column = 0; column + 1 < m_grid.columns; ++column)
                visit_quad(column, row, add);
    }

private:
    static constexpr uint32_t kNone = ~0u;

    uint32_t number(int column, int row) const
    {
        const size_t pixel = size_t(row) * size_t(m_grid.columns) + size_t(column);
        return m_numbers.empty() ? uint32_t(pixel) : m_numbers[pixel];
    }

    // Counter-clockwise from above: the top left a, the bottom left b, the bottom right c, the top right d.
    template <class Add> void visit_quad(int column, int row, const Add& add) const
    {
        const uint32_t a = number(column, row), b = number(column, row + 1), c = number(column + 1, row + 1),
                       d = number(column + 1, row);
        const auto add_if_whole = [&](const std::array<uint32_t, 3>& triangle) {
            if (std::find(triangle.begin(), triangle.end(), kNone) == triangle.end())
                add(triangle);
        };
        const float falls = std::abs(m_grid.at(column, row) - m_grid.at(column + 1, row + 1));
        const float rises = std::abs(m_grid.at(column, row + 1) - m_grid.at(column + 1, row));
        if (a == kNone || c == kNone || rises < falls) { // the diagonal from b to d
            add_if_whole({ a, b, d });
            add_if_whole({ b, c, d });
        } else {
            add_if_whole({ a, b, c });
            add_if_whole({ a, c, d });
        }
    }

    const HeightGrid& m_grid;
    size_t m_holes = 0;
    std::vector<uint32_t> m_numbers; // of each pixel; empty if all have one
};

} // namespace

bool append_height_grid(MeshBuilder& dst, const HeightGrid& grid, std::string& error)
{
    const GridTriangles triangles(grid);
    size_t count = 0;
    triangles.visit([&](const std::array<uint32_t, 3>&) { ++count; });
    if (count == 0) {
        error = "no triangles: no three neighbouring pixels have a height";
        return false;
    }
    dst.reserve(grid.heights.size() - triangles.holes(), count);
    dst.begin_part("", Imath::M44d(), dst.add_node("", -1));
    const uint32_t material = dst.add_material({});
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column) {
            if (!grid.has(column, row))
                continue;
            const double x = grid.left + column + 0.5, z = grid.top + row + 0.5;
            const V2f uv(float(x / grid.full_columns), float(1 - z / grid.full_rows));
            dst.add_vertex(V3d((x - 0.5 * grid.full_columns) * grid.spacing, grid.at(column, row),
                               (z - 0.5 * grid.full_rows) * grid.spacing),
                           V3d(-slope(grid, column, row, 1, 0), 1, -slope(grid, column, row, 0, 1)),
                           dst.params().uv_set == 0 ? &uv : nullptr);
        }
    triangles.visit([&](const std::array<uint32_t, 3>& triangle) { dst.add_triangle(triangle, material); });
    dst.set_unique_vertices();
    if (triangles.holes() > 0)
        dst.warn(format("{} of {} pixels {} no height: holes in the ground", triangles.holes(), grid.heights.size(),
                        plural(int64_t(triangles.holes()), "has", "have")));
    return true;
}

} // namespace vmlight
