// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/neighbour_fit.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vmlight/vismap/neighbour_fit.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <vmlight/vismap/neighbour_near-inl.h>

#ifndef VMLIGHT_NEIGHBOUR_FIT
#define VMLIGHT_NEIGHBOUR_FIT
namespace vmlight::kernel {

// Of the nearness by distance, in texels.
constexpr float kSpread = 2;
// How many times the expected variance is even, and is not. Measured on ten meshes at 256x256 texels and three at
// 1024x1024: up to 8, the RMS error of large smooth maps of 16 rays is 8 % less, elsewhere the same, and single texels
// beside edges are worse.
constexpr float kEven = 1.5f, kUneven = 4;
// Up to how many times the expected variance a plane may leave to be used whole, and at all: a step is not a slope.
// Measured on the same: farther up, the error of foliage grows, of 1024x1024 texels of leaves by 6 % at 4.
constexpr float kPlane = 1.25f, kNoPlane = 2.5f;
// A plane through noise explains the scatter of two texels: up to somewhat more is still noise.
constexpr float kNoiseExplained = 2.5f;
// Of the moments of nearness: where all neighbours are on one line, nothing is known across it.
constexpr float kLeastMoment = 1e-3f;

} // namespace vmlight::kernel
#endif

HWY_BEFORE_NAMESPACE();
namespace vmlight::kernel {
namespace HWY_NAMESPACE {

// How near the texels from `there` on, `to` from those from `at` on, are on the surface: 0 where they are not.
HWY_INLINE TexelVec nearness_of(const Window& window, size_t at, size_t there, Window::Offset to)
{
    auto facing = hn::Zero(TexelTag());
    const auto near = are_near(window, at, there, to, facing);
    // (1 - x / 8)^8: exp(-x) to within .03. So is the weight by distance in the map.
    const float texels = float(to.x * to.x + to.y * to.y);
    const auto nearby = hn::Set(TexelTag(), 1 - texels / (16 * kSpread * kSpread));
    return hn::IfThenElseZero(near, square(square(square(hn::Mul(facing, nearby)))));
}

// Of some texels: the sums over their neighbours, by nearness, of the steps to them, of the differences in V and B',
// and of the variance.
enum Sum
{
    kAll,
    kX,
    kY,
    kXX,
    kXY,
    kYY,
    kVariance,
    kSquares,
    kValues,
    kByX = kValues + 4,
    kByY = kByX + 4,
    kSums = kByY + 4
};
struct FitSums
{
    HWY_ALIGN float lanes[kSums][8];

