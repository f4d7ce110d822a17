// SPDX-License-Identifier: Apache-2.0
/// Rays that start at one point, in the packets of eight that the ray tracer is fastest with.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vmlight {

/// Rays of one packet that may be asked about at once.
constexpr int kPacketSize = 8;

/// Directions of rays that start at one point, in packets of eight; the lanes past the last ray are dead.
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
    /// packets * 8 numbers each, aligned for vectors.
    std::vector<float> storage;
    float *x, *y, *z;
    /// One byte a packet, bit k for lane k. In: which rays to ask about. Out: which of them are not blocked.
    std::vector<uint8_t> lanes;
};

} // namespace vmlight
