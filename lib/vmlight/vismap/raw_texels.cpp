// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/raw_texels.h>

#include <vmlight/base/parallel.h>
#include <vmlight/base/tile_size.h>
#include <vmlight/vismap/bake_hints.h>

#include <algorithm>
#include <utility>

namespace vmlight {
namespace {

template <class Visit> void for_each_bit(const TileBits& bits, const Visit& visit)
{
    for (int y = 0; y < kTileSize; ++y)
        for (uint64_t row = bits[size_t(y)]; row; row &= row - 1)
            visit(__builtin_ctzll(row), y);
}

} // namespace

struct RawTexels::Worker
{
    VismapBaker::ScratchPointer scratch;
    std::vector<float> texels; // of one tile
    TexelContexts contexts;
    BakeCounts counts;
};

struct RawTexels::FoundTexel
{
    int x, y;
    std::vector<float> texel;
    TexelContext context;
};

RawTexels::RawTexels(const VismapBaker& baker, int nthreads)
    : m_baker(baker)
    , m_threads(nthreads)
    , m_reconstructs(is_reconstructed(baker.params()))
    , m_channels(size_t(baker.channels()))
    , m_pitch(size_t(baker.width()) * m_channels)
    , m_far(m_channels)
{
    for (int i = 0; i < worker_count(nthreads); ++i)
        m_workers.emplace_back(std::make_unique<Worker>())->scratch = baker.scratch();
}

RawTexels::~RawTexels() = default;

TileRow RawTexels::empty_row(int row) const
{
    const int rows = std::min(kTileSize, m_baker.height() - row * kTileSize);
    TileRow result { std::vector<float>(m_pitch * size_t(rows)), Coverage(m_baker.width(), rows), {} };
    if (m_reconstructs)
        result.contexts = TexelContexts(0, row * kTileSize, m_baker.width(), rows);
    return result;
}

void RawTexels::set_window(int first, int end)
{
    while (!m_rows.empty() && m_first != first) { // all of them if it moves up
        keep_before_drop(m_first);
        m_rows.pop_front();
        ++m_first;
    }
    if (m_rows.empty())
        m_first = first;
    while (this->end() < end)
        m_rows.push_back(empty_row(this->end()));
}

void RawTexels::keep_before_drop(int row)
{
    const int across = m_baker.tiles_across();
    const auto last = m_kept.lower_bound((row + 1) * across);
    for (auto tile = m_kept.lower_bound(row * across); tile != last; ++tile)
        for_each_bit(tile->second, [&, left = tile->first % across * kTileSize](int x, int y) {
            const BakedTexel baked = find(left + x, row * kTileSize + y);
            if (baked.context && !m_far.has(left + x, row * kTileSize + y))
                m_far.add(left + x, row * kTileSize + y, baked);
        });
}

BakedTexel RawTexels::find(int x, int y) const
{
    const int number = y / kTileSize;
    if (!has(number))
        return m_far.find(x, y);
    const TileRow& row = at(number);
    const TexelContext& context = row.contexts.at(x, y);
    return context.spacing > 0
        ? BakedTexel { &row.texels[size_t(y % kTileSize) * m_pitch + size_t(x) * m_channels], &context }
        : BakedTexel();
}

void RawTexels::bake_here(int tile, TileBits only, Worker& worker)
{
    const int number = tile / m_baker.tiles_across(), top = number * kTileSize;
    const int left = tile % m_baker.tiles_across() * kTileSize;
    TileRow& row = at(number);
    float* const texels = &row.texels[size_t(left) * m_channels];
    BakeHints hints;
    hints.only = &only;
    if (m_reconstructs) {
        hints.contexts = &row.contexts;
        const int columns = std::min(kTileSize, m_baker.width() - left);
        for_each_bit(only, [&](int x, int y) {
            if (x >= columns || y >= row.covered.height())
                return;
            TexelContext& context = row.contexts.at(left + x, top + y);
            const BakedTexel before = context.spacing > 0 ? BakedTexel {} : m_far.find(left + x, top + y);
            if (before.context) {
                std::copy_n(before.texel, m_channels, texels + size_t(y) * m_pitch + size_t(x) * m_channels);
                context = *before.context;
            }
            if (context.spacing > 0)
                only[size_t(y)] &= ~(uint64_t(1) << x);
        });
        if (only == TileBits {})
            return;
    }
    TileBits covered;
    worker.counts.add(m_baker.bake_tile(tile, *worker.scratch, texels, m_pitch, covered, &hints));
    for (int y = 0; y < row.covered.height(); ++y)
        row.covered.set_word(left, y, covered[size_t(y)]);
}

void RawTexels::bake_beside(std::vector<FoundTexel>& dst, int tile, const TileBits& only, Worker& worker)
{
    const int left = tile % m_baker.tiles_across() * kTileSize, top = tile / m_baker.tiles_across() * kTileSize;
    TileBits missing = only, covered;
    for_each_bit(only, [&](int x, int y) {
        if (m_far.has(left + x, top + y))
            missing[size_t(y)] &= ~(uint64_t(1) << x);
    });
    if (missing == TileBits {})
        return;
    worker.texels.resize(size_t(kTileSize) * kTileSize * m_channels);
    worker.contexts = TexelContexts(left, top, kTileSize, kTileSize);
    BakeHints hints;
    hints.only = &missing;
    hints.contexts = &worker.contexts;
    const BakeCounts counts
        = m_baker.bake_tile(tile, *worker.scratch, worker.texels.data(), kTileSize * m_channels, covered, &hints);
    worker.counts.rays += counts.rays;
    worker.counts.open += counts.open;
    for (size_t y = 0; y < missing.size(); ++y)
        missing[y] &= covered[y];
    for_each_bit(missing, [&](int x, int y) {
        const float* const texel = &worker.texels[(size_t(y) * kTileSize + size_t(x)) * m_channels];
        dst.push_back({ left + x, top + y, { texel, texel + m_channels }, worker.contexts.at(left + x, top + y) });
    });
}

bool RawTexels::bake(const TexelSet& wanted, const Progress& progress)
{
    const std::vector<std::pair<int, TileBits>> tiles(wanted.begin(), wanted.end());
    std::vector<std::vector<FoundTexel>> found(tiles.size());
    const auto work = [&](int64_t item, int index) {
        const auto& [tile, only] = tiles[size_t(item)];
        if (has(tile / m_baker.tiles_across()))
            bake_here(tile, only, *m_workers[size_t(index)]);
        else
            bake_beside(found[size_t(item)], tile, only, *m_workers[size_t(index)]);
    };
    if (!parallel_items(int64_t(tiles.size()), m_threads, work, progress))
        return false;
    for (const std::vector<FoundTexel>& texels : found)
        for (const FoundTexel& texel : texels)
            m_far.add(texel.x, texel.y, { texel.texel.data(), &texel.context });
    return true;
}

BakeCounts RawTexels::take_counts()
{
    BakeCounts counts;
    for (const auto& worker : m_workers) {
        counts.add(worker->counts);
        worker->counts = {};
    }
    return counts;
}

} // namespace vmlight
