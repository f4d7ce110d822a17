// SPDX-License-Identifier: Apache-2.0
/// A map's tiles divided into parts that cost about the same.
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/vismap/baker.h>

#include <cstdint>
#include <vector>

namespace vmlight {

/// Tiles `first` to `end` - 1, row by row.
struct TileRange
{
    int first = 0, end = 0;

    int count() const { return end - first; }
};

struct TileShares
{
    /// Consecutive, and together all tiles. Some are empty if there are fewer tiles than parts.
    std::vector<TileRange> ranges;
    /// Expected cost of each tile, in some unit.
    std::vector<int64_t> costs;
    /// Covered and overlapping texels of the whole map.
    BakeCounts counts;
};

/// Divide the tiles of a map into `count` parts. A function of the map alone: every machine divides it alike. Traces no
/// ray. False if `progress` stopped it.
bool share_tiles(TileShares& dst, const VismapBaker& baker, int count, int nthreads, const Progress& progress);

} // namespace vmlight
