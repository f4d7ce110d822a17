// SPDX-License-Identifier: Apache-2.0
/// Texels beyond the seams of a map, for reconstruction where the whole map is not in memory.
#pragma once

#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/reconstruct_map.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <unordered_map>
#include <vector>

namespace vmlight {

/// Some texels of a map, by the number of their tile.
using TexelSet = std::map<int, TileBits>;

/// The texels beyond the seams of islands in tile rows `first` to `end` - 1, in the map, that `wants` is true of. It is
/// called on all threads with the tile row and the texel.
TexelSet texels_beyond_seams(const VismapBaker& baker, int first, int end, int nthreads,
                             const std::function<bool(int row, int x, int y)>& wants);

/// Texels as they were baked.
class FarTexels
{
public:
    /// @param channels of a texel
    explicit FarTexels(size_t channels)
        : m_channels(channels)
    {
    }
    bool has(int x, int y) const { return m_numbers.count(key(x, y)) > 0; }
    void add(int x, int y, const BakedTexel& baked);
    /// Valid until the next add(). Two nullptr if it was not added.
    BakedTexel find(int x, int y) const;

private:
    static uint64_t key(int x, int y) { return uint64_t(uint32_t(y)) << 32 | uint32_t(x); }

    size_t m_channels;
    std::unordered_map<uint64_t, size_t> m_numbers;
    std::vector<float> m_texels;
    std::vector<TexelContext> m_contexts;
};

} // namespace vmlight
