// SPDX-License-Identifier: Apache-2.0
/// Moments of light in fixed point, so that few additions sum many: a 64-bit lane holds x, y and z, and one vector the
/// lanes of R, G, B and the weight. Sums of integers are the same in any order.
#pragma once

#include <cstdint>

namespace vmlight {

/// Fields of kMomentBits bits each, x the lowest. Negative ones borrow from the next: a lane is x + y 2^21 + z 2^42.
struct alignas(32) PackedMoments
{
    int64_t lanes[4] = { 0, 0, 0, 0 };
};

constexpr int kMomentBits = 21, kMomentLanes = 4;
/// Sums are between -kMomentBias and kMomentBias; added to each field, it leaves no borrow.
constexpr int32_t kMomentBias = 1 << (kMomentBits - 1);
constexpr int64_t kAllBiases
    = int64_t(kMomentBias) * (1 + (int64_t(1) << kMomentBits) + (int64_t(1) << 2 * kMomentBits));
/// How far sums of rounded entries may be off, and stay within the bias.
constexpr int kMomentSlack = 64;

/// Pack the moments, x of R, G, B and the weight, then y, then z, each rounded to a multiple of 1 / `per_unit`.
inline PackedMoments pack_moments(const double* moments, const double* per_unit)
{
    PackedMoments packed;
    for (int lane = 0; lane < kMomentLanes; ++lane)
        for (int axis = 2; axis >= 0; --axis) {
            // Truncation rounds what is positive. 0 stays 0.
            const double biased = moments[4 * axis + lane] * per_unit[lane] + (kMomentBias + 0.5);
            packed.lanes[lane] = packed.lanes[lane] * (int64_t(1) << kMomentBits) + (int32_t(biased) - kMomentBias);
        }
    return packed;
}

/// x, y or z of a lane of a sum.
inline float unpack_moment(int64_t lane, int axis)
{
    const uint64_t biased = uint64_t(lane) + uint64_t(kAllBiases);
    return float(int32_t(biased >> (kMomentBits * axis) & ((1u << kMomentBits) - 1)) - kMomentBias);
}

} // namespace vmlight
