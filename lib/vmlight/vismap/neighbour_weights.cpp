// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/neighbour_weights.h>

#include <vmlight/vismap/neighbour_scatter.h>

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vmlight/vismap/neighbour_weights.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef VMLIGHT_NEIGHBOUR_WEIGHTS
#define VMLIGHT_NEIGHBOUR_WEIGHTS
namespace vmlight::kernel {

// How much farther apart than UVs say two texels may be on the surface, squared.
constexpr float kStretch = 2.25f;
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
constexpr Tolerance kWhereEven { 2.5f * 2.5f, 40 };
constexpr float kPatchTexels = (2 * NeighbourWindow::kPatch + 1) * (2 * NeighbourWindow::kPatch + 1);
// Of the weight by distance, in texels.
constexpr float kSpread = 2;

} // namespace vmlight::kernel
#endif

HWY_BEFORE_NAMESPACE();
namespace vmlight::kernel {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Window = NeighbourWindow;
using WeightTag = hn::CappedTag<float, 8>;
using WeightVec = hn::Vec<WeightTag>;

HWY_INLINE WeightVec square(WeightVec v)
{
    return hn::Mul(v, v);
}

HWY_INLINE WeightVec load(const Window::Plane& plane, size_t at)
{
    return hn::LoadU(WeightTag(), plane.data() + at);
}

// Whether the tile wants a texel from `first` to `last` of a row.
HWY_INLINE bool wants(uint64_t row, int first, int last)
{
    first = first < 0 ? 0 : first;
    last = last < kTileSize ? last : kTileSize - 1;
    return first <= last && (row >> first & ~uint64_t(0) >> (kTileSize - 1 - last + first)) != 0;
}

// Of each texel that a patch of the tile reaches and its neighbour: how different they are, how different they may be
// by chance, and how near on the surface.
HWY_INLINE void compare(Window& window, Window::Offset to)
{
    const WeightTag d;
    // Over a square of texels. A step of one texel may be longer on the surface, where its triangles are stretched.
    const auto farthest = hn::Set(d, kStretch * float(to.x * to.x + to.y * to.y));
    const auto both = hn::Set(d, kVarianceOfBoth);
    const auto zero = hn::Zero(d);
    for (int y = -Window::kPatch; y < kTileSize + Window::kPatch; ++y) {
        uint64_t rows = 0; // whose patches have a texel of this row
        for (int row = std::max(0, y - Window::kPatch); row <= std::min(kTileSize - 1, y + Window::kPatch); ++row)
            rows |= window.wanted[size_t(row)];
        for (int x = -Window::kPatch; x < kTileSize + Window::kPatch; x += int(hn::Lanes(d))) {
            if (!wants(rows, x - Window::kPatch, x + int(hn::Lanes(d)) - 1 + Window::kPatch))
                continue;
            const size_t i = Window::index(x, y), j = Window::index(x + to.x, y + to.y);
            auto facing = zero, distance = zero;
            for (size_t c = 0; c < 3; ++c) {
                facing = hn::Add(facing, hn::Mul(load(window.normal[c], i), load(window.normal[c], j)));
                distance = hn::Add(distance, square(hn::Sub(load(window.position[c], i), load(window.position[c], j))));
            }
            const auto spacing = hn::Max(load(window.spacing, i), load(window.spacing, j));
            const auto exists = hn::And(hn::Gt(load(window.spacing, i), zero), hn::Gt(load(window.spacing, j), zero));
            const auto near = hn::And(hn::Le(distance, hn::Mul(square(spacing), farthest)), hn::Gt(facing, zero));
            const auto kept = hn::And(exists, near);
            const auto visibility = square(hn::Sub(load(window.visibility, i), load(window.visibility, j)));
            const auto direction = hn::Add(hn::Add(square(hn::Sub(load(window.x, i), load(window.x, j))),
                                                   square(hn::Sub(load(window.y, i), load(window.y, j)))),
                                           square(hn::Sub(load(window.z, i), load(window.z, j))));
            const auto difference = hn::Add(visibility, direction);
            const auto expected = hn::Mul(both, hn::Add(load(window.variance, i), load(window.variance, j)));
            hn::StoreU(hn::IfThenElseZero(kept, difference), d, window.scratch_difference.data() + i);
            hn::StoreU(hn::IfThenElseZero(kept, expected), d, window.scratch_expected.data() + i);
            hn::StoreU(hn::IfThenElseZero(kept, square(square(square(facing)))), d, window.scratch_surface.data() + i);
        }
    }
}

HWY_INLINE WeightVec patch_sum(const Window::Plane& plane, size_t at)
{
    auto sum = hn::Zero(WeightTag());
    for (int y = -Window::kPatch; y <= Window::kPatch; ++y)
        for (int x = -Window::kPatch; x <= Window::kPatch; ++x)
            sum = hn::Add(sum, load(plane, size_t(int64_t(at) + y * Window::kStride + x)));
    return sum;
}

void weigh_neighbours_target(Window& window)
{
    const WeightTag d;
    const auto one = hn::Set(d, 1.0f), zero = hn::Zero(d), least = hn::Set(d, 1e-30f);
    find_evenness(window, window.scratch_evenness);
    std::fill(window.scale.begin(), window.scale.end(), 1.0f);
    for (int number = 0; number < Window::kNeighbours; ++number) {
        const Window::Offset to = Window::neighbour(number);
        compare(window, to);
        const auto nearby = hn::Set(d, 1 - float(to.x * to.x + to.y * to.y) / (16 * kSpread * kSpread));
        const auto near = square(square(square(nearby)));
        float* weights = window.weights.data() + size_t(number) * kTileSize * kTileSize;
        for (int y = 0; y < kTileSize; ++y)
            for (int x = 0; x < kTileSize; x += int(hn::Lanes(d)), weights += hn::Lanes(d)) {
                if (!wants(window.wanted[size_t(y)], x, x + int(hn::Lanes(d)) - 1))
                    continue;
                const size_t i = Window::index(x, y);
                const auto even = hn::LoadU(d, window.scratch_evenness.data() + size_t(y) * kTileSize + size_t(x));
                const auto between = [&](float scattered, float is_even) {
                    return hn::Add(hn::Set(d, scattered), hn::Mul(even, hn::Set(d, is_even - scattered)));
                };
                const auto expected = patch_sum(window.scratch_expected, i);
                const auto beyond = hn::Max(zero, hn::Sub(patch_sum(window.scratch_difference, i), expected));
                // (1 - x / 8)^8: exp(-x) to within .03, and exactly 0 from x = 8 on.
                const auto tolerance = between(8 * kWhereScattered.patch, 8 * kWhereEven.patch);
                const auto tolerated = hn::Max(hn::Mul(expected, tolerance), least);
                const auto x8 = hn::Div(beyond, tolerated);
                // Of a few rays that agree by chance the scatter is 0: that of the patches tells more.
                const auto alone = hn::Mul(load(window.scratch_difference, i), hn::Set(d, kPatchTexels));
                const auto is_alike
                    = hn::Le(alone, hn::Mul(expected, between(kWhereScattered.alone, kWhereEven.alone)));
                const auto alike
                    = hn::IfThenElseZero(is_alike, square(square(square(hn::Max(zero, hn::Sub(one, x8))))));
                const auto gives = load(window.gives, Window::index(x + to.x, y + to.y));
                const auto weight = hn::Mul(hn::Mul(hn::Mul(alike, near), load(window.scratch_surface, i)), gives);
                hn::StoreU(weight, d, weights);
                float* sum = window.scale.data() + size_t(y) * kTileSize + size_t(x);
                hn::StoreU(hn::Add(hn::LoadU(d, sum), weight), d, sum);
            }
    }
    for (size_t i = 0; i < window.scale.size(); i += hn::Lanes(d))
        hn::StoreU(hn::Div(one, hn::LoadU(d, window.scale.data() + i)), d, window.scale.data() + i);
}

void mean_change_target(const Window& window, const float* plane, float* change)
{
    const WeightTag d;
    for (int y = 0; y < kTileSize; ++y)
        for (int x = 0; x < kTileSize; x += int(hn::Lanes(d))) {
            if (!wants(window.wanted[size_t(y)], x, x + int(hn::Lanes(d)) - 1))
                continue;
            const size_t i = Window::index(x, y), texel = size_t(y) * kTileSize + size_t(x);
            const auto own = hn::LoadU(d, plane + i);
            auto sum = hn::Zero(d);
            for (int number = 0; number < Window::kNeighbours; ++number) {
                const Window::Offset to = Window::neighbour(number);
                const auto weight
                    = hn::LoadU(d, window.weights.data() + size_t(number) * kTileSize * kTileSize + texel);
                const auto other = hn::LoadU(d, plane + Window::index(x + to.x, y + to.y));
                sum = hn::Add(sum, hn::Mul(weight, hn::Sub(other, own)));
            }
            hn::StoreU(hn::Mul(sum, hn::LoadU(d, window.scale.data() + texel)), d, change + texel);
        }
}

void mean_variance_target(const Window& window, float* variance)
{
    const WeightTag d;
    for (int y = 0; y < kTileSize; ++y)
        for (int x = 0; x < kTileSize; x += int(hn::Lanes(d))) {
            if (!wants(window.wanted[size_t(y)], x, x + int(hn::Lanes(d)) - 1))
                continue;
            const size_t i = Window::index(x, y), texel = size_t(y) * kTileSize + size_t(x);
            auto sum = load(window.variance, i);
            for (int number = 0; number < Window::kNeighbours; ++number) {
                const Window::Offset to = Window::neighbour(number);
                const auto weight
                    = hn::LoadU(d, window.weights.data() + size_t(number) * kTileSize * kTileSize + texel);
                sum = hn::Add(sum, hn::Mul(square(weight), load(window.variance, Window::index(x + to.x, y + to.y))));
            }
            const auto scale = hn::LoadU(d, window.scale.data() + texel);
            hn::StoreU(hn::Mul(sum, square(scale)), d, variance + texel);
        }
}

} // namespace HWY_NAMESPACE
} // namespace vmlight::kernel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vmlight {

