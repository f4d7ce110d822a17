// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/neighbour_weights.h>

#include <vmlight/vismap/neighbour_fit.h>

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vmlight/vismap/neighbour_weights.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <vmlight/vismap/neighbour_near-inl.h>

#ifndef VMLIGHT_NEIGHBOUR_WEIGHTS
#define VMLIGHT_NEIGHBOUR_WEIGHTS
namespace vmlight::kernel {

// By how much more than by chance patches may differ, squared, in what they differ by chance; and two texels alone: by
// chance they hardly ever do, and a patch around both may hide it.
struct Tolerance
{
    float patch, alone;
};
// Where texels scatter. Measured: below 1.2 squared less is gained, from 1.4 squared on single texels near edges become
// worse.
constexpr Tolerance kWhereScattered { 1.25f * 1.25f, 10 };
// Where they do not: nearly all weights are those of distance and surface.
constexpr Tolerance kWhereEven { 2 * 2, 40 };
constexpr float kPatchTexels = (2 * NeighbourWindow::kPatch + 1) * (2 * NeighbourWindow::kPatch + 1);
// What is summed over patches: of two texels, how different they are, squared, how different they may be by chance, 1
// if they are near on the surface, and the differences.
enum Sum
{
    kSquares,
    kExpected,
    kCount,
    kDifferences,
    kSums = kDifferences + 4
};
// Of the texels that patches reach, at index(): of one row texel by texel, and of all rows over three columns.
struct PatchRows
{
    PatchRows()
    {
        line.fill(std::vector<float>(NeighbourWindow::kStride));
        sums.fill(std::vector<float>(size_t(NeighbourWindow::kSide) * NeighbourWindow::kStride));
    }
    std::array<std::vector<float>, kSums> line, sums;
};

} // namespace vmlight::kernel
#endif

