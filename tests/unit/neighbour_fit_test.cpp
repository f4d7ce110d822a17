// SPDX-License-Identifier: Apache-2.0
// Where texels scatter by chance alone, where on a slope, and where by more.
#include <vmlight/vismap/neighbour_fit.h>
#include <vmlight/vismap/neighbour_means.h>
#include <vmlight/vismap/neighbour_weights.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>
#include <utility>

using namespace vmlight;

namespace {

constexpr int kHalo = NeighbourWindow::kHalo, kReach = NeighbourWindow::kReach;
constexpr double kDeviation = 0.02;

void each_texel(const std::function<void(int x, int y)>& visit)
{
    for (int y = -kHalo; y < kTileSize + kHalo; ++y)
        for (int x = -kHalo; x < kTileSize + kHalo; ++x)
            visit(x, y);
}

// Noise of the variance that is said, on what visibility(x, y) is.
NeighbourWindow noisy(const std::function<double(int x, int y)>& visibility)
{
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0, kDeviation);
    NeighbourWindow window;
    each_texel([&](int x, int y) {
        const size_t i = NeighbourWindow::index(x, y);
        window.values[0][i] = float(visibility(x, y) + noise(random));
        for (size_t c = 1; c < 4; ++c)
            window.values[c][i] = float(std::sqrt(5.0 / 27) * noise(random));
        window.variance[i] = float(kDeviation * kDeviation);
        window.normal[2][i] = 1;
        window.position[0][i] = float(x);
        window.position[1][i] = float(y);
        window.spacing[i] = 1;
    });
    return window;
}

NeighbourWindow fitted(NeighbourWindow window)
{
    fit_neighbours(window);
    return window;
}

NeighbourWindow fitted(const std::function<double(int x, int y)>& visibility)
{
    return fitted(noisy(visibility));
}

size_t texel(int x, int y)
{
    return size_t(y) * kTileSize + size_t(x);
}

double mean_of(const std::vector<float>& values)
{
    return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

// What covers columns from `first` on is taken away.
NeighbourWindow without_columns_from(int first, NeighbourWindow window)
{
    each_texel([&](int x, int y) {
        if (x < first)
            return;
        for (NeighbourWindow::Plane& plane : window.values)
            plane[NeighbourWindow::index(x, y)] = 0;
        window.variance[NeighbourWindow::index(x, y)] = window.spacing[NeighbourWindow::index(x, y)] = 0;
    });
    return window;
}

// Of the tile, the columns from `first` to `last`: the mean of V less what it is.
double mean_error(const NeighbourWindow& window, int first, int last, const std::function<double(int, int)>& visibility)
{
    std::vector<float> change(NeighbourWindow::kTexels);
    mean_change(window, window.values[0].data(), change.data());
    double sum = 0;
    for (int y = 0; y < kTileSize; ++y)
        for (int x = first; x <= last; ++x)
            sum += double(window.values[0][NeighbourWindow::index(x, y)]) + double(change[texel(x, y)])
                - visibility(x, y);
    return sum / kTileSize / (last - first + 1);
}

} // namespace

TEST(NeighbourFit, ChanceAloneIsEven)
{
    for (const double visibility : { 0.6, 1000.0 }) // large values lose no digits
        EXPECT_NEAR(mean_of(fitted([&](int, int) { return visibility; }).fit.evenness), 1, 0.001) << visibility;
}

TEST(NeighbourFit, ASlopeIsFoundAndScattersNoMore)
{
    const NeighbourWindow window = fitted([](int x, int y) { return 0.2 + 0.05 * x - 0.02 * y; });
    EXPECT_TRUE(window.fit.is_sloped);
    EXPECT_NEAR(mean_of(window.fit.evenness), 1, 0.01);
    // What noise could explain is not kept, here up to some per cent.
    EXPECT_NEAR(mean_of(window.fit.slopes[0][0]), 0.05, 0.002);
    EXPECT_NEAR(mean_of(window.fit.slopes[1][0]), -0.02, 0.001);
}

TEST(NeighbourFit, AnEdgeIsUnevenAsFarAsNeighboursReachAndNoSlope)
{
    const NeighbourWindow window = fitted([](int x, int) { return x < 30 ? 0.3 : 0.8; });
    for (int y = 0; y < kTileSize; ++y)
        for (int x = 0; x < kTileSize; ++x) {
            const bool reaches = x >= 30 - kReach && x < 30 + kReach;
            if (reaches && (x == 30 - kReach || x == 30 + kReach - 1))
                continue; // one column of seven is on the other side
            ASSERT_NEAR(window.fit.evenness[texel(x, y)], reaches ? 0 : 1, reaches ? 0 : 0.1) << x << " " << y;
            ASSERT_TRUE(!reaches || window.fit.slopes[0][0][texel(x, y)] == 0) << x << " " << y;
        }
}

TEST(NeighbourFit, WhatNoTriangleCoversDoesNotCount)
{
    const auto ramp = [](int x, int) { return 0.2 + 0.05 * x; };
    const NeighbourWindow window = fitted(without_columns_from(20, noisy(ramp)));
    EXPECT_GT(window.fit.evenness[texel(19, 30)], 0.8);
    EXPECT_NEAR(window.fit.slopes[0][0][texel(19, 30)], 0.05, 0.02) << "half of the neighbours are there";
    EXPECT_EQ(window.fit.slopes[0][0][texel(24, 30)], 0) << "nothing is there";
}

