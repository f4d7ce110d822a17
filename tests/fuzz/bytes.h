// SPDX-License-Identifier: Apache-2.0
/// A fuzzer's bytes as numbers and choices. Read from first to last, so that a corpus can be written by hand; past the
/// last one all are 0.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace vmlight::fuzz {

class Bytes
{
public:
    Bytes(const uint8_t* data, size_t size)
        : m_next(data)
        , m_end(data + size)
    {
    }

    bool empty() const { return m_next == m_end; }
    uint8_t byte() { return empty() ? 0 : *m_next++; }
    bool flag() { return byte() & 1; }
    /// From 0 to `count` - 1.
    size_t below(size_t count) { return byte() % count; }
    template <class Words> auto choice(const Words& words) { return words[below(std::size(words))]; }

    /// Up to 200: that many less 100, of 32nds, so that much is equal, coplanar and on edges. Then ends and nonsense of
    /// the range; from 240 on the four bytes that follow, whatever they are.
    float number()
    {
        using Limits = std::numeric_limits<float>;
        constexpr std::array<float, 24> kEnds { -0.0f,
                                                1,
                                                Limits::quiet_NaN(),
                                                Limits::infinity(),
                                                -Limits::infinity(),
                                                Limits::max(),
                                                -Limits::max(),
                                                Limits::min(),
                                                -Limits::min(),
                                                Limits::denorm_min(),
                                                -Limits::denorm_min(),
                                                Limits::epsilon(),
                                                1e30f,
                                                -1e30f,
                                                1e-30f,
                                                1e10f,
                                                -1e10f,
                                                1e-10f,
                                                16777216,
                                                65504,
                                                2097153,
                                                0.99999994f,
                                                1.0000001f,
                                                1e19f };
        const uint8_t kind = byte();
        if (kind <= 200)
            return float(kind - 100) / 32;
        if (kind < 240)
            return kEnds[size_t(kind - 201) % kEnds.size()];
        std::array<uint8_t, 4> raw;
        for (uint8_t& part : raw)
            part = byte();
        float value;
        std::memcpy(&value, raw.data(), sizeof(value));
        return value;
    }
    /// Up to the next zero byte, and no more than `longest` of them.
    std::string text(size_t longest)
    {
        std::string text;
        while (!empty() && text.size() < longest)
            if (const uint8_t next = byte())
                text += char(next);
            else
                break;
        return text;
    }
    /// What is left.
    std::string rest()
    {
        const std::string text(m_next, m_end);
        m_next = m_end;
        return text;
    }

private:
    const uint8_t *m_next, *m_end;
};

} // namespace vmlight::fuzz
