// SPDX-License-Identifier: Apache-2.0
/// Pixels that an input may not have: counted, and the first one told, so that a user can find it.
#pragma once

#include <OpenImageIO/strutil.h>

#include <cstdint>
#include <string>
#include <tuple>

namespace vmlight {

/// Faulty values of one image. The first is the first in reading order, in whatever order they were found.
class Faults
{
public:
    void add(int x, int y, int channel) { merge(Faults { 1, x, y, channel }); }

    void merge(const Faults& other)
    {
        if (other.m_count && (!m_count || other.place() < place()))
            m_x = other.m_x, m_y = other.m_y, m_channel = other.m_channel;
        m_count += other.m_count;
    }

    bool any() const { return m_count > 0; }
    int64_t count() const { return m_count; }

    /// "visibility map has 3 values that are not finite, the first at pixel (4, 2) channel "direction.x"".
    /// @param wrong    what the values are: "not finite"
    /// @param channels names, indexed as in add()
    template <class Names> std::string text(const char* image, const char* wrong, const Names& channels) const
    {
        const bool one = m_count == 1;
        return OIIO::Strutil::fmt::format("{} has {} value{} that {} {}, {}at pixel ({}, {}) channel \"{}\"", image,
                                          m_count, one ? "" : "s", one ? "is" : "are", wrong, one ? "" : "the first ",
                                          m_x, m_y, channels[m_channel]);
    }

    Faults() = default;

private:
    Faults(int64_t count, int x, int y, int channel)
        : m_count(count)
        , m_x(x)
        , m_y(y)
        , m_channel(channel)
    {
    }
    std::tuple<int, int, int> place() const { return { m_y, m_x, m_channel }; }

    int64_t m_count = 0;
    int m_x = 0, m_y = 0, m_channel = 0;
};

} // namespace vmlight
