// SPDX-License-Identifier: Apache-2.0
/// The vector code of sampling.h, compiled for several instruction sets with run-time dispatch. Not installed.
#pragma once

#include <vmlight/math/sampling.h>

#include <cstdint>
#include <vector>

namespace vmlight::kernel {

inline uint32_t reverse_bits(uint32_t x)
{
    x = (x >> 16) | (x << 16);
    x = ((x & 0x00ff00ffu) << 8) | ((x >> 8) & 0x00ff00ffu);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
    x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
    return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

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

/// The angle of strand_angle() for shares up to 1/2, in turns: linear between entries, which are as dense in each
/// octave from 2^-25 up, as the angle goes with the cube root. Relative error below 4e-6.
struct StrandAngles
{
    static constexpr int kBits = 7, kOctaves = 24; ///< entries an octave, as a power of 2
    std::vector<float> turns; ///< kOctaves << kBits, and the last
};

void strand_directions(const Points& points, const StrandAngles& angles, const TangentFrame& frame, RayFan& fan);
void directions(const Points& points, const TangentFrame& frame, const Imath::V3f& geometric_normal, RayFan& fan);
DirectionSums sum_directions(const RayFan& fan, const Imath::V3f& weight_axis);

} // namespace vmlight::kernel
