// SPDX-License-Identifier: Apache-2.0
/// Counts invalid values of an image (NaN, negative, ...) and remembers where the first one is.
#pragma once

#include <vmlight/base/format.h>

#include <cstdint>
#include <string>
#include <tuple>

namespace vmlight {

/// Invalid values of one image. "First" means in scanline order, whatever the order in which they were found.
class BadValues
{
public:
    void add(int x, int y, int channel) { merge(BadValues { 1, x, y, channel }); }

    void merge(const BadValues& other)
    {
        if (other.m_count && (!m_count || other.position() < position()))
            m_x = other.m_x, m_y = other.m_y, m_channel = other.m_channel;
        m_count += other.m_count;
    }

    bool any() const { return m_count > 0; }
    int64_t count() const { return m_count; }
    /// Where the first is.
    int x() const { return m_x; }
    int y() const { return m_y; }

    /// "visibility map has 3 values that are not finite, the first at pixel (4, 2) channel "direction.x"".
    /// @param problem  what is wrong with the values: "not finite"
    /// @param channels channel names, indexed as in add()
    template <class Names> std::string describe(const char* image, const char* problem, const Names& channels) const
    {
        const bool one = m_count == 1;
        return format("{} has {} value{} that {} {}, {}at pixel ({}, {}) channel \"{}\"", image, m_count,
                      one ? "" : "s", one ? "is" : "are", problem, one ? "" : "the first ", m_x, m_y,
                      channels[m_channel]);
    }

    BadValues() = default;

private:
    BadValues(int64_t count, int x, int y, int channel)
        : m_count(count)
        , m_x(x)
        , m_y(y)
        , m_channel(channel)
    {
    }
    std::tuple<int, int, int> position() const { return { m_y, m_x, m_channel }; }

    int64_t m_count = 0;
    int m_x = 0, m_y = 0, m_channel = 0;
};

} // namespace vmlight
