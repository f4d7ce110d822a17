// SPDX-License-Identifier: Apache-2.0
#include <vmlight/math/lattice.h>
#include <vmlight/math/sampling.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <set>

using namespace vmlight;
using Imath::V3d;
using Imath::V3f;

namespace {

double fraction(uint32_t x)
{
    return x * 0x1p-32;
}

// Cells of the unit interval cut in `cells`, counted over points 0 .. n - 1.
template <class Point> std::vector<int> count_cells(int n, int cells, const Point& point)
{
    std::vector<int> counts(static_cast<size_t>(cells));
    for (int i = 0; i < n; ++i)
        ++counts[size_t(uint64_t(point(uint32_t(i))) * uint64_t(cells) >> 32)];
    return counts;
}

bool all_equal(const std::vector<int>& counts, int value)
{
    return std::all_of(counts.begin(), counts.end(), [&](int c) { return c == value; });
}

// Every elementary interval of every shape holds as many of the 2^m points as its area says.
template <class Point> void expect_net(int m, const Point& point)
{
    for (int k = 0; k <= m; ++k) {
        std::vector<int> counts(size_t(1) << m);
        for (uint32_t i = 0; i < 1u << m; ++i) {
            const Point32 p = point(i);
            const uint32_t column = k ? p.u >> (32 - k) : 0, row = m - k ? p.v >> (32 - (m - k)) : 0;
            ++counts[size_t(column) << (m - k) | row];
        }
        EXPECT_TRUE(all_equal(counts, 1)) << "2^" << m << " points, " << k << " cuts of u";
    }
}

} // namespace

TEST(Sampling, TheFirstPowersOfTheBaseHitEachCellOnce)
{
    for (int power = 1; power <= 1 << 14; power *= 2)
        EXPECT_TRUE(all_equal(count_cells(power, power, [](uint32_t i) { return halton_point(i).u; }), 1)) << power;
    // Digits of base 3 are cut at 2^-32: a point may fall short of its cell's left end by that.
    for (int power = 1; power <= 19683; power *= 3)
        EXPECT_TRUE(all_equal(count_cells(power, power, [](uint32_t i) { return halton_point(i).v + 2; }), 1)) << power;
    EXPECT_EQ(halton_point(1).u, 0x80000000u);
    EXPECT_EQ(halton_point(6).u, 0x60000000u);
    EXPECT_NEAR(fraction(halton_point(5).v), 7.0 / 9, 1e-9);
    for (uint32_t index : { 1u, 5u, 1000u, 1u << 20, (1u << 20) + 12345 }) {
        double inverse = 0, place = 1.0 / 3;
        for (uint32_t rest = index; rest; rest /= 3, place /= 3)
            inverse += rest % 3 * place;
        EXPECT_NEAR(fraction(halton_point(index).v), inverse, 1e-9) << index;
    }
}

TEST(Sampling, HaltonPointsInBaseSixBlocksHitEachRectangleOnce)
{
    // 2^3 x 3^2 cells: the first 72 points are one in each.
    std::set<std::pair<uint64_t, uint64_t>> cells;
    for (uint32_t i = 0; i < 72; ++i) {
        const Point32 p = halton_point(i);
        cells.insert({ uint64_t(p.u) * 8 >> 32, uint64_t(p.v + 2) * 9 >> 32 });
    }
    EXPECT_EQ(cells.size(), 72u);
}

TEST(Sampling, SobolPointsAreANetAndStayOneWhenScrambled)
{
    for (int m = 0; m <= 12; ++m) {
        expect_net(m, sobol_point);
        for (uint32_t seed : { 0u, 1u, 0xdeadbeefu, 0xffffffffu })
            expect_net(m, [&](uint32_t i) {
                const Point32 p = sobol_point(i);
                return Point32 { owen_scramble(p.u, seed), owen_scramble(p.v, ~seed) };
            });
    }
    // Every later block of 2^m points is a net, too.
    expect_net(8, [](uint32_t i) { return sobol_point(i + 256 * 77); });
}

TEST(Sampling, ScramblingIsNestedAndOneToOne)
{
    std::mt19937 random(5);
    for (int run = 0; run < 2000; ++run) {
        const uint32_t seed = random(), x = random(), bit = random() % 32;
        // Numbers that agree in their first bits agree in them after, and numbers that differ next do so after.
        const uint32_t difference = owen_scramble(x, seed) ^ owen_scramble(x ^ (1u << bit), seed);
        EXPECT_EQ(difference >> bit, 1u) << bit;
    }
    // Each half goes left or right as chance will.
    int flipped = 0;
    for (uint32_t seed = 0; seed < 4096; ++seed) {
        const Point32 hash = texel_hash(seed, 3, 7);
        flipped += owen_scramble(0, hash.u) >> 31;
    }
    EXPECT_NEAR(flipped, 2048, 160); // five sigma
}

TEST(Sampling, OnlyTheLatticesTexelsComplementEachOther)
{
    const SamplePattern lattice("fibonacci", 64, false), sobol("sobol", 64, false), halton("halton", 64, false);
    for (int x : { 0, 5 })
        for (uint32_t seed : { 0u, 9u }) {
            const Point32 hash = texel_hash(uint32_t(x), 3, seed);
            for (const SamplePattern* pattern : { &sobol, &halton })
                EXPECT_EQ(pattern->texel(x, 3, seed).u, hash.u);
            EXPECT_EQ(lattice.texel(x, 3, seed).v, Lattice(64).shift(uint32_t(x), 3, seed).v);
        }
}

TEST(Sampling, TexelsSeedsAndCoordinatesAllGiveOtherNumbers)
{
    std::set<uint64_t> seen;
    for (uint32_t seed : { 0u, 1u, 2u, 2147483647u })
        for (uint32_t y = 0; y < 64; ++y)
            for (uint32_t x = 0; x < 64; ++x) {
                const Point32 h = texel_hash(x, y, seed);
                seen.insert(uint64_t(h.u) << 32 | h.v);
                EXPECT_NE(h.u, h.v);
            }
    EXPECT_EQ(seen.size(), 4u * 64 * 64);
    // Neighbours share no bits: half of the 64 differ, sigma 4 a pair.
    double bits = 0, u = 0, v = 0, uv = 0;
    for (uint32_t y = 0; y < 64; ++y)
        for (uint32_t x = 0; x < 64; ++x) {
            const Point32 a = texel_hash(x, y, 0), b = texel_hash(x + 1, y, 0);
            bits += __builtin_popcount(a.u ^ b.u) + __builtin_popcount(a.v ^ b.v);
            u += fraction(a.u) - 0.5, v += fraction(a.v) - 0.5;
            uv += (fraction(a.u) - 0.5) * (fraction(a.v) - 0.5);
        }
    EXPECT_NEAR(bits / 4096, 32, 5 * 4.0 / 64);
    EXPECT_NEAR(u / 4096, 0, 5 * 0.2887 / 64);
    EXPECT_NEAR(v / 4096, 0, 5 * 0.2887 / 64);
    EXPECT_NEAR(uv / 4096, 0, 5 / 12.0 / 64);
}
