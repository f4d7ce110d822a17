// SPDX-License-Identifier: Apache-2.0
/// The margin around UV islands: texels filled from covered neighbours, so that bilinear lookups and mip levels never
/// mix in the background at the border of an island.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vmlight {

/// One bit per texel: covered or not. Rows are padded to whole words, so that tiles 64 texels wide share no word.
class Coverage
{
public:
    Coverage(int width, int height);

    int width() const { return m_width; }
    int height() const { return m_height; }
    bool get(int x, int y) const { return word(x, y) >> (x % 64) & 1; }
    void set(int x, int y) { m_words[index(x, y)] |= uint64_t(1) << (x % 64); }
    /// The 64 texels that start at (x - x % 64, y).
    uint64_t word(int x, int y) const { return m_words[index(x, y)]; }
    void set_word(int x, int y, uint64_t bits) { m_words[index(x, y)] = bits; }

private:
    size_t index(int x, int y) const { return size_t(y) * m_words_across + size_t(x / 64); }
    int m_width, m_height;
    size_t m_words_across;
    std::vector<uint64_t> m_words;
};

/// The channels of a texel that the margin fills, starting with the first.
struct MarginChannels
{
    int averaged = 4; ///< at least four: V and B come first
    int copied = 0; ///< channels after those, which cannot be averaged
};

/// Where the averages of a margin are from, to fill further images of the same texels alike, and fast.
struct MarginPlan
{
    struct Texel
    {
        uint32_t index; ///< row by row
        uint32_t sources; ///< how many of `sources`, after those of the texels before
    };
    /// Texels of one ring, of which none is a source of another.
    struct Part
    {
        size_t texel, source; ///< the first; the part ends where the next begins
        int ring;
    };
    std::vector<Texel> texels; ///< ring by ring
    std::vector<uint32_t> sources; ///< indices
    std::vector<Part> parts;

    /// Fill the margin of `pixels`, all of whose `channels` are averaged. The same bits for any number of threads.
    void fill(float* pixels, int channels, int nthreads = 1) const;
    size_t bytes() const
    {
        return texels.capacity() * sizeof(Texel) + sources.capacity() * sizeof(uint32_t)
            + parts.capacity() * sizeof(Part);
    }

private:
    void fill_part(size_t part, float* pixels, size_t channels) const;
};

/// Grow `coverage` by `rings` texels (negative: until every texel is filled). The averaged channels of a new texel are
/// the mean over those of its eight neighbours that were filled before its ring and whose direction (channels 1 to 3)
/// is within 30 degrees of the longest one. Values stay in the convex hull of the covered ones, so that |B| <= V holds
/// in the margin too. The copied channels come from the neighbour with the longest direction. Time is linear in the
/// texels filled. `pixels` has `channels` floats per texel, rows without padding.
/// `plan` is nullptr, or where to append what was averaged.
void fill_margin(float* pixels, int channels, Coverage& coverage, int rings, const MarginChannels& filled = {},
                 MarginPlan* plan = nullptr);

} // namespace vmlight
