// SPDX-License-Identifier: Apache-2.0
/// Opacity micromaps: a triangle cut into cells of which most are known to be opaque or transparent, so that a hit
/// needs its texture only in the rest. Source of the idea: H. Gruen et al., "Sub-triangle opacity masks for faster ray
/// tracing of transparent objects", PACM CGIT 3(2), 2020.
#pragma once

#include <vmlight/mesh/opacity.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vmlight {

enum class CellState : uint8_t
{
    transparent,
    opaque,
    unknown
};

/// The cells of a triangle at a level: its edges are cut into 2^level, which makes 4^level cells. In the unit square of
/// the barycentric weights u and v they are halves of squares, row by row, below the diagonal and then above it.
struct MicromapGrid
{
    static constexpr int kDeepest = 8;

    int level = 0;

    int64_t count() const { return int64_t(1) << (2 * level); }
    /// The cell of a point: u and v at least 0, u + v at most 1. Points beyond that by rounding belong to the cell that
    /// they are nearest to.
    int64_t cell(double u, double v) const
    {
        const int n = 1 << level;
        int i = std::min(int(u * n), n - 1), j = std::min(int(v * n), n - 1);
        if (i + j >= n - 1) { // along the hypotenuse: no half above it
            j = std::max(0, n - 1 - i);
            return index(i, j, false);
        }
        return index(i, j, (u * n - i) + (v * n - j) > 1);
    }
    /// The same where every point within `error` of (u, v), in each, lies in one cell; else -1. u and v are about
    /// from 0 to 1.
    int64_t cell_within(float u, float v, float error) const
    {
        const int n = 1 << level;
        const float slack = 2 * error * float(n);
        const float x = std::min(float(n), u * float(n)), y = std::min(float(n), v * float(n)); // NaN: n
        const int i = int(x), j = int(y);
        const float across = x - float(i), up = y - float(j);
        const bool is_upper = across + up > 1;
        // Without branches: which way they go is as random as the hits.
        const int is_inside = int(std::fabs(across - 0.5f) < 0.5f - slack) & int(std::fabs(up - 0.5f) < 0.5f - slack)
            & int(std::fabs(across + up - 1) > slack) & int(i + j + int(is_upper) < n);
        return is_inside ? index(i, j, is_upper) : -1;
    }
    /// Where the half of square (i, j) is stored.
    int64_t index(int i, int j, bool is_upper) const
    {
        return int64_t(j) * ((int64_t(2) << level) - j) + 2 * int64_t(i) + is_upper;
    }
};

/// The least and the greatest weight of each corner of a triangle.
struct WeightRange
{
    std::array<float, 3> least { 0, 0, 0 }, most { 1, 1, 1 };
};

/// What is known of a triangle's opacity. No cell ever disagrees with TriangleOpacity::at().
struct OpacityMicromap
{
    /// Of the whole triangle: unknown if it is neither one nor the other throughout.
    CellState whole = CellState::unknown;
    MicromapGrid grid;
    /// Two bits a cell, 32 cells a word; empty unless `whole` is unknown.
    std::vector<uint64_t> cells;
    int64_t unknown = 0; ///< cells
    /// Of the points of all cells that are not transparent; the whole range if all or no cells are.
    WeightRange stopping;

    CellState state(int64_t cell) const { return CellState(cells[size_t(cell / 32)] >> (2 * (cell % 32)) & 3); }
};

/// The level at which a triangle's cells are about as large as a few texels; 0 if its opacity is the same everywhere.
int micromap_level(const TriangleOpacity& triangle);

/// Sort the cells of a triangle at a level, by the range of opacity in each.
OpacityMicromap make_micromap(const TriangleOpacity& triangle, int level);

} // namespace vmlight
