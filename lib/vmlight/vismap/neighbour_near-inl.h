// SPDX-License-Identifier: Apache-2.0
/// Eight texels at a time: the vectors of all kernels of reconstruction, and which neighbours are near on the surface.
/// Included once for each instruction set (Highway's "-inl.h"), after hwy/foreach_target.h.
#if defined(VMLIGHT_NEIGHBOUR_NEAR_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VMLIGHT_NEIGHBOUR_NEAR_INL_H
#undef VMLIGHT_NEIGHBOUR_NEAR_INL_H
#else
#define VMLIGHT_NEIGHBOUR_NEAR_INL_H
#endif

#include <vmlight/vismap/neighbour_window.h>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vmlight::kernel {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Window = NeighbourWindow;
// The lane counts of all targets divide eight, and that a row of a tile.
using TexelTag = hn::CappedTag<float, 8>;
using TexelVec = hn::Vec<TexelTag>;

HWY_INLINE TexelVec square(TexelVec v)
{
    return hn::Mul(v, v);
}

HWY_INLINE TexelVec load(const std::vector<float>& plane, size_t at)
{
    return hn::LoadU(TexelTag(), plane.data() + at);
}

HWY_INLINE void store(TexelVec value, std::vector<float>& plane, size_t at)
{
    hn::StoreU(value, TexelTag(), plane.data() + at);
}

// Whether the texels from `there` on, `to` from those from `at` on, are near them on the surface, and face the same
// way. Sets `facing` to the cosine between their normals.
HWY_INLINE hn::Mask<TexelTag> are_near(const Window& window, size_t at, size_t there, Window::Offset to,
                                       TexelVec& facing)
{
    const TexelTag d;
    const auto zero = hn::Zero(d);
    auto distance = zero;
    facing = zero;
    for (size_t c = 0; c < 3; ++c) {
        facing = hn::Add(facing, hn::Mul(load(window.normal[c], at), load(window.normal[c], there)));
        distance = hn::Add(distance, square(hn::Sub(load(window.position[c], at), load(window.position[c], there))));
    }
    const auto own = load(window.spacing, at), other = load(window.spacing, there);
    // A step of one texel may be longer on the surface, where its triangles are stretched.
    const auto farthest = hn::Set(d, kStretch * float(to.x * to.x + to.y * to.y));
    const auto exists = hn::And(hn::Gt(own, zero), hn::Gt(other, zero));
    const auto near = hn::Le(distance, hn::Mul(square(hn::Max(own, other)), farthest));
    return hn::And(exists, hn::And(near, hn::Gt(facing, zero)));
}

} // namespace HWY_NAMESPACE
} // namespace vmlight::kernel
HWY_AFTER_NAMESPACE();

#endif
