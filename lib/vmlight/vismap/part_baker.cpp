// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/part_baker.h>

#include <vmlight/base/parallel.h>
#include <vmlight/base/tile_size.h>
#include <vmlight/vismap/reconstruct_map.h>

#include <algorithm>

namespace vmlight {

struct PartBaker::Worker
{
    VismapBaker::ScratchPointer scratch;
    std::unique_ptr<Reconstruction> reconstruction; // from its first tile on: its planes are large
    std::vector<float> raw, texels; // of one tile
    TileBits covered {};
    BakeCounts counts;
};

PartBaker::PartBaker(const VismapBaker& baker, int parts, int nthreads)
    : m_baker(baker)
    , m_threads(nthreads)
    , m_channels(size_t(baker.channels()))
    , m_pitch(kTileSize * m_channels)
    , m_reconstructs(is_reconstructed(baker.params()))
    , m_raw(baker, nthreads)
{
    for (int i = 0; i < worker_count(nthreads); ++i) {
        Worker& worker = *m_workers.emplace_back(std::make_unique<Worker>());
        worker.scratch = baker.scratch();
        worker.texels.resize(kTileSize * m_pitch);
    }
    if (m_reconstructs && parts > 1)
        m_raw.keep(texels_beyond_seams(baker, 0, baker.tiles_down(), nthreads, [](int, int, int) { return true; }));
}

PartBaker::~PartBaker() = default;

// The texels that the reconstruction of the tiles reads, by tile.
TexelSet PartBaker::surroundings(TileRange tiles) const
{
    constexpr int kHalo = NeighbourWindow::kHalo;
    const int width = m_baker.width(), height = m_baker.height();
    TexelSet wanted;
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
    return wanted;
}

void PartBaker::reconstruct(int tile, Worker& worker, BakeCounts& counts)
{
    const BakeCounts counted = m_baker.count_tile(tile, *worker.scratch);
    counts.add(counted);
    m_baker.cover_tile(tile, *worker.scratch, worker.covered);
    if (counted.covered == 0)
        return;
    const int left = tile % m_baker.tiles_across() * kTileSize, top = tile / m_baker.tiles_across() * kTileSize;
    const TileRow& raw = m_raw.at(top / kTileSize);
    const size_t row = size_t(m_baker.width()) * m_channels;
    for (int y = 0; y < raw.covered.height(); ++y)
        std::copy_n(&raw.texels[size_t(y) * row + size_t(left) * m_channels],
                    size_t(std::min(kTileSize, m_baker.width() - left)) * m_channels,
                    &worker.texels[size_t(y) * m_pitch]);
    worker.raw = worker.texels;
    if (!worker.reconstruction)
        worker.reconstruction = std::make_unique<Reconstruction>(m_baker.params(), m_baker.error().pattern_error,
                                                                 m_baker.error().error_scale);
    counts.dark += reconstruct_tile(
        *worker.reconstruction, m_baker, tile, [this](int x, int y) { return m_raw.find(x, y); }, worker.raw.data(),
        worker.texels.data(), m_pitch, raw.contexts);
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
    if (m_reconstructs && tiles.count() > 0) {
        const int across = m_baker.tiles_across(), last = (tiles.end - 1) / across;
        m_raw.set_window(std::max(0, tiles.first / across - 1), std::min(m_baker.tiles_down(), last + 2));
        if (!m_raw.bake(surroundings(tiles), progress.listener()))
            return false;
        counts.rays += m_raw.take_counts().rays;
    }
    const auto bake = [&](int64_t i, int index) {
        Worker& worker = *m_workers[size_t(index)];
        const int tile = tiles.first + int(i);
        if (!m_reconstructs)
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