namespace kernel {
HWY_EXPORT(weigh_neighbours_target);
HWY_EXPORT(mean_change_target);
HWY_EXPORT(mean_variance_target);
} // namespace kernel

NeighbourWindow::NeighbourWindow()
    : weights(size_t(kNeighbours) * kTileSize * kTileSize)
    , scale(size_t(kTileSize) * kTileSize)
{
    clear();
    scratch_difference.assign(spacing.size(), 0);
    scratch_expected = scratch_surface = scratch_difference;
}

void NeighbourWindow::clear()
{
    wanted.fill(~uint64_t(0));
    constexpr size_t kTexels = size_t(kSide) * kStride + 8;
    for (Plane* plane : { &visibility, &x, &y, &z, &variance, &spacing })
        plane->assign(kTexels, 0);
    gives.assign(kTexels, 1);
    for (size_t c = 0; c < 3; ++c) {
        normal[c].assign(kTexels, 0);
        position[c].assign(kTexels, 0);
    }
}

void weigh_neighbours(NeighbourWindow& window)
{
    HWY_DYNAMIC_DISPATCH(kernel::weigh_neighbours_target)(window);
}

void mean_change(const NeighbourWindow& window, const float* plane, float* change)
{
    HWY_DYNAMIC_DISPATCH(kernel::mean_change_target)(window, plane, change);
}

void mean_variance(const NeighbourWindow& window, float* variance)
{
    HWY_DYNAMIC_DISPATCH(kernel::mean_variance_target)(window, variance);
}

} // namespace vmlight
#endif
