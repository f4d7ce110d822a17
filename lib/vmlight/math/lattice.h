// SPDX-License-Identifier: Apache-2.0
/// Points of a lattice in the unit square, of any number, and shifts of it that fill its gaps evenly.
#pragma once

#include <vmlight/math/sampling.h>

#include <array>
#include <cstdint>

namespace vmlight {

/// A rank-1 lattice on the unit torus: point i is (i, i * generator modulo count) / count. The generator is the one of
/// the least P2, the usual figure of merit, and of equals that nearest to count / golden ratio: for Fibonacci numbers a
/// lattice no worse than Fibonacci's, and for others one that closes on the torus, where the golden ratio's has a
/// fault. Source: I. Sloan, S. Joe, "Lattice Methods for Multiple Integration", 1994, chapters 1 and 4.
class Lattice
{
public:
    /// @param count    of points, 1 to 2^20
    explicit Lattice(uint32_t count);

    uint32_t count() const { return m_count; }
    uint32_t generator() const { return m_generator; }
    /// @param index    less than count()
    Point32 point(uint32_t index) const;

    /// How far the texel at (x, y) shifts all points. Alone, each texel's shift is evenly distributed over the cell
    /// between points. Of any few neighbours, in whatever direction, the shifted lattices together are nearly a finer
    /// lattice, so that a mean over them has a far smaller error than a mean over as many independent ones: in windows
    /// like those of reconstruction about half (tests/unit/lattice_test.cpp).
    Point32 shift(uint32_t x, uint32_t y, uint32_t seed) const;

    /// A shift to the same points, if not in the same order, that moves them along u by less than the step from point
    /// to point: none passes the end of the interval.
    Point32 reduce(Point32 shift) const;

private:
    uint32_t m_count, m_generator = 1;
    std::array<int64_t, 2> m_first { 1, 0 }, m_second { 0, 1 }; // edges of a cell, in 1 / count
};

} // namespace vmlight
