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

// A margin wider than this would need the better part of most maps.
constexpr int kFarthestRows = 2;

// Rows of tiles that are given away at once: enough tiles for all threads, and much of what is filled for the margin of
// the rows beside them is used.
int band_rows(int tiles_across, int nthreads)
{
    constexpr int kTilesEach = 16, kLeast = 4;
    return std::max(kLeast, (kTilesEach * worker_count(nthreads) + tiles_across - 1) / tiles_across);
}

int margin_rows(int margin)
{
    return (margin + kTileSize - 1) / kTileSize;
}

// Some of a whole.
Progress within(const Progress& whole, double first, double last)
{
    if (!whole)
        return {};
    return [&whole, first, last](double done) { return whole(first + (last - first) * done); };
}

} // namespace

struct BandBaker::Worker
{
    std::unique_ptr<Reconstruction> reconstruction; // from its first tile on: its planes are large
    int64_t dark = 0;
};

bool BandBaker::can_fill(int margin)
{
    return margin >= 0 && margin_rows(margin) <= kFarthestRows;
}

double BandBaker::held_bytes(const VismapParams& params, int channels, int nthreads)
{
    const int tiles_across = (params.size().width + kTileSize - 1) / kTileSize;
    const double band = band_rows(tiles_across, nthreads), reach = margin_rows(params.margin);
    const double texels = double(params.size().width) * kTileSize, pixels = texels * channels * sizeof(float);
    const double raw = is_reconstructed(params) ? (band + reach + 3) * (pixels + texels * sizeof(TexelContext)) : 0;
    // The rows themselves, the copy whose margin is filled, and what the file's writer holds of it.
    return raw + (band + 2 * reach) * 2 * pixels + 1.5 * band * pixels;
}

BandBaker::BandBaker(const VismapBaker& baker, int nthreads)
    : m_baker(baker)
    , m_threads(nthreads)
    , m_margin(baker.params().margin)
    , m_reconstructs(is_reconstructed(baker.params()))
    , m_channels(size_t(baker.channels()))
    , m_pitch(size_t(baker.width()) * m_channels)
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

bool BandBaker::reconstruct_rows(int end, const Progress& progress)
{
    const int first = m_first_done + int(m_done.size()), across = m_baker.tiles_across();
    // Those of rows above the window were kept.
    const TexelSet ahead = texels_beyond_seams(m_baker, first, end, m_threads,
                                               [&](int, int, int y) { return y / kTileSize >= m_raw.end(); });
    if (!m_raw.bake(ahead, progress))
        return false;
    for (int row = first; row < end; ++row)
        m_done.push_back({ m_raw.at(row).texels, m_raw.at(row).covered, {} });
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
        const size_t at = size_t(tile) * kTileSize * m_channels;
        worker.dark
            += reconstruct_tile(*worker.reconstruction, m_baker, number * across + tile, find_texel, &raw.texels[at],
                                &m_done[size_t(number - m_first_done)].texels[at], m_pitch, raw.contexts);
    };
    return parallel_items(int64_t(end - first) * across, m_threads, work, progress);
}

// Rows `first` to `end` - 1, of a copy in which the margin is filled: the rows below need them without it.
bool BandBaker::give(int first, int end, const TakeRows& take)
{
    Stopwatch timer;
    const int ybegin = first * kTileSize, yend = std::min(m_baker.height(), end * kTileSize);
    const int top = std::max(0, ybegin - m_margin), bottom = std::min(m_baker.height(), yend + m_margin);
    std::vector<float> texels(m_pitch * size_t(bottom - top));
    Coverage covered(m_baker.width(), bottom - top);
    for (int y = top; y < bottom; ++y) {
        const TileRow& row = m_done[size_t(y / kTileSize - m_first_done)];
        std::copy_n(&row.texels[size_t(y % kTileSize) * m_pitch], m_pitch, &texels[size_t(y - top) * m_pitch]);
        for (int x = 0; x < m_baker.width(); x += kTileSize)
            covered.set_word(x, y - top, row.covered.word(x, y % kTileSize));
    }
    fill_margin(texels.data(), int(m_channels), covered, m_margin, m_baker.margin_channels());
    m_seconds.margin += timer();
    return take(ybegin, yend, &texels[size_t(ybegin - top) * m_pitch]);
}

bool BandBaker::bake(const TakeRows& take, const Progress& progress)
{
    const int rows = m_baker.tiles_down(), reach = margin_rows(m_margin);
    const int band = band_rows(m_baker.tiles_across(), m_threads);
    if (m_reconstructs)
        m_raw.keep(texels_beyond_seams(m_baker, 0, rows, m_threads,
                                       [](int row, int, int y) { return std::abs(y / kTileSize - row) > 1; }));
    for (int first = 0; first < rows; first += band) {
        const int end = std::min(rows, first + band), done_end = std::min(rows, end + reach);
        const int raw_end = m_reconstructs ? std::min(rows, done_end + 1) : done_end;
        Stopwatch timer;
        const double before = double(m_raw.end()) / rows, after = double(raw_end) / rows;
        if (!bake_rows(raw_end, within(progress, before, after)))
            return false;
        m_seconds.bake += timer.lap();
        if (m_reconstructs) {
            if (!reconstruct_rows(done_end, within(progress, after, after)))
                return false;
            m_seconds.reconstruct += timer.lap();
            m_raw.set_window(done_end - 1, raw_end);
        } else {
            for (int row = m_raw.first(); row < raw_end; ++row)
                m_done.push_back(std::move(m_raw.at(row)));
            m_raw.set_window(raw_end, raw_end);
        }
        if (!give(first, end, take))
            return false;
        for (; m_first_done < end - reach; ++m_first_done)
            m_done.pop_front();
    }
    m_counts = m_raw.take_counts();
    if (m_reconstructs) {
        m_counts.dark = 0;
        for (const auto& worker : m_workers)
            m_counts.dark += worker->dark;
    }
    return true;
}

} // namespace vmlight
