// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vmlight {

/// One bit per cell of a grid, rows padded to whole words.
class UnwrapBitmap
{
public:
    UnwrapBitmap() = default;
    UnwrapBitmap(int width, int height)
        : m_width(width)
        , m_height(height)
        , m_words_across(size_t(width + 63) / 64)
        , m_words(m_words_across * size_t(height), 0)
    {
    }

    int width() const { return m_width; }
    int height() const { return m_height; }
    size_t words_across() const { return m_words_across; }
    bool get(int x, int y) const { return row(y)[x / 64] >> (x % 64) & 1; }
    uint64_t* row(int y) { return m_words.data() + size_t(y) * m_words_across; }
    const uint64_t* row(int y) const { return m_words.data() + size_t(y) * m_words_across; }

    /// Set the cells `first` to `last` of a row.
    void set(int first, int last, int y)
    {
        uint64_t* words = row(y);
        for (int word = first / 64; word <= last / 64; ++word) {
            const int low = std::max(first - 64 * word, 0), high = std::min(last - 64 * word, 63);
            words[word] |= (~uint64_t(0) >> (63 - high)) & (~uint64_t(0) << low);
        }
    }

    /// A quarter turn counter-clockwise, where x runs right and y up.
    UnwrapBitmap turned() const
    {
        UnwrapBitmap result(m_height, m_width);
        for (int y = 0; y < m_height; ++y)
            for (int x = 0; x < m_width; ++x)
                if (get(x, y))
                    result.set(m_height - 1 - y, m_height - 1 - y, x);
        return result;
    }

private:
    int m_width = 0, m_height = 0;
    size_t m_words_across = 0;
    std::vector<uint64_t> m_words;
};

} // namespace vmlight
