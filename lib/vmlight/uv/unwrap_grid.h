// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/uv/unwrap_bitmap.h>

#include <cstdint>
#include <vector>

namespace vmlight {

/// The shape of a chart as runs of cells, the longest first: they are most likely to be in the way.
struct UnwrapShape
{
    explicit UnwrapShape(const UnwrapBitmap& bitmap);

    struct Run
    {
        int y, first, last;
    };
    int width, height;
    std::vector<Run> runs;
};

/// The part of an atlas that is taken: charts, and the gaps around them.
class UnwrapGrid
{
public:
    UnwrapGrid(int width, int height);

    /// The lowest place where the shape fits, and there the one farthest left; at most at `highest`. False if there is
    /// none.
    bool find_place(const UnwrapShape& shape, int highest, int& x, int& y) const;
    /// Take the place of a shape, and `gap` cells on all sides of it.
    void take(const UnwrapShape& shape, int x, int y, int gap);

private:
    bool fits_in_row(const UnwrapShape& shape, int y, int& x, std::vector<uint64_t>& blocked) const;

    int m_width, m_height;
    // At level k, a bit says whether any of the 2^k cells from it on is taken.
    std::vector<UnwrapBitmap> m_levels;
};

} // namespace vmlight
