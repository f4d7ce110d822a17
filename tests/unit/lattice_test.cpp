// SPDX-License-Identifier: Apache-2.0
// The default pattern: a lattice for any number of rays, whose shifts complement each other from texel to texel.
#include <vmlight/math/latlong.h>
#include <vmlight/math/lattice.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <vector>

using namespace vmlight;

namespace {

double share_of_one(uint32_t x)
{
    return x * 0x1p-32;
}

// P2 by its definition, cut off: over the dual lattice, 1 / max(1, h)^2 for each coordinate.
double merit_by_series(int64_t count, int64_t generator)
{
    constexpr int kMost = 200;
    double sum = -1;
    for (int h = -kMost; h <= kMost; ++h)
        for (int k = -kMost; k <= kMost; ++k)
            if ((h + k * generator) % count == 0)
                sum += 1.0 / (std::pow(std::max(1, std::abs(h)), 2) * std::pow(std::max(1, std::abs(k)), 2));
    return sum;
}

// Of a line across the disc: how much of the disc lies on its side x cos(turn) + y sin(turn) < height.
struct Chord
{
    double height, turn;

    double share() const { return 1 - (std::acos(height) - height * std::sqrt(1 - height * height)) / latlong::pi; }

    double error(const Lattice& lattice, Point32 shift) const
    {
        int below = 0;
        for (uint32_t i = 0; i < lattice.count(); ++i) {
            const Point32 p = lattice.point(i);
            const double radius = std::sqrt(share_of_one(p.u + shift.u)),
                         angle = 2 * latlong::pi * share_of_one(p.v + shift.v);
            below += radius * std::cos(angle - turn) < height;
        }
        return double(below) / lattice.count() - share();
    }
};

std::vector<Chord> chords(int count)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> height(-0.8, 0.8), turn(0, 2 * latlong::pi);
    std::vector<Chord> all;
    for (int k = 0; k < count; ++k)
        all.push_back({ height(random), turn(random) });
    return all;
}

} // namespace

TEST(Lattice, PointsAreAGroupOnTheTorusForAnyCount)
{
    for (uint32_t count : { 1u, 2u, 3u, 6u, 16u, 34u, 91u, 100u, 128u, 4181u }) {
        const Lattice lattice(count);
        const auto near_zero = [](uint32_t x) { return std::min(x, -x) < 4; }; // rounded down to 2^-32
        for (uint32_t i = 0; i < count; ++i) {
            EXPECT_NEAR(share_of_one(lattice.point(i).u), double(i) / count, 1e-9);
            const uint32_t j = i * 7u % count;
            const Point32 a = lattice.point(i), b = lattice.point(j), both = lattice.point((i + j) % count);
            ASSERT_TRUE(near_zero(a.u + b.u - both.u) && near_zero(a.v + b.v - both.v)) << count << " " << i;
        }
    }
}

TEST(Lattice, NoGeneratorIsBetter)
{
    for (int64_t count : { 8, 12, 16, 22, 34, 55, 64 }) {
        const double merit = merit_by_series(count, Lattice(uint32_t(count)).generator());
        for (int64_t generator = 1; generator < count; ++generator)
            EXPECT_LT(merit, merit_by_series(count, generator) * (1 + 1e-4)) << count << " " << generator;
    }
}

TEST(Lattice, EachTexelsShiftIsEvenOverTheCell)
{
    // The mean over texels of what a lattice finds is the integral, for each chord; and texels differ.
    for (uint32_t count : { 1u, 5u, 16u, 64u }) {
        const Lattice lattice(count);
        std::set<uint64_t> shifts;
        for (const Chord& chord : chords(4)) {
            double sum = 0, squares = 0;
            for (uint32_t y = 0; y < 64; ++y)
                for (uint32_t x = 0; x < 64; ++x) {
                    const Point32 shift = lattice.shift(x, y, 5);
                    shifts.insert(uint64_t(shift.u) << 32 | shift.v);
                    const double error = chord.error(lattice, shift);
                    sum += error, squares += error * error;
                }
            EXPECT_LT(std::abs(sum / 4096), 3 * std::sqrt(squares / 4096) / 64) << count;
        }
        EXPECT_EQ(shifts.size(), 4096u) << count;
    }
}

// Windows as reconstruction weighs them: a Gaussian of two texels, 7x7.
TEST(Lattice, NeighboursComplementEachOther)
{
    double product = 1;
    const std::vector<uint32_t> counts { 4, 8, 11, 16, 22, 32, 45, 64, 91, 128 };
    for (const uint32_t count : counts) {
        const Lattice lattice(count);
        uint32_t seed = 0;
        double own = 0, alike = 0, independent = 0, texels = 0, windows = 0;
        for (const Chord& chord : chords(60))
            for (int run = 0; run < 3; ++run, ++seed) {
                double weights = 0, sum = 0, other = 0;
                for (uint32_t y = 0; y < 7; ++y)
                    for (uint32_t x = 0; x < 7; ++x) {
                        const double weight = std::exp(-(std::pow(x - 3.0, 2) + std::pow(y - 3.0, 2)) / 8);
                        const double error = chord.error(lattice, lattice.shift(100 + x, 50 + y, seed));
                        sum += weight * error;
                        other += weight * chord.error(lattice, texel_hash(x, y, seed));
                        weights += weight;
                        own += error * error, ++texels;
                    }
                alike += std::pow(sum / weights, 2);
                independent += std::pow(other / weights, 2);
                ++windows;
            }
        EXPECT_GT(std::sqrt(own / texels), 3.5 * std::sqrt(independent / windows)) << count;
        EXPECT_LT(std::sqrt(alike), 0.85 * std::sqrt(independent)) << count;
        product *= alike / independent;
    }
    EXPECT_LT(std::pow(product, 0.5 / double(counts.size())), 0.65);
}
