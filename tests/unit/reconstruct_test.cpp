// SPDX-License-Identifier: Apache-2.0
// What texels take from their neighbours, and what they keep.
#include "error_scenes.h"

#include <vmlight/vismap/neighbour_means.h>
#include <vmlight/vismap/neighbour_weights.h>
#include <vmlight/vismap/reconstruct.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <utility>
#include <vector>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

using Neighbours = NeighbourWindow;
constexpr size_t kTileTexels = size_t(kTileSize) * kTileSize;
// As pattern error: rays are as good as independent.
constexpr double kIndependent = 100;

// A flat tile whose texels are 1 apart, with visibility(x, y), and noise of that deviation.
void fill_window(Neighbours& window, double deviation, const std::function<double(int x, int y)>& visibility)
{
    std::mt19937 chance(5);
    std::normal_distribution<float> noise(0, 1);
    window.clear();
    for (int y = -Neighbours::kHalo; y < kTileSize + Neighbours::kHalo; ++y)
        for (int x = -Neighbours::kHalo; x < kTileSize + Neighbours::kHalo; ++x) {
            const size_t i = Neighbours::index(x, y);
            window.values[0][i] = float(visibility(x, y)) + float(deviation) * noise(chance);
            for (Neighbours::Plane* plane : { &window.values[1], &window.values[2], &window.values[3] })
                (*plane)[i] = float(deviation) * 0.43f * noise(chance);
            window.variance[i] = float(deviation * deviation);
            window.normal[2][i] = 1;
            window.position[0][i] = float(x);
            window.position[1][i] = float(y);
            window.spacing[i] = 1;
        }
}

std::vector<float> reconstructed(Neighbours& window)
{
    weigh_neighbours(window);
    std::vector<float> result(kTileTexels);
    mean_change(window, window.values[0].data(), result.data());
    for (int y = 0; y < kTileSize; ++y)
        for (int x = 0; x < kTileSize; ++x)
            result[size_t(y) * kTileSize + size_t(x)] += window.values[0][Neighbours::index(x, y)];
    return result;
}

// Mean error, and root mean square, of the columns from `left` to `right`.
std::pair<double, double> error_between(const std::vector<float>& found, int left, int right,
                                        const std::function<double(int x, int y)>& truth)
{
    double sum = 0, squares = 0, count = 0;
    for (int y = 0; y < kTileSize; ++y)
        for (int x = left; x < right; ++x) {
            const double error = double(found[size_t(y) * kTileSize + size_t(x)]) - truth(x, y);
            sum += error, squares += error * error, ++count;
        }
    return { sum / count, std::sqrt(squares / count) };
}

} // namespace

TEST(Reconstruct, AConstantStaysAsItIsToTheBit)
{
    Neighbours window;
    fill_window(window, 0, [](int, int) { return 0.3; });
    std::fill(window.variance.begin(), window.variance.end(), 1e-3f);
    weigh_neighbours(window);
    std::vector<float> change(kTileTexels, 1);
    mean_change(window, window.values[0].data(), change.data());
    EXPECT_EQ(change, std::vector<float>(kTileTexels, 0.0f));
    EXPECT_LT(window.own_weight[kTileTexels / 2], 0.1f) << "neighbours have weight";
}

TEST(Reconstruct, NoiseOnAConstantFalls)
{
    Neighbours window;
    const auto flat = [](int, int) { return 0.5; };
    fill_window(window, 0.02, flat);
    const auto [bias, rms] = error_between(reconstructed(window), 0, kTileSize, flat);
    EXPECT_LT(rms, 0.02 / 3);
    EXPECT_LT(std::abs(bias), 0.02 / 20);
}

TEST(Reconstruct, AStepKeepsItsHeightAndItsPlace)
{
    const auto step = [](int x, int) { return x < 30 ? 0.35 : 0.65; };
    const auto higher = [](int x, int) { return x < 30 ? 0.35 : 0.8; };
    Neighbours low, high;
    fill_window(low, 0.02, step);
    fill_window(high, 0.02, higher);
    const std::vector<float> found = reconstructed(low), beside = reconstructed(high);
    for (const auto& [left, right] : { std::pair(29, 30), { 30, 31 } }) {
        const auto [bias, rms] = error_between(found, left, right, step);
        EXPECT_LT(std::abs(bias), 3 * 0.02 / 8) << left; // chance, over 64 texels
        EXPECT_LT(rms, 0.02) << left;
    }
    for (int y = 0; y < kTileSize; ++y)
        for (int x = 0; x < 30; ++x)
            ASSERT_EQ(found[size_t(y) * kTileSize + size_t(x)], beside[size_t(y) * kTileSize + size_t(x)]) << x;
}

TEST(Reconstruct, ARampIsUnbiased)
{
    Neighbours window;
    const auto ramp = [](int x, int y) { return 0.2 + 0.004 * x + 0.002 * y; };
    fill_window(window, 0.02, ramp);
    const auto [bias, rms] = error_between(reconstructed(window), 0, kTileSize, ramp);
    EXPECT_LT(rms, 0.02 / 2.5);
    EXPECT_LT(std::abs(bias), 0.001);
}

