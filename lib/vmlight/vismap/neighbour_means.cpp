// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/neighbour_means.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vmlight/vismap/neighbour_means.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <vmlight/vismap/neighbour_near-inl.h>

HWY_BEFORE_NAMESPACE();
namespace vmlight::kernel {
namespace HWY_NAMESPACE {

// Set `dst` to start(texel) and the sum over neighbours of term(weight, what plane has there, and in the texel).
template <class Start, class Term>
HWY_INLINE void sum_weighted(const Window& window, const float* plane, float* dst, const Start& start, const Term& term)
{
    const TexelTag d;
    for (int y = 0; y < kTileSize; ++y)
        for (int x = 0; x < kTileSize; x += int(hn::Lanes(d))) {
            if (!wants_any(window.wanted[size_t(y)], x, x + int(hn::Lanes(d)) - 1))
                continue;
            const size_t texel = size_t(y) * kTileSize + size_t(x);
            const auto own = hn::LoadU(d, plane + Window::index(x, y));
            auto sum = start(load(window.own_weight, texel), own);
            for (int number = 0; number < Window::kNeighbours; ++number) {
                const Window::Offset to = Window::neighbour(number);
                const auto weight = load(window.weights, Window::weight(number, texel));
                sum = hn::Add(sum, term(weight, hn::LoadU(d, plane + Window::index(x + to.x, y + to.y)), own));
            }
            hn::StoreU(sum, d, dst + texel);
        }
}

void mean_change_target(const Window& window, const float* plane, float* change)
{
    sum_weighted(
        window, plane, change, [](TexelVec, TexelVec) { return hn::Zero(TexelTag()); },
        [](TexelVec weight, TexelVec other, TexelVec own) { return hn::Mul(weight, hn::Sub(other, own)); });
}

void mean_variance_target(const Window& window, float* variance)
{
    sum_weighted(
        window, window.variance.data(), variance,
        [](TexelVec weight, TexelVec own) { return hn::Mul(square(weight), own); },
        [](TexelVec weight, TexelVec other, TexelVec) { return hn::Mul(square(weight), other); });
}

} // namespace HWY_NAMESPACE
} // namespace vmlight::kernel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vmlight {

namespace kernel {
HWY_EXPORT(mean_change_target);
HWY_EXPORT(mean_variance_target);
} // namespace kernel

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
