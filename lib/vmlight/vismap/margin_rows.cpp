// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/margin_rows.h>

#include <vmlight/base/stopwatch.h>
#include <vmlight/base/tile_size.h>

#include <algorithm>
#include <utility>

namespace vmlight {
namespace {

// A margin that reaches farther would need the better part of most maps.
constexpr int kFarthestRows = 2;

int rows_of_tiles(int height)
{
    return (height + kTileSize - 1) / kTileSize;
}

} // namespace

int MarginRows::reach(int margin)
{
    return (margin + kTileSize - 1) / kTileSize;
}

bool MarginRows::is_narrow(int margin)
{
    return margin >= 0 && reach(margin) <= kFarthestRows;
}

double MarginRows::held_bytes(int width, int height, int channels, int margin, int band)
{
    const double row = double(width) * kTileSize * channels * sizeof(float);
    const int all = rows_of_tiles(height);
    // The rows themselves, and the copy whose margin is filled.
    return 2 * row * (is_narrow(margin) ? std::min(all, band + 2 * reach(margin)) : all);
}

MarginRows::MarginRows(int width, int height, int channels, int margin, const MarginChannels& filled, int band)
    : m_width(width)
    , m_height(height)
    , m_margin(margin)
    , m_rows_in_all(rows_of_tiles(height))
    , m_band(is_narrow(margin) ? std::min(band, m_rows_in_all) : m_rows_in_all)
    , m_reach(is_narrow(margin) ? reach(margin) : 0)
    , m_channels(size_t(channels))
    , m_pitch(size_t(width) * m_channels)
    , m_filled(filled)
{
}

bool MarginRows::add(TileRow row, const TakeRows& take)
{
    m_rows.push_back(std::move(row));
    const int end = m_first + int(m_rows.size());
    while (m_given < m_rows_in_all) {
        const int next = std::min(m_given + m_band, m_rows_in_all);
        if (end < std::min(next + m_reach, m_rows_in_all))
            return true;
        if (!give(m_given, next, take))
            return false;
        m_given = next;
        for (; m_first < m_given - m_reach; ++m_first)
            m_rows.pop_front();
    }
    return true;
}

// Of a copy in which the margin is filled: the rows below need them without it.
bool MarginRows::give(int first, int end, const TakeRows& take)
{
    const Stopwatch timer;
    const int ybegin = first * kTileSize, yend = std::min(m_height, end * kTileSize);
    const int reach = m_margin < 0 ? m_height : m_margin;
    const int top = std::max(0, ybegin - reach), bottom = std::min(m_height, yend + reach);
    std::vector<float> texels(m_pitch * size_t(bottom - top));
    Coverage covered(m_width, bottom - top);
    for (int y = top; y < bottom; ++y) {
        const TileRow& row = m_rows[size_t(y / kTileSize - m_first)];
        std::copy_n(&row.texels[size_t(y % kTileSize) * m_pitch], m_pitch, &texels[size_t(y - top) * m_pitch]);
        for (int x = 0; x < m_width; x += kTileSize)
            covered.set_word(x, y - top, row.covered.word(x, y % kTileSize));
    }
    fill_margin(texels.data(), int(m_channels), covered, m_margin, m_filled);
    m_seconds += timer();
    return take(ybegin, yend, &texels[size_t(ybegin - top) * m_pitch]);
}

} // namespace vmlight
