// SPDX-License-Identifier: Apache-2.0
/// Rays from one origin, in the packets of eight that Embree traces fastest.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vmlight {

/// Rays per packet.
constexpr int kPacketSize = 8;

/// Directions of rays from one origin, in packets of eight; lanes past the last ray are inactive.
struct RayFan
{
    explicit RayFan(int rays)
        : packets((rays + kPacketSize - 1) / kPacketSize)
        , storage(size_t(packets) * kPacketSize * 3 + kPacketSize)
        , lanes(size_t(packets))
    {
        const auto misaligned = reinterpret_cast<uintptr_t>(storage.data()) % (kPacketSize * sizeof(float));
        x = storage.data() + (misaligned ? kPacketSize - misaligned / sizeof(float) : 0);
        y = x + packets * kPacketSize;
        z = y + packets * kPacketSize;
    }
    RayFan(const RayFan&) = delete;
    RayFan& operator=(const RayFan&) = delete;

    int packets;
    /// x, y and z have packets * 8 numbers each, aligned for vector loads.
    std::vector<float> storage;
    float *x, *y, *z;
    /// One byte per packet, bit k for lane k. In: which rays to trace. Out: which of them are unoccluded.
    std::vector<uint8_t> lanes;
};

/// Of all packets' lane bits: those to trace, or those that were unoccluded.
inline int64_t count_rays(const std::vector<uint8_t>& packets)
{
    int64_t rays = 0;
    for (const uint8_t lanes : packets)
        rays += __builtin_popcount(lanes);
    return rays;
}
inline int64_t count_rays(const RayFan& fan)
{
    return count_rays(fan.lanes);
}

} // namespace vmlight