TEST(Reconstruct, NothingPassesBetweenUnlikeSides)
{
    const auto flat = [](int, int) { return 0.5; };
    const std::pair<const char*, std::function<void(Neighbours&, size_t)>> apart[] = {
        { "facing away", [](Neighbours& window, size_t i) { window.normal[2][i] = -1; } },
        { "at right angles", [](Neighbours& window, size_t i) { window.normal[2][i] = 0, window.normal[0][i] = 1; } },
        { "another sheet", [](Neighbours& window, size_t i) { window.position[2][i] = 8; } },
        { "not covered", [](Neighbours& window, size_t i) { window.spacing[i] = 0; } },
    };
    for (const auto& [what, set_apart] : apart) {
        Neighbours window;
        fill_window(window, 0.02, flat);
        for (int y = -Neighbours::kHalo; y < kTileSize + Neighbours::kHalo; ++y)
            for (int x = 30; x < kTileSize + Neighbours::kHalo; ++x)
                set_apart(window, Neighbours::index(x, y));
        const std::vector<float> before = reconstructed(window);
        for (int y = -Neighbours::kHalo; y < kTileSize + Neighbours::kHalo; ++y)
            for (int x = 30; x < kTileSize + Neighbours::kHalo; ++x)
                window.values[0][Neighbours::index(x, y)] += 0.01f;
        const std::vector<float> after = reconstructed(window);
        for (int y = 0; y < kTileSize; ++y)
            for (int x = 0; x < 30; ++x)
                ASSERT_EQ(before[size_t(y) * kTileSize + size_t(x)], after[size_t(y) * kTileSize + size_t(x)]) << what;
    }
}

// Half of a floor has something above it, half has nothing.
TEST(Reconstruct, WhereNoRayAroundIsBlockedATexelStaysAsItIs)
{
    Reconstruction reconstruction(reconstruct_params(kTileSize, 16), kIndependent);
    TexelContexts contexts(0, 0, kTileSize, kTileSize);
    std::vector<float> raw(kTileTexels * 6, 0.0f);
    for (int y = 0; y < kTileSize; ++y)
        for (int x = 0; x < kTileSize; ++x) {
            float* texel = &raw[(size_t(y) * kTileSize + size_t(x)) * 6];
            const bool is_blocked = x >= 32;
            texel[0] = is_blocked ? 0.98f : 1;
            texel[3] = 2.0f / 3 * texel[0];
            contexts.at(x, y) = { V3f(float(x), float(y), 0), V3f(0, 0, 1), 1, is_blocked ? 1e-3f : 0, 0 };
            reconstruction.add(x, y, texel, contexts.at(x, y));
        }
    std::vector<float> texels = raw;
    EXPECT_EQ(reconstruction.apply(raw.data(), texels.data(), kTileSize * 6, 0, 0, contexts), 0);
    const auto visibility = [&](int x) { return texels[(30 * kTileSize + size_t(x)) * 6]; };
    for (int x = 0; x < 31; ++x)
        ASSERT_EQ(visibility(x), 1) << x;
    for (const int x : { 31, 32, 33 }) {
        EXPECT_LT(visibility(x), 1) << x;
        EXPECT_GT(visibility(x), 0.98f) << x;
    }
}

// One texel of a floor sees less than all around it, by so little that each patch may differ as much by chance. Its own
// rays limit how far the others move it.
TEST(Reconstruct, NoTexelMovesFartherThanItsOwnScatterExplains)
{
    constexpr double kDeviation = 0.02;
    const double limit = kDeviation * std::sqrt(4 * 14.0 / 9);
    for (const double below : { 1.0, 2.0, 3.5 }) {
        Reconstruction reconstruction(reconstruct_params(kTileSize, 16), kIndependent);
        TexelContexts contexts(0, 0, kTileSize, kTileSize);
        std::vector<float> raw(kTileTexels * 6, 0.0f);
        const size_t middle = (30 * kTileSize + 30) * 6;
        for (size_t i = 0; i < kTileTexels; ++i) {
            const int x = int(i % kTileSize), y = int(i / kTileSize);
            float* texel = &raw[i * 6];
            texel[0] = float(i * 6 == middle ? 0.5 - below * kDeviation : 0.5);
            texel[3] = 2.0f / 3 * texel[0];
            contexts.at(x, y) = { V3f(float(x), float(y), 0), V3f(0, 0, 1), 1, float(kDeviation * kDeviation), 0 };
            reconstruction.add(x, y, texel, contexts.at(x, y));
        }
        std::vector<float> texels = raw;
        reconstruction.apply(raw.data(), texels.data(), kTileSize * 6, 0, 0, contexts);
        const double moved = double(texels[middle]) - double(raw[middle]);
        if (below < 2.4)
            EXPECT_NEAR(moved, below * kDeviation, 0.1 * below * kDeviation) << below;
        else
            EXPECT_NEAR(moved, limit, 1e-6) << below;
    }
}
