// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/tile_shares.h>

#include <vmlight/base/parallel.h>

#include <algorithm>
#include <numeric>

namespace vmlight {
namespace {

// Costs, relative to a tile that no triangle covers: of a covered texel, and of one that traces rays.
constexpr int64_t kCoveredCost = 1, kTracedCost = 16;

} // namespace

bool share_tiles(TileShares& dst, const VismapBaker& baker, int count, int nthreads, const Progress& progress)
{
    struct Worker
    {
        VismapBaker::ScratchPointer scratch;
        BakeCounts counts;
    };
    std::vector<Worker> workers(static_cast<size_t>(worker_count(nthreads)));
    for (Worker& worker : workers)
        worker.scratch = baker.scratch();
    const int tiles = baker.tiles_across() * baker.tiles_down();
    dst = {};
    dst.costs.resize(size_t(tiles));
    const auto weigh = [&](int64_t tile, int index) {
        Worker& worker = workers[size_t(index)];
        const BakeCounts counts = baker.count_tile(int(tile), *worker.scratch);
        dst.costs[size_t(tile)] = 1 + kCoveredCost * counts.covered + kTracedCost * (counts.covered - counts.open);
        worker.counts.add(counts);
    };
    const Progress listen = progress ? Progress([&](double) { return progress(0); }) : Progress();
    if (!parallel_items(tiles, nthreads, weigh, listen))
        return false;
    for (const Worker& worker : workers)
        dst.counts.add(worker.counts);

    // A tile goes to the part in whose share of the cost its middle is.
    const int64_t total = std::accumulate(dst.costs.begin(), dst.costs.end(), int64_t(0));
    dst.ranges.resize(size_t(count));
    int64_t before = 0;
    int part = 0;
    for (int tile = 0; tile < tiles; ++tile) {
        const int64_t cost = dst.costs[size_t(tile)], twice_middle = 2 * before + cost;
        while (twice_middle * count >= 2 * total * (part + 1)) {
            dst.ranges[size_t(part++)].end = tile;
            dst.ranges[size_t(part)].first = tile;
        }
        before += cost;
    }
    for (; part < count; ++part) {
        dst.ranges[size_t(part)].end = tiles;
        if (part + 1 < count)
            dst.ranges[size_t(part) + 1].first = tiles;
    }
    return true;
}

} // namespace vmlight
