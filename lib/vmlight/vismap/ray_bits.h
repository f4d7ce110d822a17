// SPDX-License-Identifier: Apache-2.0
/// Which rays of a map's texels nothing blocks, kept for the next pose.
#pragma once

#include <vmlight/math/ray_fan.h>
#include <vmlight/trace/moved_boxes.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vmlight {

/// Of all texels of a map: lane bits as in RayFan.
class RayBits
{
public:
    RayBits() = default;
    RayBits(int width, int height, int rays)
        : m_width(width)
        , m_packets((rays + kPacketSize - 1) / kPacketSize)
        , m_bytes(size_t(width) * size_t(height) * (size_t(m_packets) + 1))
    {
    }
    bool empty() const { return m_bytes.empty(); }
    size_t packets() const { return size_t(m_packets); }

    /// packets() bytes, and one that says from where the rays start.
    enum Origin : uint8_t
    {
        unknown,
        far,
        near
    };
    uint8_t* at(int x, int y) { return m_bytes.data() + index(x, y); }
    const uint8_t* at(int x, int y) const { return m_bytes.data() + index(x, y); }

private:
    size_t index(int x, int y) const { return (size_t(y) * size_t(m_width) + size_t(x)) * (size_t(m_packets) + 1); }
    int m_width = 0, m_packets = 0;
    std::vector<uint8_t> m_bytes;
};

/// What is known of a texel's rays before they are traced, and where to keep what is found.
struct RayMemory
{
    /// nullptr, or what was found in another pose: rays that meet nothing of `moved` need not be traced.
    const uint8_t* known = nullptr;
    const MovedBoxes* moved = nullptr;
    /// nullptr, or set to what is found.
    uint8_t* record = nullptr;
};

} // namespace vmlight
