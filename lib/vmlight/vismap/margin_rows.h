// SPDX-License-Identifier: Apache-2.0
/// The margin of a map that passes from the top down: bit for bit that of fill_margin() on the whole.
#pragma once

#include <vmlight/vismap/map_rows.h>

#include <cstddef>
#include <deque>
#include <functional>

namespace vmlight {

class MarginRows
{
public:
    /// Receives rows of texels from `ybegin` to `yend` - 1. False stops the work.
    using TakeRows = std::function<bool(int ybegin, int yend, const float* texels)>;

    /// @param width, height, channels  of the map
    /// @param margin   as in VismapParams. One that is not is_narrow() keeps all rows until the last
    /// @param band     rows of tiles to give away at once
    MarginRows(int width, int height, int channels, int margin, const MarginChannels& filled, int band);

    /// Whether rows farther than two rows of tiles do not matter.
    static bool is_narrow(int margin);
    /// Rows of tiles that a margin reaches.
    static int reach(int margin);
    /// What it holds at once, in bytes.
    static double held_bytes(int width, int height, int channels, int margin, int band);

    /// Add the next row of tiles, without its margin, and give away what is ready. False if `take` returned it.
    bool add(TileRow row, const TakeRows& take);
    double seconds() const { return m_seconds; }

private:
    bool give(int first, int end, const TakeRows& take);

    const int m_width, m_height, m_margin, m_rows_in_all, m_band, m_reach;
    const size_t m_channels, m_pitch; // floats of a texel, and of a row of texels
    const MarginChannels m_filled;
    std::deque<TileRow> m_rows;
    int m_first = 0, m_given = 0; // rows of tiles: the first of m_rows, and those given away
    double m_seconds = 0;
};

} // namespace vmlight
