// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/band_baker.h>

#include <vmlight/base/parallel.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/base/tile_size.h>
#include <vmlight/vismap/bake_hints.h>

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
    VismapBaker::ScratchPointer scratch;
    std::unique_ptr<Reconstruction> reconstruction; // from its first tile on: its planes are large
    std::vector<float> texels; // of one tile
    TexelContexts contexts;
    BakeCounts counts;
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
    , m_far(m_channels)
{
    for (int i = 0; i < worker_count(nthreads); ++i)
        m_workers.emplace_back(std::make_unique<Worker>())->scratch = baker.scratch();
}

BandBaker::~BandBaker() = default;

int BandBaker::texel_rows(int row) const
{
    return std::min(kTileSize, m_baker.height() - row * kTileSize);
}

BandBaker::Row BandBaker::empty_row(int row) const
{
    const int rows = texel_rows(row);
    Row result { std::vector<float>(m_pitch * size_t(rows)), Coverage(m_baker.width(), rows), {} };
    if (m_reconstructs)
        result.contexts = TexelContexts(0, row * kTileSize, m_baker.width(), rows);
    return result;
}

BakedTexel BandBaker::find(int x, int y) const
{
    const int row = y / kTileSize;
    if (m_raw.has(row)) {
        const Row& there = m_raw.at(row);
        const TexelContext& context = there.contexts.at(x, y);
        return context.spacing > 0
            ? BakedTexel { &there.texels[size_t(y - row * kTileSize) * m_pitch + size_t(x) * m_channels], &context }
            : BakedTexel();
    }
    return m_far.find(x, y);
}

// Texels that were baked before their row are copied.
void BandBaker::bake_tile(Row& row, int tile, Worker& worker)
{
    const int left = tile % m_baker.tiles_across() * kTileSize, top = tile / m_baker.tiles_across() * kTileSize;
    float* const texels = &row.texels[size_t(left) * m_channels];
    TileBits only, covered;
    only.fill(~uint64_t(0));
    if (const auto wanted = m_wanted.find(tile); wanted != m_wanted.end())
        for (int y = 0; y < texel_rows(tile / m_baker.tiles_across()); ++y)
            for (uint64_t bits = wanted->second[size_t(y)]; bits; bits &= bits - 1) {
                const int x = __builtin_ctzll(bits);
                const BakedTexel known = m_far.find(left + x, top + y);
                if (!known.context)
                    continue;
                std::copy_n(known.texel, m_channels, texels + size_t(y) * m_pitch + size_t(x) * m_channels);
                row.contexts.at(left + x, top + y) = *known.context;
                only[size_t(y)] &= ~(uint64_t(1) << x);
            }
    BakeHints hints;
    hints.only = &only;
    hints.contexts = m_reconstructs ? &row.contexts : nullptr;
    worker.counts.add(m_baker.bake_tile(tile, *worker.scratch, texels, m_pitch, covered, &hints));
    for (int y = 0; y < row.covered.height(); ++y)
        row.covered.set_word(left, y, covered[size_t(y)]);
}

void BandBaker::keep_wanted(int row)
{
    for (int tile = row * m_baker.tiles_across(); tile < (row + 1) * m_baker.tiles_across(); ++tile) {
        const auto wanted = m_wanted.find(tile);
        if (wanted == m_wanted.end())
            continue;
        const int left = tile % m_baker.tiles_across() * kTileSize, top = row * kTileSize;
        for (int y = 0; y < texel_rows(row); ++y)
            for (uint64_t bits = wanted->second[size_t(y)]; bits; bits &= bits - 1) {
                const int x = left + __builtin_ctzll(bits);
                if (const BakedTexel baked = find(x, top + y); baked.context && !m_far.has(x, top + y))
                    m_far.add(x, top + y, baked);
            }
    }
}

bool BandBaker::bake_rows(int end, const Progress& progress)
{
    const int first = m_raw.end(), across = m_baker.tiles_across();
    for (int row = first; row < end; ++row)
        m_raw.rows.push_back(empty_row(row));
    const auto work = [&](int64_t item, int index) {
        const int row = first + int(item) / across;
        bake_tile(m_raw.rows[size_t(row - m_raw.first)], row * across + int(item) % across, *m_workers[size_t(index)]);
    };
    if (!parallel_items(int64_t(end - first) * across, m_threads, work, progress))
        return false;
    for (int row = first; row < end; ++row)
        keep_wanted(row);
    return true;
}

