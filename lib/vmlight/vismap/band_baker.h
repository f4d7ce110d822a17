// SPDX-License-Identifier: Apache-2.0
/// A map that is baked from the top down, a few rows of tiles at a time, and given away: only rows that others still
/// need stay in memory. Bit for bit the texels of make_vismap().
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/uv/margin.h>
#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/far_texels.h>
#include <vmlight/vismap/reconstruct_map.h>

#include <cstdint>
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
    /// A row of tiles.
    struct Row
    {
        std::vector<float> texels;
        Coverage covered;
        TexelContexts contexts;
    };
    /// Rows `first` to end() - 1.
    struct Rows
    {
        std::deque<Row> rows;
        int first = 0;

        int end() const { return first + int(rows.size()); }
        bool has(int row) const { return row >= first && row < end(); }
        const Row& at(int row) const { return rows[size_t(row - first)]; }
        void drop_before(int row)
        {
            for (; first < row && !rows.empty(); ++first)
                rows.pop_front();
        }
    };
    struct Worker;

    int texel_rows(int row) const;
    Row empty_row(int row) const;
    BakedTexel find(int x, int y) const;
    bool bake_rows(int end, const Progress& progress);
    void bake_tile(Row& row, int tile, Worker& worker);
    void keep_wanted(int row);
    bool bake_ahead(int first, int end, const Progress& progress);
    bool reconstruct_rows(int end, const Progress& progress);
    bool give(int first, int end, const TakeRows& take);

    const VismapBaker& m_baker;
    const int m_threads, m_margin;
    const bool m_reconstructs;
    const size_t m_channels, m_pitch; // floats of a texel, and of a row of texels
    std::vector<std::unique_ptr<Worker>> m_workers;
    Rows m_raw, m_done; // as baked; and without their margin alone
    // Those that rows far from their own need, beyond a seam; and those of them that are baked, some before their row.
    TexelSet m_wanted;
    FarTexels m_far;
    BakeCounts m_counts;
    BandSeconds m_seconds;
};

} // namespace vmlight
