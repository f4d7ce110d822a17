// SPDX-License-Identifier: Apache-2.0
/// Texels of a map as they were baked, of some rows of tiles and beyond their seams: what reconstruction reads where
/// the whole map is not in memory. No texel is baked twice while it is kept.
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/far_texels.h>
#include <vmlight/vismap/map_rows.h>

#include <deque>
#include <memory>
#include <vector>

namespace vmlight {

class RawTexels
{
public:
    /// @param baker    prepared; must outlive this
    RawTexels(const VismapBaker& baker, int nthreads);
    ~RawTexels();

    /// Of all that are wanted beyond seams: keep those of rows that are dropped.
    void keep(TexelSet wanted) { m_kept = std::move(wanted); }
    /// Have the rows `first` to `end` - 1 in memory, and no other.
    void set_window(int first, int end);
    int first() const { return m_first; }
    int end() const { return m_first + int(m_rows.size()); }
    const TileRow& at(int row) const { return m_rows[size_t(row - m_first)]; }
    TileRow& at(int row) { return m_rows[size_t(row - m_first)]; }

    /// Bake those of the texels that are not there: in the window's rows, or beside them. False if `progress` stopped
    /// it.
    bool bake(const TexelSet& wanted, const Progress& progress);
    /// Two nullptr if it was not baked, or no triangle covers it. Valid until the next bake().
    BakedTexel find(int x, int y) const;
    /// Of all bakes since the last call.
    BakeCounts take_counts();

private:
    struct Worker;
    struct FoundTexel;

    bool has(int row) const { return row >= m_first && row < end(); }
    TileRow empty_row(int row) const;
    void bake_here(int tile, TileBits only, Worker& worker);
    void bake_beside(std::vector<FoundTexel>& dst, int tile, const TileBits& only, Worker& worker);
    void keep_before_drop(int row);

    const VismapBaker& m_baker;
    const int m_threads;
    const bool m_reconstructs;
    const size_t m_channels, m_pitch; // floats of a texel, and of a row of texels
    std::vector<std::unique_ptr<Worker>> m_workers;
    std::deque<TileRow> m_rows;
    int m_first = 0;
    TexelSet m_kept;
    FarTexels m_far;
};

} // namespace vmlight