TEST(NeighbourFit, NeighboursOnOneLineTellNothingAcrossIt)
{
    NeighbourWindow window = noisy([](int x, int y) { return 0.2 + 0.05 * (x + y); });
    each_texel([&](int x, int y) {
        if (x != y)
            window.spacing[NeighbourWindow::index(x, y)] = 0;
    });
    window = fitted(std::move(window));
    for (int i = 0; i < kTileSize; ++i)
        for (const auto& slopes : window.fit.slopes) {
            ASSERT_TRUE(std::isfinite(slopes[0][texel(i, i)])) << i;
            ASSERT_NEAR(slopes[0][texel(i, i)], 0.05, 0.03) << i;
        }
}

TEST(NeighbourFit, RaysThatAllAgreeLeaveNothingToCompareWith)
{
    NeighbourWindow window = noisy([](int, int) { return 0.6; });
    std::fill(window.variance.begin(), window.variance.end(), 0.0f);
    window = fitted(std::move(window));
    EXPECT_EQ(*std::max_element(window.fit.evenness.begin(), window.fit.evenness.end()), 0);
    EXPECT_FALSE(window.fit.is_sloped);
}

TEST(NeighbourWeights, TheyAreThoseOfAMean)
{
    for (const double slope : { 0.0, 0.03 }) {
        NeighbourWindow window = noisy([&](int x, int) { return 0.2 + slope * x; });
        weigh_neighbours(window);
        for (size_t i = 0; i < NeighbourWindow::kTexels; ++i) {
            double sum = double(window.own_weight[i]);
            for (int number = 0; number < NeighbourWindow::kNeighbours; ++number)
                sum += double(window.weights[NeighbourWindow::weight(number, i)]);
            ASSERT_NEAR(sum, 1, 1e-5) << slope;
        }
    }
}

TEST(NeighbourWeights, ASlopeIsFollowedToTheBorderOfAnIsland)
{
    // The mean of neighbours on one side alone is off by the slope times more than a texel, .05; a fifth of that may
    // remain, since what noise could explain of the slope is not kept.
    const auto ramp = [](int x, int) { return 0.2 + 0.04 * x; };
    NeighbourWindow window = without_columns_from(40, noisy(ramp));
    weigh_neighbours(window);
    EXPECT_NEAR(mean_error(window, 39, 39, ramp), 0, 0.01);
    EXPECT_NEAR(mean_error(window, 3, 35, ramp), 0, 0.001);
    // A mean along a slope is still one of many texels: less than a third of the noise remains.
    std::vector<float> variance(NeighbourWindow::kTexels);
    mean_variance(window, variance.data());
    EXPECT_LT(variance[texel(20, 30)], kDeviation * kDeviation / 9);
}

// Each neighbour and the opposite one are compared together. In the turned window sums run the other way round: slopes
// and the fourth power of a difference enlarge their rounding.
TEST(NeighbourWeights, ATurnedWindowHasTheTurnedWeights)
{
    // A flat half, a ramp, a step and an island's end.
    NeighbourWindow window = without_columns_from(
        55, noisy([](int x, int y) { return x < 20 ? 0.4 : 0.4 + 0.03 * (x - 20) + (y < 30 ? 0.2 : 0.0); }));
    NeighbourWindow turned;
    const auto there = [](int x, int y) { return NeighbourWindow::index(kTileSize - 1 - x, kTileSize - 1 - y); };
    each_texel([&](int x, int y) {
        const size_t i = NeighbourWindow::index(x, y), j = there(x, y);
        for (size_t c = 0; c < 4; ++c)
            turned.values[c][j] = window.values[c][i];
        for (size_t c = 0; c < 3; ++c) {
            turned.normal[c][j] = window.normal[c][i];
            turned.position[c][j] = window.position[c][i];
        }
        turned.variance[j] = window.variance[i];
        turned.spacing[j] = window.spacing[i];
    });
    weigh_neighbours(window);
    weigh_neighbours(turned);
    for (size_t i = 0; i < NeighbourWindow::kTexels; ++i)
        for (int number = 0; number < NeighbourWindow::kNeighbours; ++number)
            ASSERT_NEAR(window.weights[NeighbourWindow::weight(number, i)],
                        turned.weights[NeighbourWindow::weight(NeighbourWindow::kNeighbours - 1 - number,
                                                               NeighbourWindow::kTexels - 1 - i)],
                        2e-4)
                << number << " of " << i;
}

TEST(NeighbourWeights, TexelsThatAreNotWantedChangeNoOther)
{
    const NeighbourWindow empty = noisy([](int x, int y) { return 0.3 + 0.01 * x + (y > 40 ? 0.1 : 0.0); });
    NeighbourWindow all = empty, some = empty;
    for (int y = 0; y < kTileSize; ++y) // single texels, and runs that begin and end anywhere
        some.wanted[size_t(y)] = y % 7 == 3 ? uint64_t(1) << (y * 5 % 64)
            : y % 3 == 0                    ? uint64_t(0x00ffe00000000038)
                                            : 0;
    weigh_neighbours(all);
    weigh_neighbours(some);
    for (int y = 0; y < kTileSize; ++y)
        for (int x = 0; x < kTileSize; ++x) {
            if (!(some.wanted[size_t(y)] >> x & 1))
                continue;
            ASSERT_EQ(all.own_weight[texel(x, y)], some.own_weight[texel(x, y)]) << x << " " << y;
            for (int number = 0; number < NeighbourWindow::kNeighbours; ++number)
                ASSERT_EQ(all.weights[NeighbourWindow::weight(number, texel(x, y))],
                          some.weights[NeighbourWindow::weight(number, texel(x, y))])
                    << number << " of " << x << " " << y;
        }
}
