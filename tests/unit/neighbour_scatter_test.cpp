// SPDX-License-Identifier: Apache-2.0
// Where texels scatter by chance alone, and where by more.
#include <vmlight/vismap/neighbour_scatter.h>
#include <vmlight/vismap/neighbour_weights.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>

using namespace vmlight;

namespace {

constexpr int kHalo = NeighbourWindow::kHalo;
constexpr double kDeviation = 0.02;

// Noise of the variance that is said, on what visibility(x, y) is.
NeighbourWindow noisy(const std::function<double(int x, int y)>& visibility)
{
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0, kDeviation);
    NeighbourWindow window;
    for (int y = -kHalo; y < kTileSize + kHalo; ++y)
        for (int x = -kHalo; x < kTileSize + kHalo; ++x) {
            const size_t i = NeighbourWindow::index(x, y);
            window.visibility[i] = float(visibility(x, y) + noise(random));
            for (NeighbourWindow::Plane* plane : { &window.x, &window.y, &window.z })
                (*plane)[i] = float(std::sqrt(5.0 / 27) * noise(random));
            window.variance[i] = float(kDeviation * kDeviation);
            window.spacing[i] = 1;
        }
    return window;
}

std::vector<float> evenness_of(const NeighbourWindow& window)
{
    std::vector<float> evenness;
    find_evenness(window, evenness);
    return evenness;
}

float evenness_at(const std::vector<float>& evenness, int x, int y)
{
    return evenness[size_t(y) * kTileSize + size_t(x)];
}

} // namespace

TEST(NeighbourScatter, ChanceAloneIsEven)
{
    const std::vector<float> evenness = evenness_of(noisy([](int, int) { return 0.6; }));
    EXPECT_EQ(*std::min_element(evenness.begin(), evenness.end()), 1);
    EXPECT_EQ(*std::min_element(evenness.begin(), evenness.end()),
              evenness_at(evenness_of(noisy([](int, int) { return 1000; })), 9, 9))
        << "large values lose no digits";
}

TEST(NeighbourScatter, AnEdgeIsUnevenAsFarAsAWindowReaches)
{
    const std::vector<float> evenness = evenness_of(noisy([](int x, int) { return x < 30 ? 0.3 : 0.6; }));
    for (int y = 0; y < kTileSize; ++y)
        for (int x = 0; x < kTileSize; ++x) {
            // Beside the edge a ninth of the texels are on its other side: their scatter is 1/9 x 8/9 of the step
            // squared, which is 14 times what chance explains.
            const bool reaches = x >= 30 - kHalo && x < 30 + kHalo;
            ASSERT_EQ(evenness_at(evenness, x, y), reaches ? 0 : 1) << x << " " << y;
        }
}

TEST(NeighbourScatter, WhatNoTriangleCoversDoesNotCount)
{
    NeighbourWindow window = noisy([](int, int) { return 0.6; });
    for (int y = -kHalo; y < kTileSize + kHalo; ++y)
        for (int x = 20; x < kTileSize + kHalo; ++x) {
            const size_t i = NeighbourWindow::index(x, y);
            for (NeighbourWindow::Plane* plane :
                 { &window.visibility, &window.x, &window.y, &window.z, &window.variance, &window.spacing })
                (*plane)[i] = 0;
        }
    const std::vector<float> evenness = evenness_of(window);
    EXPECT_EQ(evenness_at(evenness, 19, 30), 1);
    EXPECT_EQ(evenness_at(evenness, 24, 30), 0) << "nothing is there";
    EXPECT_EQ(evenness_at(evenness, 60, 30), 0);
}

TEST(NeighbourScatter, RaysThatAllAgreeLeaveNothingToCompareWith)
{
    NeighbourWindow window = noisy([](int, int) { return 0.6; });
    std::fill(window.variance.begin(), window.variance.end(), 0.0f);
    const std::vector<float> evenness = evenness_of(window);
    EXPECT_EQ(*std::max_element(evenness.begin(), evenness.end()), 0);
}
