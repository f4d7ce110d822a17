// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/uv/raster.h>

#include <atomic>
#include <cstdint>

namespace vmlight {

/// The fraction done of work on the tiles of a map, by the texels that triangles cover: where only a corner of the map
/// is covered, rows of empty tiles take no time, and must not make the rest look near.
class TileProgress
{
public:
    /// Counts the covered texels of all tiles, on all threads, if anyone listens.
    TileProgress(const UvRaster& raster, int nthreads, const Progress& progress);
    TileProgress(const TileProgress&) = delete;

    /// Whether the listener stopped the count: no work may start.
    bool stopped() const { return m_stopped; }

    /// A tile with so many covered texels is done. Any thread.
    void add(int64_t covered) { m_done += covered + 1; }

    /// For parallel_items(): tells the listener how much is done. Empty if there is none. This must outlive it.
    Progress listener();

private:
    const Progress& m_progress;
    bool m_stopped = false;
    int64_t m_all = 0; // covered texels, and one for each tile: 1 only where all tiles are done
    std::atomic<int64_t> m_done { 0 };
};

} // namespace vmlight
