// SPDX-License-Identifier: Apache-2.0
/// The margin around what a mesh covers: texels filled from their covered neighbours, so that bilinear lookups and
/// mip levels at the rim of an island never mix in the background.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vmlight {

/// One bit a texel: covered or not. Rows are padded to whole words, so that tiles 64 texels wide share no word.
class Coverage
{
public:
    Coverage(int width, int height);

    int width() const { return m_width; }
    int height() const { return m_height; }
    bool get(int x, int y) const { return word(x, y) >> (x % 64) & 1; }
    void set(int x, int y) { m_words[index(x, y)] |= uint64_t(1) << (x % 64); }
    /// The 64 texels from (x - x % 64, y) on.
    uint64_t word(int x, int y) const { return m_words[index(x, y)]; }
    void set_word(int x, int y, uint64_t bits) { m_words[index(x, y)] = bits; }

private:
    size_t index(int x, int y) const { return size_t(y) * m_words_across + size_t(x / 64); }
    int m_width, m_height;
    size_t m_words_across;
    std::vector<uint64_t> m_words;
};

/// Which channels of a texel a margin has, from the first on.
struct MarginChannels
{
    int averaged = 4; ///< four or more: V and B come first
    int copied = 0; ///< those that follow, of which no mean can be taken
};

/// Grow `coverage` by `rings` texels (less than 0: until all is filled), setting the averaged channels of each texel
/// that is gained to the mean of those among its eight neighbours that were filled before its ring
/// and whose direction (the second to the fourth) lies within 30 degrees of the longest. Values stay within the convex
/// hull of the covered ones, so that |B| <= V holds in the margin too. The copied channels are those of the neighbour
/// with the longest direction. Cost grows with the texels filled. `pixels` has `channels` floats a texel, rows without
/// padding.
void fill_margin(float* pixels, int channels, Coverage& coverage, int rings, const MarginChannels& filled = {});

} // namespace vmlight
