// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/band_baker.h>

#include <vmlight/base/parallel.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/base/tile_size.h>
#include <vmlight/vismap/reconstruct_map.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace vmlight {
namespace {

// Rows of tiles that are given away at once: enough tiles for all threads, and much of what is filled for the margin of
// the rows beside them is used.
int band_rows(int tiles_across, int nthreads)
{
    constexpr int kTilesEach = 16, kLeast = 4;
    return std::max(kLeast, (kTilesEach * worker_count(nthreads) + tiles_across - 1) / tiles_across);
}

} // namespace

struct BandBaker::Worker
{
    std::unique_ptr<Reconstruction> reconstruction; // from its first tile on: its planes are large
    int64_t dark = 0;
};

double BandBaker::held_bytes(const VismapParams& params, int channels, int nthreads)
{
    const Size size = params.size();
    const int band = band_rows((size.width + kTileSize - 1) / kTileSize, nthreads);
    const double texels = double(size.width) * kTileSize, pixels = texels * channels * sizeof(float);
    // Rows as they were baked, and what the file's writer holds.
    const double raw = is_reconstructed(params) ? pixels + texels * sizeof(TexelContext) : 0;
    return raw * (band + MarginRows::reach(params.margin) + 3) + 1.5 * band * pixels
        + MarginRows::held_bytes(size.width, size.height, channels, params.margin, band);
}

BandBaker::BandBaker(const VismapBaker& baker, int nthreads)
    : m_baker(baker)
    , m_threads(nthreads)
    , m_reconstructs(is_reconstructed(baker.params()))
    , m_raw(baker, nthreads)
{
    for (int i = 0; i < worker_count(nthreads); ++i)
        m_workers.push_back(std::make_unique<Worker>());
}

BandBaker::~BandBaker() = default;

bool BandBaker::bake_rows(int end, const Progress& progress)
{
    const int first = m_raw.end(), across = m_baker.tiles_across();
    m_raw.set_window(m_raw.first(), end);
    TexelSet all;
    for (int tile = first * across; tile < end * across; ++tile)
        all[tile].fill(~uint64_t(0));
    return m_raw.bake(all, progress);
}

bool BandBaker::reconstruct_rows(std::vector<TileRow>& dst, int first, int end, const Progress& progress)
{
    const int across = m_baker.tiles_across();
    const size_t channels = size_t(m_baker.channels()), pitch = size_t(m_baker.width()) * channels;
    // Those of rows above the window were kept.
    const TexelSet ahead = texels_beyond_seams(m_baker, first, end, m_threads,
                                               [&](int, int, int y) { return y / kTileSize >= m_raw.end(); });
    if (!m_raw.bake(ahead, progress))
        return false;
    for (int row = first; row < end; ++row)
        dst.push_back({ m_raw.at(row).texels, m_raw.at(row).covered, {} });
    const FindTexel find_texel = [this](int x, int y) { return m_raw.find(x, y); };
    const auto work = [&](int64_t item, int index) {
        Worker& worker = *m_workers[size_t(index)];
        const int number = first + int(item) / across, tile = int(item) % across;
        const TileRow& raw = m_raw.at(number);
        bool is_covered = false;
        for (int y = 0; y < raw.covered.height(); ++y)
            is_covered |= raw.covered.word(tile * kTileSize, y) != 0;
        if (!is_covered)
            return;
        if (!worker.reconstruction)
            worker.reconstruction = std::make_unique<Reconstruction>(m_baker.params(), m_baker.error().pattern_error,
                                                                     m_baker.error().error_scale);
        const size_t at = size_t(tile) * kTileSize * channels;
        worker.dark += reconstruct_tile(*worker.reconstruction, m_baker, number * across + tile, find_texel,
                                        &raw.texels[at], &dst[size_t(number - first)].texels[at], pitch, raw.contexts);
    };
    return parallel_items(int64_t(end - first) * across, m_threads, work, progress);
}

bool BandBaker::bake(const MarginRows::TakeRows& take, const Progress& progress)
{
    const int rows = m_baker.tiles_down(), band = band_rows(m_baker.tiles_across(), m_threads);
    MarginRows margin(m_baker.width(), m_baker.height(), m_baker.channels(), m_baker.params().margin,
                      m_baker.margin_channels(), band);
    if (m_reconstructs)
        m_raw.keep(texels_beyond_seams(m_baker, 0, rows, m_threads,
                                       [](int row, int, int y) { return std::abs(y / kTileSize - row) > 1; }));
    for (int first = 0; first < rows; first += band) {
        const int end = std::min(rows, first + band), raw_end = m_reconstructs ? std::min(rows, end + 1) : end;
        Stopwatch timer;
        const double before = double(m_raw.end()) / rows, after = double(raw_end) / rows;
        if (!bake_rows(raw_end, part_of(progress, before, after)))
            return false;
        m_seconds.bake += timer.lap();
        std::vector<TileRow> done;
        if (m_reconstructs) {
            if (!reconstruct_rows(done, first, end, part_of(progress, after, after)))
                return false;
            m_seconds.reconstruct += timer.lap();
            m_raw.set_window(end - 1, raw_end);
        } else {
            for (int row = first; row < end; ++row)
                done.push_back(std::move(m_raw.at(row)));
            m_raw.set_window(raw_end, raw_end);
        }
        for (TileRow& row : done)
            if (!margin.add(std::move(row), take))
                return false;
    }
    m_seconds.margin = margin.seconds();
    m_counts = m_raw.take_counts();
    if (m_reconstructs) {
        m_counts.dark = 0;
        for (const auto& worker : m_workers)
            m_counts.dark += worker->dark;
    }
    return true;
}

} // namespace vmlight
