// SPDX-License-Identifier: Apache-2.0
/// A map that is baked from the top down, a few rows of tiles at a time, and given away: only rows that others still
/// need stay in memory. Bit for bit the texels of make_vismap().
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/margin_rows.h>
#include <vmlight/vismap/raw_texels.h>

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
    /// @param baker    prepared; must outlive this
    BandBaker(const VismapBaker& baker, int nthreads);
    ~BandBaker();

    /// Bake the whole map; once. False if `progress` or `take` stopped it.
    bool bake(const MarginRows::TakeRows& take, const Progress& progress);

    /// After bake().
    const BakeCounts& counts() const { return m_counts; }
    const BandSeconds& seconds() const { return m_seconds; }

    /// What it holds at once, in bytes, besides texels beyond seams.
    static double held_bytes(const VismapParams& params, int channels, int nthreads);

private:
    struct Worker;

    bool bake_rows(int end, const Progress& progress);
    bool reconstruct_rows(std::vector<TileRow>& dst, int first, int end, const Progress& progress);

    const VismapBaker& m_baker;
    const int m_threads;
    const bool m_reconstructs;
    std::vector<std::unique_ptr<Worker>> m_workers;
    RawTexels m_raw;
    BakeCounts m_counts;
    BandSeconds m_seconds;
};

} // namespace vmlight
