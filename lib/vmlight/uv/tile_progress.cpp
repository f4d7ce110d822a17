// SPDX-License-Identifier: Apache-2.0
#include <vmlight/uv/tile_progress.h>

#include <vmlight/base/parallel.h>

#include <memory>
#include <vector>

namespace vmlight {

TileProgress::TileProgress(const UvRaster& raster, int nthreads, const Progress& progress)
    : m_progress(progress)
{
    const int64_t tiles = int64_t(raster.tiles_across()) * raster.tiles_down();
    m_all = tiles;
    if (!progress)
        return;
    struct Worker
    {
        TileCover cover;
        int64_t covered = 0;
    };
    std::vector<std::unique_ptr<Worker>> workers(size_t(worker_count(nthreads)));
    for (auto& worker : workers)
        worker = std::make_unique<Worker>();
    const auto count = [&](int64_t tile, int index) {
        Worker& worker = *workers[size_t(index)];
        raster.cover(int(tile), worker.cover);
        worker.covered += worker.cover.covered;
    };
    m_stopped = !parallel_items(tiles, nthreads, count, [&](double) { return progress(0); });
    for (const auto& worker : workers)
        m_all += worker->covered;
}

Progress TileProgress::listener()
{
    if (!m_progress)
        return {};
    return [this](double) { return m_progress(double(m_done) / double(m_all)); };
}

} // namespace vmlight
