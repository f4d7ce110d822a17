// SPDX-License-Identifier: Apache-2.0
/// A map that is baked from the top down, a few rows of tiles at a time, and given away: only rows that others still
/// need stay in memory. Bit for bit the texels of make_vismap().
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/raw_texels.h>

#include <deque>
#include <functional>
#include <memory>
#include <vector>

namespace vmlight {

/// Seconds of each step.
struct BandSeconds
{
    double bake = 0, reconstruct = 0, margin = 0;
};

class BandBaker
{
public:
    /// Receives rows of texels from `ybegin` to `yend` - 1, whole rows of tiles, all channels, with their margin.
    /// Returning false stops the bake.
    using TakeRows = std::function<bool(int ybegin, int yend, const float* texels)>;

    /// @param baker    prepared; must outlive this
    BandBaker(const VismapBaker& baker, int nthreads);
    ~BandBaker();

    /// Bake the whole map; once. False if `progress` or `take` stopped it.
    bool bake(const TakeRows& take, const Progress& progress);

    /// After bake().
    const BakeCounts& counts() const { return m_counts; }
    const BandSeconds& seconds() const { return m_seconds; }

    /// Whether a margin this wide can be filled without the whole map: it needs two rows of tiles above and below.
    static bool can_fill(int margin);
    /// What it holds at once, in bytes.
    static double held_bytes(const VismapParams& params, int channels, int nthreads);

private:
    struct Worker;

    bool bake_rows(int end, const Progress& progress);
    bool reconstruct_rows(int end, const Progress& progress);
    bool give(int first, int end, const TakeRows& take);

    const VismapBaker& m_baker;
    const int m_threads, m_margin;
    const bool m_reconstructs;
    const size_t m_channels, m_pitch; // floats of a texel, and of a row of texels
    std::vector<std::unique_ptr<Worker>> m_workers;
    RawTexels m_raw;
    // Without their margin, from the row m_first_done on.
    std::deque<TileRow> m_done;
    int m_first_done = 0;
    BakeCounts m_counts;
    BandSeconds m_seconds;
};

} // namespace vmlight
