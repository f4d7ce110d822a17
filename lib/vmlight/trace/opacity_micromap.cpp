// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/opacity_micromap.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vmlight {
namespace {

using Imath::V2d;

// Along a cell's edge. With fewer, fewer cells ask the texture, but micromaps are larger (bench/cutout_bench.cpp).
constexpr double kTexelsPerCell = 6;

CellState state_of(const AlphaRange& opacity)
{
    return opacity.low >= 1 ? CellState::opaque : opacity.high <= 0 ? CellState::transparent : CellState::unknown;
}

class Sorter
{
public:
    Sorter(OpacityMicromap& dst, const TriangleOpacity& triangle)
        : m_dst(dst)
        , m_triangle(triangle)
    {
    }

    // From a half of square (i, j) at a level down to the cells: what is known of the half holds for all in it.
    void sort(int level, int i, int j, bool is_upper, CellState known)
    {
        if (known == CellState::unknown)
            known = state_of(m_triangle.range(corners(level, i, j, is_upper)));
        if (level == m_dst.grid.level) {
            set(m_dst.grid.index(i, j, is_upper), known);
            if (known != CellState::transparent)
                add_stopping({ (1 << level) - 1 - i - j - is_upper, i, j });
            return;
        }
        const int x = 2 * i, y = 2 * j;
        if (is_upper) {
            sort(level + 1, x + 1, y, true, known);
            sort(level + 1, x, y + 1, true, known);
            sort(level + 1, x + 1, y + 1, false, known);
            sort(level + 1, x + 1, y + 1, true, known);
        } else {
            sort(level + 1, x, y, false, known);
            sort(level + 1, x, y, true, known);
            sort(level + 1, x + 1, y, false, known);
            sort(level + 1, x, y + 1, false, known);
        }
    }

    // Cells of each state.
    std::array<int64_t, 3> counts {};
    // Weights of the points of cells that are not transparent.
    WeightRange stopping { { 1, 1, 1 }, { 0, 0, 0 } };

private:
    static std::array<V2d, 3> corners(int level, int i, int j, bool is_upper)
    {
        const double side = std::ldexp(1.0, -level), left = i * side, right = (i + 1) * side;
        const double low = j * side, high = (j + 1) * side;
        const V2d third = is_upper ? V2d(right, high) : V2d(left, low);
        return { V2d(right, low), V2d(left, high), third };
    }
    // A cell's least weights, in edges of cells.
    void add_stopping(const std::array<int, 3>& least)
    {
        for (size_t k = 0; k < 3; ++k) {
            stopping.least[k] = std::min(stopping.least[k], std::ldexp(float(least[k]), -m_dst.grid.level));
            stopping.most[k] = std::max(stopping.most[k], std::ldexp(float(least[k] + 1), -m_dst.grid.level));
        }
    }
    void set(int64_t cell, CellState state)
    {
        m_dst.cells[size_t(cell / 32)] |= uint64_t(state) << (2 * (cell % 32));
        ++counts[size_t(state)];
    }

    OpacityMicromap& m_dst;
    const TriangleOpacity& m_triangle;
};

} // namespace

int micromap_level(const TriangleOpacity& triangle)
{
    const double edge = triangle.is_constant() ? 0 : triangle.longest_edge() / kTexelsPerCell;
    int level = 0;
    while (level < MicromapGrid::kDeepest && double(1 << level) < edge)
        ++level;
    return level;
}

OpacityMicromap make_micromap(const TriangleOpacity& triangle, int level)
{
    OpacityMicromap result;
    if (triangle.is_constant()) { // between texels the range says less than the value
        const double opacity = triangle.at(0, 0);
        result.whole = state_of({ opacity, opacity });
    } else {
        result.whole = state_of(triangle.range({ V2d(0, 0), V2d(1, 0), V2d(0, 1) }));
    }
    if (result.whole != CellState::unknown)
        return result;
    result.grid.level = level;
    result.cells.resize(size_t((result.grid.count() + 31) / 32));
    Sorter sorter(result, triangle);
    sorter.sort(0, 0, 0, false, CellState::unknown);
    result.unknown = sorter.counts[size_t(CellState::unknown)];
    for (const CellState state : { CellState::transparent, CellState::opaque })
        if (sorter.counts[size_t(state)] == result.grid.count()) {
            result.whole = state;
            result.cells.clear();
        }
    if (result.whole == CellState::unknown)
        result.stopping = sorter.stopping;
    return result;
}

} // namespace vmlight
