// SPDX-License-Identifier: Apache-2.0
#include <vmlight/math/lattice.h>

#include <vmlight/math/latlong.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace vmlight {
namespace {

using latlong::pi;
using Edge = std::array<int64_t, 2>;

int64_t dot(const Edge& a, const Edge& b)
{
    return a[0] * b[0] + a[1] * b[1];
}

// The two shortest edges of the lattice's cells: Gauss's reduction.
std::array<Edge, 2> shortest_edges(int64_t count, int64_t generator)
{
    Edge first { 1, generator }, second { 0, count };
    for (;;) {
        if (dot(first, first) > dot(second, second))
            std::swap(first, second);
        if (2 * std::abs(dot(first, second)) <= dot(first, first)) // rounding a half would turn in circles
            return { first, second };
        const int64_t times = std::llround(double(dot(first, second)) / double(dot(first, first)));
        for (size_t c = 0; c < 2; ++c)
            second[c] -= times * first[c];
    }
}

// Of one coordinate, x, to figure_of_merit(): 2 pi^2 times a Bernoulli polynomial, whose Fourier series is that of
// h^-2.
double merit_factor(double x)
{
    return 1 + 2 * pi * pi * (x * x - x + 1.0 / 6);
}

// P2: the sum over the dual lattice of max(1, |h|)^-2 max(1, |k|)^-2, by its closed form.
double figure_of_merit(int64_t count, int64_t generator)
{
    double sum = 0;
    for (int64_t i = 0, v = 0; i < count; ++i, v = (v + generator) % count)
        sum += merit_factor(double(i) / double(count)) * merit_factor(double(v) / double(count));
    return sum / double(count) - 1;
}

// Steps of figure_of_merit() that the search takes: all generators of up to 1024 points, or their mirror images.
constexpr int64_t kSteps = int64_t(1) << 20;

// How far a step right, and one down, moves the lattice along either edge of its cell, in 2^-32 of that edge. Found by
// search: means over Gaussian windows of 8, 19 and 36 texels keep least of the lattice's first harmonics.
constexpr uint32_t kStep[2][2] = { { 0x1d38fe6cu, 0x6ba0c707u }, { 0x70ab290fu, 0xada55388u } };

} // namespace

Lattice::Lattice(uint32_t count)
    : m_count(count)
{
    const int64_t n = count, middle = std::llround(double(n) * (std::sqrt(5.0) - 1) / 2);
    double least = std::numeric_limits<double>::infinity();
    // From the middle outwards, so that of equals the nearest wins.
    for (int64_t away = 0; away <= std::max(int64_t(4), kSteps / n / 2) && away < n; ++away)
        for (const int64_t generator : { middle - away, middle + away }) {
            if (generator < 1 || (generator >= n && n > 1))
                continue;
            if (const double merit = figure_of_merit(n, generator); merit < least * (1 - 1e-9)) {
                least = merit;
                m_generator = uint32_t(generator);
            }
        }
    const std::array<Edge, 2> edges = shortest_edges(n, m_generator);
    m_first = edges[0];
    m_second = edges[1];
}

Point32 Lattice::point(uint32_t index) const
{
    const uint64_t v = uint64_t(index) * m_generator % m_count;
    return { uint32_t((uint64_t(index) << 32) / m_count), uint32_t((v << 32) / m_count) };
}

Point32 Lattice::shift(uint32_t x, uint32_t y, uint32_t seed) const
{
    const Point32 start = texel_hash(0, 0, seed);
    const int64_t s = uint32_t(start.u + x * kStep[0][0] + y * kStep[0][1]);
    const int64_t t = uint32_t(start.v + x * kStep[1][0] + y * kStep[1][1]);
    const auto along = [&](size_t c) { return uint32_t((s * m_first[c] + t * m_second[c]) / int64_t(m_count)); };
    return { along(0), along(1) };
}

Point32 Lattice::reduce(Point32 shift) const
{
    const Point32 step = point(uint32_t((uint64_t(shift.u) * m_count) >> 32));
    return { shift.u - step.u, shift.v - step.v };
}

} // namespace vmlight
