// SPDX-License-Identifier: Apache-2.0
#include <vmlight/uv/unwrap_grid.h>

#include <algorithm>

namespace vmlight {
namespace {

// dst |= src, moved down by `shift` bits.
void or_shifted(uint64_t* dst, const uint64_t* src, size_t words, int shift)
{
    const size_t skipped = size_t(shift / 64);
    const int bits = shift % 64;
    if (skipped >= words)
        return;
    const size_t count = words - skipped;
    src += skipped;
    if (bits == 0) {
        for (size_t i = 0; i < count; ++i)
            dst[i] |= src[i];
        return;
    }
    for (size_t i = 0; i + 1 < count; ++i)
        dst[i] |= src[i] >> bits | src[i + 1] << (64 - bits);
    dst[count - 1] |= src[count - 1] >> bits;
}

int level_of(int length)
{
    int level = 0;
    while (2 << level <= length)
        ++level;
    return level;
}

int lowest_bit(uint64_t word)
{
    int bit = 0;
    for (int half = 32; half > 0; half /= 2)
        if ((word & ((uint64_t(1) << half) - 1)) == 0) {
            word >>= half;
            bit += half;
        }
    return bit;
}

} // namespace

UnwrapShape::UnwrapShape(const UnwrapBitmap& bitmap)
    : width(bitmap.width())
    , height(bitmap.height())
{
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            if (!bitmap.get(x, y))
                continue;
            const int first = x;
            while (x + 1 < width && bitmap.get(x + 1, y))
                ++x;
            runs.push_back({ y, first, x });
        }
    std::stable_sort(runs.begin(), runs.end(),
                     [](const Run& a, const Run& b) { return a.last - a.first > b.last - b.first; });
}

UnwrapGrid::UnwrapGrid(int width, int height)
    : m_width(width)
    , m_height(height)
    , m_levels(size_t(level_of(width)) + 1, UnwrapBitmap(width, height))
{
}

bool UnwrapGrid::fits_in_row(const UnwrapShape& shape, int y, int& x, std::vector<uint64_t>& blocked) const
{
    // Only where the shape does not reach beyond the right side.
    const int last = m_width - shape.width;
    for (size_t word = 0; word < blocked.size(); ++word) {
        const int beyond = last + 1 - 64 * int(word);
        blocked[word] = beyond >= 64 ? 0 : beyond <= 0 ? ~uint64_t(0) : ~uint64_t(0) << beyond;
    }
    for (const UnwrapShape::Run& run : shape.runs) {
        const int length = run.last - run.first + 1, level = level_of(length);
        const uint64_t* row = m_levels[size_t(level)].row(y + run.y);
        or_shifted(blocked.data(), row, blocked.size(), run.first);
        or_shifted(blocked.data(), row, blocked.size(), run.last + 1 - (1 << level));
        if (std::all_of(blocked.begin(), blocked.end(), [](uint64_t word) { return word == ~uint64_t(0); }))
            return false;
    }
    for (size_t word = 0; word < blocked.size(); ++word)
        if (~blocked[word] != 0) {
            x = 64 * int(word) + lowest_bit(~blocked[word]);
            return true;
        }
    return false;
}

bool UnwrapGrid::find_place(const UnwrapShape& shape, int highest, int& x, int& y) const
{
    if (shape.width > m_width)
        return false;
    std::vector<uint64_t> blocked(m_levels[0].words_across());
    for (y = 0; y <= std::min(highest, m_height - shape.height); ++y)
        if (fits_in_row(shape, y, x, blocked))
            return true;
    return false;
}

void UnwrapGrid::take(const UnwrapShape& shape, int x, int y, int gap)
{
    UnwrapBitmap& taken = m_levels[0];
    for (const UnwrapShape::Run& run : shape.runs)
        for (int row = std::max(0, y + run.y - gap); row <= std::min(m_height - 1, y + run.y + gap); ++row)
            taken.set(std::max(0, x + run.first - gap), std::min(m_width - 1, x + run.last + gap), row);
    for (size_t level = 1; level < m_levels.size(); ++level)
        for (int row = std::max(0, y - gap); row <= std::min(m_height - 1, y + shape.height - 1 + gap); ++row) {
            const uint64_t* below = m_levels[level - 1].row(row);
            uint64_t* words = m_levels[level].row(row);
            std::copy_n(below, taken.words_across(), words);
            or_shifted(words, below, taken.words_across(), 1 << (level - 1));
        }
}

} // namespace vmlight
