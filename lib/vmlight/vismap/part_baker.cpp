// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/part_baker.h>

#include <vmlight/base/parallel.h>
#include <vmlight/base/tile_size.h>
#include <vmlight/vismap/bake_hints.h>
#include <vmlight/vismap/reconstruct_map.h>

#include <algorithm>
#include <map>

namespace vmlight {

struct PartBaker::Worker
{
    VismapBaker::ScratchPointer scratch;
    std::unique_ptr<Reconstruction> reconstruction; // nullptr if the map is not reconstructed
    std::vector<float> raw, texels; // of one tile
    TileBits covered {};
    BakeCounts counts;
};

PartBaker::PartBaker(const VismapBaker& baker, int nthreads)
    : m_baker(baker)
    , m_threads(nthreads)
    , m_channels(size_t(baker.channels()))
    , m_pitch(kTileSize * m_channels)
{
    const bool reconstructs = is_reconstructed(baker.params());
    for (int i = 0; i < worker_count(nthreads); ++i) {
        Worker& worker = *m_workers.emplace_back(std::make_unique<Worker>());
        worker.scratch = baker.scratch();
        worker.texels.resize(kTileSize * m_pitch);
        if (reconstructs)
            worker.reconstruction = std::make_unique<Reconstruction>(baker.params(), baker.error().pattern_error,
                                                                     baker.error().error_scale);
    }
    if (reconstructs) {
        m_raw.resize(size_t(baker.width()) * size_t(baker.height()) * m_channels);
        m_contexts = TexelContexts(0, 0, baker.width(), baker.height());
    }
}

PartBaker::~PartBaker() = default;

// The texels that the reconstruction of the tiles reads, by tile.
std::vector<std::pair<int, TileBits>> PartBaker::surroundings(TileRange tiles) const
{
    constexpr int kHalo = NeighbourWindow::kHalo;
    const int width = m_baker.width(), height = m_baker.height();
    std::map<int, TileBits> wanted;
    const auto want = [&](int x, int y) {
        if (x >= 0 && y >= 0 && x < width && y < height)
            wanted[y / kTileSize * m_baker.tiles_across() + x / kTileSize][size_t(y % kTileSize)] |= uint64_t(1)
                << x % kTileSize;
    };
    std::vector<SeamCell> cells;
    for (int tile = tiles.first; tile < tiles.end; ++tile) {
        const int left = tile % m_baker.tiles_across() * kTileSize, top = tile / m_baker.tiles_across() * kTileSize;
        const OIIO::ROI own(left, std::min(left + kTileSize, width), top, std::min(top + kTileSize, height));
        for (int y = own.ybegin - kHalo; y < own.yend + kHalo; ++y)
            for (int x = own.xbegin - kHalo; x < own.xend + kHalo; ++x)
                want(x, y);
        m_baker.seams().find(own, cells);
        for (const SeamCell& cell : cells) {
            want(cell.x, cell.y);
            want(cell.source_x, cell.source_y);
        }
    }
    return { wanted.begin(), wanted.end() };
}

// Those of the wanted texels that no part before has baked.
void PartBaker::bake_missing(int tile, TileBits wanted, Worker& worker, BakeCounts& counts)
{
    const int left = tile % m_baker.tiles_across() * kTileSize, top = tile / m_baker.tiles_across() * kTileSize;
    for (int y = 0; y < std::min(kTileSize, m_baker.height() - top); ++y)
        for (int x = 0; x < std::min(kTileSize, m_baker.width() - left); ++x)
            if (m_contexts.at(left + x, top + y).spacing > 0)
                wanted[size_t(y)] &= ~(uint64_t(1) << x);
    if (wanted == TileBits {})
        return;
    BakeHints hints;
    hints.only = &wanted;
    hints.contexts = &m_contexts;
    const size_t row = size_t(m_baker.width()) * m_channels;
    counts.rays += m_baker
                       .bake_tile(tile, *worker.scratch, &m_raw[size_t(top) * row + size_t(left) * m_channels], row,
                                  worker.covered, &hints)
                       .rays;
}

void PartBaker::reconstruct(int tile, Worker& worker, BakeCounts& counts)
{
    const BakeCounts counted = m_baker.count_tile(tile, *worker.scratch);
    counts.add(counted);
    m_baker.cover_tile(tile, *worker.scratch, worker.covered);
    if (counted.covered == 0)
        return;
    const int left = tile % m_baker.tiles_across() * kTileSize, top = tile / m_baker.tiles_across() * kTileSize;
    const size_t row = size_t(m_baker.width()) * m_channels;
    worker.raw.resize(worker.texels.size());
    for (int y = 0; y < std::min(kTileSize, m_baker.height() - top); ++y)
        std::copy_n(&m_raw[size_t(top + y) * row + size_t(left) * m_channels],
                    size_t(std::min(kTileSize, m_baker.width() - left)) * m_channels, &worker.raw[size_t(y) * m_pitch]);
    worker.texels = worker.raw;
    const FindTexel find = [&](int x, int y) {
        const TexelContext& context = m_contexts.at(x, y);
        return context.spacing > 0 ? BakedTexel { &m_raw[size_t(y) * row + size_t(x) * m_channels], &context }
                                   : BakedTexel();
    };
    counts.dark += reconstruct_tile(*worker.reconstruction, m_baker, tile, find, worker.raw.data(),
                                    worker.texels.data(), m_pitch, m_contexts);
}

void PartBaker::put(OIIO::ImageBuf& dst, int tile, const Worker& worker) const
{
    const OIIO::ImageSpec& spec = dst.spec();
    float* const pixels = static_cast<float*>(dst.localpixels());
    const int left = tile % m_baker.tiles_across() * kTileSize, top = tile / m_baker.tiles_across() * kTileSize;
    for (int y = 0; y < kTileSize; ++y)
        for (int x = 0; x < kTileSize; ++x) {
            if (!(worker.covered[size_t(y)] >> x & 1))
                continue;
            float* const texel = pixels
                + (size_t(top + y - spec.y) * size_t(spec.width) + size_t(left + x - spec.x)) * size_t(spec.nchannels);
            std::copy_n(&worker.texels[size_t(y) * m_pitch + size_t(x) * m_channels], m_channels, texel);
            if (size_t(spec.nchannels) > m_channels)
                texel[m_channels] = 1;
        }
}

bool PartBaker::bake(OIIO::ImageBuf& dst, TileRange tiles, BakeCounts& counts, PartProgress& progress)
{
    for (const auto& worker : m_workers)
        worker->counts = {};
    if (!m_raw.empty()) {
        const auto wanted = surroundings(tiles);
        const auto trace = [&](int64_t i, int index) {
            Worker& worker = *m_workers[size_t(index)];
            bake_missing(wanted[size_t(i)].first, wanted[size_t(i)].second, worker, worker.counts);
        };
        if (!parallel_items(int64_t(wanted.size()), m_threads, trace, progress.listener()))
            return false;
    }
    const auto bake = [&](int64_t i, int index) {
        Worker& worker = *m_workers[size_t(index)];
        const int tile = tiles.first + int(i);
        if (m_raw.empty())
            worker.counts.add(m_baker.bake_tile(tile, *worker.scratch, worker.texels.data(), m_pitch, worker.covered));
        else
            reconstruct(tile, worker, worker.counts);
        put(dst, tile, worker);
        progress.add(tile);
    };
    if (!parallel_items(tiles.count(), m_threads, bake, progress.listener()))
        return false;
    for (const auto& worker : m_workers)
        counts.add(worker->counts);
    return true;
}

} // namespace vmlight
