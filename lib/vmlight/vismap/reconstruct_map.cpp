// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/reconstruct_map.h>

#include <vmlight/base/parallel.h>
#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/seam_links.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace vmlight {
namespace {

// Of the islands that have a texel in the tile.
std::vector<Continuation> continuations_of(const SeamLinks& seams, OIIO::ROI own, const FindTexel& find,
                                           const TexelContexts& contexts)
{
    std::vector<SeamCell> cells;
    seams.find(own, cells);
    std::vector<Continuation> result;
    if (cells.empty())
        return result;
    std::vector<uint32_t> islands;
    for (int y = own.ybegin; y < own.yend; ++y)
        for (int x = own.xbegin; x < own.xend; ++x)
            if (const TexelContext& context = contexts.at(x, y); context.spacing > 0)
                if (islands.empty() || islands.back() != context.island)
                    islands.push_back(context.island);
    std::sort(islands.begin(), islands.end());
    const auto is_in_map = [&](const SeamCell& cell) {
        return cell.x >= 0 && cell.y >= 0 && cell.x < seams.width() && cell.y < seams.height();
    };
    const SeamCell* done = nullptr; // the last that has a texel or needs none: nearer seams come first
    for (const SeamCell& cell : cells) {
        if (done && done->island == cell.island && done->x == cell.x && done->y == cell.y)
            continue;
        if (!std::binary_search(islands.begin(), islands.end(), cell.island))
            continue;
        const BakedTexel here = is_in_map(cell) ? find(cell.x, cell.y) : BakedTexel();
        if (here.context && here.context->island == cell.island) {
            done = &cell;
            continue;
        }
        const BakedTexel there = find(cell.source_x, cell.source_y);
        if (!there.context)
            continue;
        done = &cell;
        result.push_back({ cell.island, cell.x - own.xbegin, cell.y - own.ybegin, there.texel, there.context });
    }
    return result;
}

} // namespace

int64_t reconstruct_tile(Reconstruction& reconstruction, const VismapBaker& baker, int tile, const FindTexel& find,
                         const float* raw, float* texels, size_t pitch, const TexelContexts& contexts)
{
    constexpr int kHalo = NeighbourWindow::kHalo;
    const int left = tile % baker.tiles_across() * kTileSize, top = tile / baker.tiles_across() * kTileSize;
    const OIIO::ROI own(left, std::min(left + kTileSize, baker.width()), top,
                        std::min(top + kTileSize, baker.height()));
    reconstruction.clear();
    for (int y = std::max(0, top - kHalo); y < std::min(baker.height(), own.yend + kHalo); ++y)
        for (int x = std::max(0, left - kHalo); x < std::min(baker.width(), own.xend + kHalo); ++x)
            if (const BakedTexel baked = find(x, y); baked.context)
                reconstruction.add(x - left, y - top, baked.texel, *baked.context);
    return reconstruction.apply(raw, texels, pitch, left, top, contexts,
                                continuations_of(baker.seams(), own, find, contexts));
}

bool reconstruct_map(const VismapBaker& baker, float* pixels, const TexelContexts& contexts, int64_t& dark,
                     int nthreads, const Progress& progress)
{
    struct Worker
    {
        std::unique_ptr<Reconstruction> reconstruction; // from its first tile on: its planes are large
        int64_t dark = 0;
    };
    std::vector<Worker> workers(static_cast<size_t>(worker_count(nthreads)));
    const int width = baker.width(), height = baker.height();
    const auto channels = size_t(baker.channels());
    const size_t pitch = size_t(width) * channels;
    const std::vector<float> raw(pixels, pixels + pitch * size_t(height));
    const FindTexel find = [&](int x, int y) {
        const TexelContext& context = contexts.at(x, y);
        return context.spacing > 0 ? BakedTexel { &raw[size_t(y) * pitch + size_t(x) * channels], &context }
                                   : BakedTexel();
    };
    const auto is_covered = [&](int left, int top) {
        for (int y = top; y < std::min(height, top + kTileSize); ++y)
            for (int x = left; x < std::min(width, left + kTileSize); ++x)
                if (contexts.at(x, y).spacing > 0)
                    return true;
        return false;
    };
    const auto work = [&](int64_t tile, int index) {
        Worker& worker = workers[size_t(index)];
        const int left = int(tile % baker.tiles_across()) * kTileSize;
        const int top = int(tile / baker.tiles_across()) * kTileSize;
        const size_t first = size_t(top) * pitch + size_t(left) * channels;
        if (!is_covered(left, top))
            return;
        if (!worker.reconstruction)
            worker.reconstruction = std::make_unique<Reconstruction>(baker.params(), baker.error().pattern_error,
                                                                     baker.error().error_scale);
        worker.dark += reconstruct_tile(*worker.reconstruction, baker, int(tile), find, &raw[first], pixels + first,
                                        pitch, contexts);
    };
    if (!parallel_items(int64_t(baker.tiles_across()) * baker.tiles_down(), nthreads, work, progress))
        return false;
    dark = 0;
    for (const Worker& worker : workers)
        dark += worker.dark;
    return true;
}

} // namespace vmlight