// Those that the reconstruction of rows `first` to `end` - 1 needs of rows that are not baked yet.
bool BandBaker::bake_ahead(int first, int end, const Progress& progress)
{
    const TexelSet wanted = texels_beyond_seams(m_baker, first, end, m_threads, [&](int, int x, int y) {
        return y / kTileSize >= m_raw.end() && !m_far.has(x, y);
    });
    struct Found
    {
        int x, y;
        std::vector<float> texel;
        TexelContext context;
    };
    const std::vector<std::pair<int, TileBits>> tiles(wanted.begin(), wanted.end());
    std::vector<std::vector<Found>> found(tiles.size());
    const auto work = [&](int64_t item, int index) {
        Worker& worker = *m_workers[size_t(index)];
        const auto& [tile, only] = tiles[size_t(item)];
        const int left = tile % m_baker.tiles_across() * kTileSize, top = tile / m_baker.tiles_across() * kTileSize;
        worker.texels.resize(size_t(kTileSize) * kTileSize * m_channels);
        worker.contexts = TexelContexts(left, top, kTileSize, kTileSize);
        BakeHints hints;
        hints.only = &only;
        hints.contexts = &worker.contexts;
        TileBits covered;
        const BakeCounts counts
            = m_baker.bake_tile(tile, *worker.scratch, worker.texels.data(), kTileSize * m_channels, covered, &hints);
        worker.counts.rays += counts.rays;
        worker.counts.open += counts.open;
        for (int y = 0; y < kTileSize; ++y)
            for (uint64_t bits = only[size_t(y)] & covered[size_t(y)]; bits; bits &= bits - 1) {
                const int x = __builtin_ctzll(bits);
                const float* const texel = &worker.texels[(size_t(y) * kTileSize + size_t(x)) * m_channels];
                found[size_t(item)].push_back(
                    { left + x, top + y, { texel, texel + m_channels }, worker.contexts.at(left + x, top + y) });
            }
    };
    if (!parallel_items(int64_t(tiles.size()), m_threads, work, progress))
        return false;
    for (const std::vector<Found>& texels : found)
        for (const Found& texel : texels)
            m_far.add(texel.x, texel.y, { texel.texel.data(), &texel.context });
    return true;
}

bool BandBaker::reconstruct_rows(int end, const Progress& progress)
{
    const int first = m_done.end(), across = m_baker.tiles_across();
    if (!bake_ahead(first, end, progress))
        return false;
    for (int row = first; row < end; ++row) {
        const Row& raw = m_raw.at(row);
        m_done.rows.push_back({ raw.texels, raw.covered, {} });
    }
    const FindTexel find_texel = [this](int x, int y) { return find(x, y); };
    const auto work = [&](int64_t item, int index) {
        Worker& worker = *m_workers[size_t(index)];
        const int number = first + int(item) / across, tile = int(item) % across;
        const Row& raw = m_raw.at(number);
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
                                &m_done.rows[size_t(number - m_done.first)].texels[at], m_pitch, raw.contexts);
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
        const Row& row = m_done.at(y / kTileSize);
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
        m_wanted = texels_beyond_seams(m_baker, 0, rows, m_threads,
                                       [](int row, int, int y) { return std::abs(y / kTileSize - row) > 1; });
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
            m_raw.drop_before(done_end - 1);
        } else {
            for (Row& row : m_raw.rows)
                m_done.rows.push_back(std::move(row));
            m_raw.drop_before(raw_end);
        }
        if (!give(first, end, take))
            return false;
        m_done.drop_before(end - reach);
    }
    for (const auto& worker : m_workers)
        m_counts.add(worker->counts);
    if (m_reconstructs) {
        m_counts.dark = 0;
        for (const auto& worker : m_workers)
            m_counts.dark += worker->dark;
    }
    return true;
}

} // namespace vmlight