    HWY_INLINE void add(int sum, TexelVec value)
    {
        const TexelTag d;
        hn::Store(hn::Add(hn::Load(d, lanes[sum]), value), d, lanes[sum]);
    }
    HWY_INLINE TexelVec operator[](int sum) const { return hn::Load(TexelTag(), lanes[sum]); }
};

HWY_INLINE void sum_neighbours(Window& window, size_t at, size_t texel, FitSums& sums)
{
    const TexelTag d;
    for (int sum = 0; sum < kSums; ++sum)
        hn::Store(hn::Zero(d), d, sums.lanes[sum]);
    sums.add(kAll, hn::Set(d, 1.0f)); // the texel itself
    sums.add(kVariance, load(window.variance, at));
    for (int number = 0; number < Window::kNeighbours; ++number) {
        const Window::Offset to = Window::neighbour(number);
        const size_t there = size_t(int64_t(at) + to.y * Window::kStride + to.x);
        const auto near = hn::Mul(nearness_of(window, at, there, to), load(window.gives, there));
        hn::StoreU(near, d, window.fit.nearness.data() + Window::weight(number, texel));
        const auto step_x = hn::Set(d, float(to.x)), step_y = hn::Set(d, float(to.y));
        const auto x = hn::Mul(near, step_x), y = hn::Mul(near, step_y);
        sums.add(kAll, near);
        sums.add(kX, x);
        sums.add(kY, y);
        sums.add(kXX, hn::Mul(x, step_x));
        sums.add(kXY, hn::Mul(x, step_y));
        sums.add(kYY, hn::Mul(y, step_y));
        sums.add(kVariance, hn::Mul(near, load(window.variance, there)));
        for (int c = 0; c < 4; ++c) {
            const auto difference = hn::Sub(load(window.values[size_t(c)], there), load(window.values[size_t(c)], at));
            const auto weighted = hn::Mul(near, difference);
            sums.add(kValues + c, weighted);
            sums.add(kByX + c, hn::Mul(weighted, step_x));
            sums.add(kByY + c, hn::Mul(weighted, step_y));
            sums.add(kSquares, hn::Mul(weighted, difference));
        }
    }
}

HWY_INLINE TexelVec share(TexelVec value, float zero_at, float one_at)
{
    const TexelTag d;
    const auto from = hn::Mul(hn::Sub(value, hn::Set(d, zero_at)), hn::Set(d, 1 / (one_at - zero_at)));
    return hn::Min(hn::Max(from, hn::Zero(d)), hn::Set(d, 1.0f));
}

// The least squares, texel by texel. Whether any has a slope.
HWY_INLINE bool solve(Window::Fit& fit, const FitSums& sums, size_t texel)
{
    const TexelTag d;
    const auto zero = hn::Zero(d), one = hn::Set(d, 1.0f), least = hn::Set(d, kLeastMoment);
    const auto inverse = hn::Div(one, sums[kAll]);
    const auto middle_x = hn::Mul(sums[kX], inverse), middle_y = hn::Mul(sums[kY], inverse);
    const auto xx = hn::Add(hn::Sub(sums[kXX], hn::Mul(sums[kX], middle_x)), least);
    const auto yy = hn::Add(hn::Sub(sums[kYY], hn::Mul(sums[kY], middle_y)), least);
    const auto xy = hn::Sub(sums[kXY], hn::Mul(sums[kX], middle_y));
    const auto over = hn::Div(one, hn::Sub(hn::Mul(xx, yy), square(xy)));
    auto explained = zero, scatter = sums[kSquares];
    for (int c = 0; c < 4; ++c) {
        const auto mean = hn::Mul(sums[kValues + c], inverse);
        const auto x = hn::Sub(sums[kByX + c], hn::Mul(sums[kX], mean));
        const auto y = hn::Sub(sums[kByY + c], hn::Mul(sums[kY], mean));
        const auto right = hn::Mul(hn::Sub(hn::Mul(yy, x), hn::Mul(xy, y)), over);
        const auto down = hn::Mul(hn::Sub(hn::Mul(xx, y), hn::Mul(xy, x)), over);
        store(right, fit.slopes[0][size_t(c)], texel);
        store(down, fit.slopes[1][size_t(c)], texel);
        explained = hn::Add(explained, hn::Add(hn::Mul(right, x), hn::Mul(down, y)));
        scatter = hn::Sub(scatter, hn::Mul(sums[kValues + c], mean));
    }
    // In the variance that is expected of all.
    const auto all = hn::Mul(sums[kVariance], hn::Set(d, kVarianceOfBoth));
    const auto expects = hn::Gt(all, zero);
    const auto expected = hn::IfThenElse(expects, all, one);
    explained = hn::Div(explained, expected);
    scatter = hn::Div(scatter, expected);
    const auto by_chance = hn::Mul(hn::Set(d, kNoiseExplained), inverse);
    const auto tells = hn::And(expects, hn::Gt(explained, by_chance));
    auto kept = hn::Sub(one, hn::Div(by_chance, hn::IfThenElse(tells, explained, one)));
    kept = hn::IfThenElseZero(tells, hn::Mul(kept, share(hn::Sub(scatter, explained), kNoPlane, kPlane)));
    const auto left = hn::Sub(scatter, hn::Mul(hn::Mul(kept, hn::Sub(hn::Set(d, 2.0f), kept)), explained));
    store(hn::IfThenElseZero(expects, share(left, kUneven, kEven)), fit.evenness, texel);
    for (auto& slopes : fit.slopes)
        for (std::vector<float>& slope : slopes)
            store(hn::Mul(kept, hn::LoadU(d, slope.data() + texel)), slope, texel);
    store(hn::Mul(hn::Mul(kept, over), yy), fit.xx, texel);
    store(hn::Neg(hn::Mul(hn::Mul(kept, over), xy)), fit.xy, texel);
    store(hn::Mul(hn::Mul(kept, over), xx), fit.yy, texel);
    store(middle_x, fit.middle_x, texel);
    store(middle_y, fit.middle_y, texel);
    return !hn::AllFalse(d, hn::Gt(kept, zero));
}

void fit_neighbours_target(NeighbourWindow& window)
{
    window.fit.is_sloped = false;
    const int lanes = int(hn::Lanes(TexelTag()));
    FitSums sums;
    for (int y = 0; y < kTileSize; ++y)
        for (int x = 0; x < kTileSize; x += lanes) {
            if (!wants_any(window.wanted[size_t(y)], x, x + lanes - 1))
                continue;
            const size_t texel = size_t(y) * kTileSize + size_t(x);
            sum_neighbours(window, Window::index(x, y), texel, sums);
            window.fit.is_sloped |= solve(window.fit, sums, texel);
        }
}

} // namespace HWY_NAMESPACE
} // namespace vmlight::kernel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vmlight {

namespace kernel {
HWY_EXPORT(fit_neighbours_target);
} // namespace kernel

void fit_neighbours(NeighbourWindow& window)
{
    HWY_DYNAMIC_DISPATCH(kernel::fit_neighbours_target)(window);
}

} // namespace vmlight
#endif
