// SPDX-License-Identifier: Apache-2.0
/// Bakes some tiles of a map into an image that holds no more than them.
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/vismap/raw_texels.h>
#include <vmlight/vismap/tile_shares.h>

#include <OpenImageIO/imagebuf.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

namespace vmlight {

/// Progress over the tiles of several parts, by their expected cost.
struct PartProgress
{
    const std::vector<int64_t>& costs; ///< of the map's tiles
    int64_t all; ///< of the tiles to bake
    const Progress& progress;
    std::atomic<int64_t> done { 0 };

    void add(int tile) { done += costs[size_t(tile)]; }
    /// For parallel_items(). Empty if nobody listens.
    Progress listener()
    {
        return progress ? Progress([this](double) { return progress(double(done) / double(all)); }) : Progress();
    }
};

class PartBaker
{
public:
    /// @param baker    prepared; must outlive this
    /// @param parts    how many it bakes: of several it keeps what later ones need
    PartBaker(const VismapBaker& baker, int parts, int nthreads);
    ~PartBaker();

    /// Bake the texels of `tiles` that triangles cover.
    ///
    /// @param dst      float, with the map's channels first; if it has one more, that is `coverage`. Its window has the
    ///                 tiles. Other texels stay
    /// @param counts   set to those of the tiles; its rays are also those of surroundings that reconstruction needs
    /// @returns false if `progress` stopped it
    bool bake(OIIO::ImageBuf& dst, TileRange tiles, BakeCounts& counts, PartProgress& progress);

private:
    struct Worker;
    TexelSet surroundings(TileRange tiles) const;
    void reconstruct(int tile, Worker& worker, BakeCounts& counts);
    void put(OIIO::ImageBuf& dst, int tile, const Worker& worker) const;

    const VismapBaker& m_baker;
    const int m_threads;
    const size_t m_channels, m_pitch; // floats of a texel, and of a row of a tile
    const bool m_reconstructs;
    RawTexels m_raw; // if it is reconstructed
    std::vector<std::unique_ptr<Worker>> m_workers;
};

} // namespace vmlight
