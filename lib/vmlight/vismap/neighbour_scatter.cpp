// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/neighbour_scatter.h>

#include <vmlight/vismap/neighbour_weights.h>

#include <algorithm>
#include <array>

namespace vmlight {
namespace {

using Window = NeighbourWindow;

// As far as the texels that are added around a tile.
constexpr int kRadius = Window::kHalo;

// How many times the expected variance is even, and is not. Measured on ten meshes at 256x256 texels and three at
// 1024x1024: up to 8 no 99th percentile and hardly a worst texel becomes worse; below it the smooth parts of large maps
// gain less.
constexpr double kEven = 1.5, kUneven = 8;

// Of texels: how many, the sums of V and B', of their squares, and of the variances.
enum Sum
{
    kCount,
    kVisibility,
    kX,
    kY,
    kZ,
    kSquares,
    kVariance,
    kSums
};
using SumRow = std::array<double, kTileSize>; // double: the variance is the small rest of large squares
using Sums = std::array<SumRow, kSums>;

void add(Sums& sums, const Window& window, size_t first)
{
    for (size_t x = 0; x < kTileSize; ++x) {
        const size_t i = first + x;
        const std::array<double, 4> parts { double(window.visibility[i]), double(window.x[i]), double(window.y[i]),
                                            double(window.z[i]) };
        sums[kCount][x] += window.spacing[i] > 0 ? 1 : 0;
        sums[kVariance][x] += double(window.variance[i]);
        for (size_t c = 0; c < 4; ++c) {
            sums[kVisibility + c][x] += parts[c];
            sums[kSquares][x] += parts[c] * parts[c];
        }
    }
}

float evenness_of(const std::array<double, kSums>& sum)
{
    if (sum[kCount] < 2 || !(sum[kVariance] > 0))
        return 0;
    double scatter = sum[kSquares];
    for (size_t c = kVisibility; c <= kZ; ++c)
        scatter -= sum[c] * sum[c] / sum[kCount];
    const double expected = double(kVarianceOfBoth) * sum[kVariance] * (sum[kCount] - 1) / sum[kCount];
    return float(std::clamp((kUneven - scatter / expected) / (kUneven - kEven), 0.0, 1.0));
}

} // namespace

void find_evenness(const Window& window, std::vector<float>& evenness)
{
    evenness.resize(size_t(kTileSize) * kTileSize);
    std::vector<Sums> rows(size_t(kTileSize + 2 * kRadius), Sums {});
    for (int y = -kRadius; y < kTileSize + kRadius; ++y)
        for (int x = -kRadius; x <= kRadius; ++x)
            add(rows[size_t(y + kRadius)], window, Window::index(x, y));
    for (size_t y = 0; y < kTileSize; ++y) {
        Sums sums {};
        for (size_t row = y; row <= y + 2 * kRadius; ++row)
            for (size_t k = 0; k < kSums; ++k)
                for (size_t x = 0; x < kTileSize; ++x)
                    sums[k][x] += rows[row][k][x];
        for (size_t x = 0; x < kTileSize; ++x) {
            std::array<double, kSums> all;
            for (size_t k = 0; k < kSums; ++k)
                all[k] = sums[k][x];
            evenness[y * kTileSize + x] = evenness_of(all);
        }
    }
}

} // namespace vmlight
