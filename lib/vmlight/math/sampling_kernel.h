// SPDX-License-Identifier: Apache-2.0
/// The vector code of sampling.h, compiled for several instruction sets with run-time dispatch. Not installed.
#pragma once

#include <vmlight/math/sampling.h>

namespace vmlight::kernel {

/// Scramble a bit-reversed fraction: each bit depends on itself and lower ones only.
inline uint32_t scramble_reversed(uint32_t x, uint32_t seed)
{
    x += seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return x;
}

struct Points
{
    const uint32_t *u, *v;
    int count;
    bool uniform, owen;
    uint32_t texel_u, texel_v;
};

void directions(const Points& points, const TangentFrame& frame, const Imath::V3f& geometric_normal, RayFan& fan);
DirectionSums sum_directions(const RayFan& fan, const Imath::V3f& weight_axis);

} // namespace vmlight::kernel