HWY_BEFORE_NAMESPACE();
namespace vmlight::kernel {
namespace HWY_NAMESPACE {

HWY_INLINE void add(TexelVec value, std::vector<float>& plane, size_t at)
{
    hn::StoreU(hn::Add(load(plane, at), value), TexelTag(), plane.data() + at);
}

// One row of each sum: of each texel and its neighbour, then over columns; for the patches of texels with this
// neighbour, and for those of the neighbour's, of which each texel is the opposite one.
template <bool kSloped> HWY_INLINE void compare_row(const Window& window, Window::Offset to, int y, PatchRows& rows)
{
    const TexelTag d;
    const int lanes = int(hn::Lanes(d));
    constexpr int kPatch = Window::kPatch, kHalo = Window::kHalo;
    const auto both = hn::Set(d, kVarianceOfBoth), zero = hn::Zero(d);
    // Whose patches have a texel of this row.
    const auto wanted_around = [&](int middle) {
        uint64_t wanted = 0;
        for (int row = std::max(0, middle - kPatch); row <= std::min(kTileSize - 1, middle + kPatch); ++row)
            wanted |= window.wanted[size_t(row)];
        return wanted;
    };
    const uint64_t wanted = wanted_around(y), wanted_there = wanted_around(y + to.y);
    if (wanted == 0 && wanted_there == 0)
        return;
    constexpr size_t kRead = kSloped ? kSums : kCount; // of the sums
    const int first = std::min(0, -to.x), last = std::max(kTileSize, kTileSize - to.x);
    for (int x = first - kPatch; x < last + kPatch; x += lanes) {
        if (!wants_any(wanted, x - kPatch, x + lanes - 1 + kPatch)
            && !wants_any(wanted_there, x + to.x - kPatch, x + to.x + lanes - 1 + kPatch))
            continue;
        const size_t i = Window::index(x, y), j = Window::index(x + to.x, y + to.y);
        auto facing = zero, difference = zero;
        const auto kept = are_near(window, i, j, to, facing);
        if (hn::AllFalse(d, kept)) {
            for (size_t sum = 0; sum < kRead; ++sum)
                hn::StoreU(zero, d, rows.line[sum].data() + x + kHalo);
            continue;
        }
        for (size_t c = 0; c < 4; ++c) {
            const auto value = hn::IfThenElseZero(kept, hn::Sub(load(window.values[c], j), load(window.values[c], i)));
            difference = hn::Add(difference, square(value));
            if (kSloped)
                hn::StoreU(value, d, rows.line[kDifferences + c].data() + x + kHalo);
        }
        const auto expected = hn::Mul(both, hn::Add(load(window.variance, i), load(window.variance, j)));
        hn::StoreU(difference, d, rows.line[kSquares].data() + x + kHalo);
        hn::StoreU(hn::IfThenElseZero(kept, expected), d, rows.line[kExpected].data() + x + kHalo);
        if (kSloped)
            hn::StoreU(hn::IfThenElseZero(kept, hn::Set(d, 1.0f)), d, rows.line[kCount].data() + x + kHalo);
    }
    for (size_t sum = 0; sum < kRead; ++sum)
        for (int x = first; x < last; x += lanes) {
            const float* from = rows.line[sum].data() + x + kHalo;
            const auto across = hn::Add(hn::Add(hn::LoadU(d, from - 1), hn::LoadU(d, from)), hn::LoadU(d, from + 1));
            hn::StoreU(across, d, rows.sums[sum].data() + Window::index(x, y));
        }
}

HWY_INLINE TexelVec patch_sum(const std::vector<float>& sums, size_t at)
{
    const TexelTag d;
    const float* row = sums.data() + at;
    return hn::Add(hn::Add(hn::LoadU(d, row - Window::kStride), hn::LoadU(d, row)),
                   hn::LoadU(d, row + Window::kStride));
}

// Whether any of the texels has a slope.
HWY_INLINE bool are_sloped(const Window& window, size_t texel)
{
    return !hn::AllTrue(TexelTag(), hn::Eq(load(window.fit.xx, texel), hn::Zero(TexelTag())));
}

// Set the weights of neighbour `number` by how alike it is, and add them to their sum, and with its steps. The rows are
// those of this neighbour, or of the opposite one: its patches are the same pairs, of which each is the other one's.
template <bool kSloped>
HWY_INLINE void weigh_neighbour(Window& window, int number, bool is_opposite, const PatchRows& rows,
                                std::array<std::vector<float>, 2>& steps)
{
    const TexelTag d;
    const auto one = hn::Set(d, 1.0f), zero = hn::Zero(d), least = hn::Set(d, 1e-30f);
    const auto twice_signed = hn::Set(d, is_opposite ? -2.0f : 2.0f);
    const Window::Offset to = Window::neighbour(number);
    const auto step_x = hn::Set(d, float(to.x)), step_y = hn::Set(d, float(to.y));
    for (int y = 0; y < kTileSize; ++y)
        for (int x = 0; x < kTileSize; x += int(hn::Lanes(d))) {
            if (!wants_any(window.wanted[size_t(y)], x, x + int(hn::Lanes(d)) - 1))
                continue;
            const size_t texel = size_t(y) * kTileSize + size_t(x), at = Window::weight(number, texel);
            const size_t i = Window::index(x, y), j = Window::index(x + to.x, y + to.y);
            const size_t patch = is_opposite ? j : i;
            const auto nearness = load(window.fit.nearness, at);
            if (hn::AllTrue(d, hn::Eq(nearness, zero))) { // most, where islands are small
                hn::StoreU(zero, d, window.weights.data() + at);
                continue;
            }
            const bool is_sloped = kSloped && are_sloped(window, texel);
            const auto even = load(window.fit.evenness, texel);
            const auto between = [&](float scattered, float is_even) {
                return hn::Add(hn::Set(d, scattered), hn::Mul(even, hn::Set(d, is_even - scattered)));
            };
            const auto expected = patch_sum(rows.sums[kExpected], patch);
            auto difference = patch_sum(rows.sums[kSquares], patch), alone = zero;
            for (size_t c = 0; c < 4; ++c) {
                auto value = hn::Sub(load(window.values[c], j), load(window.values[c], i));
                if (is_sloped) { // less what the slope explains
                    const auto slope = hn::Add(hn::Mul(step_x, load(window.fit.slopes[0][c], texel)),
                                               hn::Mul(step_y, load(window.fit.slopes[1][c], texel)));
                    const auto twice = hn::Mul(twice_signed, patch_sum(rows.sums[kDifferences + c], patch));
                    const auto all = hn::Mul(slope, patch_sum(rows.sums[kCount], patch));
                    difference = hn::Add(difference, hn::Mul(slope, hn::Sub(all, twice)));
                    value = hn::Sub(value, slope);
                }
                alone = hn::Add(alone, square(value));
            }
            const auto beyond = hn::Max(zero, hn::Sub(difference, expected));
            // (1 - x / 4)^4: exp(-x) to within .06, and exactly 0 from x = 4 on.
            const auto tolerance = between(4 * kWhereScattered.patch, 4 * kWhereEven.patch);
            const auto quarter = hn::Div(beyond, hn::Max(hn::Mul(expected, tolerance), least));
            // Of a few rays that agree by chance the scatter is 0: that of the patches tells more.
            const auto is_alike = hn::Le(hn::Mul(alone, hn::Set(d, kPatchTexels)),
                                         hn::Mul(expected, between(kWhereScattered.alone, kWhereEven.alone)));
            const auto alike = hn::IfThenElseZero(is_alike, square(square(hn::Max(zero, hn::Sub(one, quarter)))));
            const auto weight = hn::Mul(alike, nearness);
            hn::StoreU(weight, d, window.weights.data() + at);
            add(weight, window.own_weight, texel);
            if (is_sloped) {
                add(hn::Mul(weight, step_x), steps[0], texel);
                add(hn::Mul(weight, step_y), steps[1], texel);
            }
        }
}

// Make the weights those of a mean: their sum 1, and what they take along the slope taken back.
HWY_INLINE void normalise(Window& window, std::array<std::vector<float>, 2>& steps)
{
    const TexelTag d;
    const auto one = hn::Set(d, 1.0f);
    for (size_t texel = 0; texel < Window::kTexels; texel += hn::Lanes(d)) {
        if (!wants_any(window.wanted[texel / kTileSize], int(texel % kTileSize),
                       int(texel % kTileSize + hn::Lanes(d)) - 1))
            continue;
        const auto scale = hn::Div(one, load(window.own_weight, texel));
        auto own = one;
        const bool is_sloped = window.fit.is_sloped && are_sloped(window, texel);
        const auto x = hn::Mul(load(steps[0], texel), scale), y = hn::Mul(load(steps[1], texel), scale);
        const auto by_x = hn::Add(hn::Mul(load(window.fit.xx, texel), x), hn::Mul(load(window.fit.xy, texel), y));
        const auto by_y = hn::Add(hn::Mul(load(window.fit.xy, texel), x), hn::Mul(load(window.fit.yy, texel), y));
        const auto from
            = hn::Add(hn::Mul(by_x, load(window.fit.middle_x, texel)), hn::Mul(by_y, load(window.fit.middle_y, texel)));
        for (int number = 0; number < Window::kNeighbours; ++number) {
            const Window::Offset to = Window::neighbour(number);
            const size_t at = Window::weight(number, texel);
            auto weight = hn::Mul(load(window.weights, at), scale);
            if (is_sloped) {
                const auto along
                    = hn::Add(hn::Mul(by_x, hn::Set(d, float(to.x))), hn::Mul(by_y, hn::Set(d, float(to.y))));
                weight = hn::Sub(weight, hn::Mul(load(window.fit.nearness, at), hn::Sub(along, from)));
            }
            hn::StoreU(weight, d, window.weights.data() + at);
            own = hn::Sub(own, weight);
        }
        hn::StoreU(own, d, window.own_weight.data() + texel);
    }
}

template <bool kSloped> HWY_INLINE void weigh_all(Window& window, std::array<std::vector<float>, 2>& steps)
{
    PatchRows rows;
    for (int number = Window::kNeighbours / 2; number < Window::kNeighbours; ++number) { // those below and to the right
        const Window::Offset to = Window::neighbour(number);
        for (int y = -Window::kPatch - to.y; y < kTileSize + Window::kPatch; ++y)
            compare_row<kSloped>(window, to, y, rows);
        weigh_neighbour<kSloped>(window, number, false, rows, steps);
        weigh_neighbour<kSloped>(window, Window::kNeighbours - 1 - number, true, rows, steps);
    }
}

void weigh_neighbours_target(Window& window)
{
    std::array<std::vector<float>, 2> steps;
    steps.fill(std::vector<float>(Window::kTexels));
    std::fill(window.own_weight.begin(), window.own_weight.end(), 1.0f);
    if (window.fit.is_sloped)
        weigh_all<true>(window, steps);
    else
        weigh_all<false>(window, steps);
    normalise(window, steps);
}

} // namespace HWY_NAMESPACE
} // namespace vmlight::kernel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vmlight {

namespace kernel {
HWY_EXPORT(weigh_neighbours_target);
} // namespace kernel

void weigh_neighbours(NeighbourWindow& window)
{
    fit_neighbours(window);
    HWY_DYNAMIC_DISPATCH(kernel::weigh_neighbours_target)(window);
}

} // namespace vmlight
#endif
