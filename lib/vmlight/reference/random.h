// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace vmlight {

/// Independent random numbers in [0, 1), a function of texel, pair and seed alone.
/// Source: G. Steele, D. Lea, C. Flood, "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014 (SplitMix64).
class ReferenceRandom
{
public:
    ReferenceRandom(int x, int y, int seed)
    {
        m_state = uint64_t(uint32_t(seed));
        for (const int key : { x, y })
            m_state = next_bits() ^ uint64_t(uint32_t(key));
        next_bits();
    }
    double next() { return double(next_bits() >> 11) * 0x1p-53; }

private:
    uint64_t next_bits()
    {
        uint64_t z = m_state += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    uint64_t m_state;
};

} // namespace vmlight
