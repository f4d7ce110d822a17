// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/far_texels.h>

#include <vmlight/base/parallel.h>
#include <vmlight/base/tile_size.h>

#include <algorithm>

namespace vmlight {

TexelSet texels_beyond_seams(const VismapBaker& baker, int first, int end, int nthreads,
                             const std::function<bool(int row, int x, int y)>& wants)
{
    const int width = baker.width(), height = baker.height();
    std::vector<TexelSet> found(size_t(std::max(0, end - first)));
    parallel_items(int64_t(found.size()), nthreads, [&](int64_t item, int) {
        const int row = first + int(item), y = row * kTileSize;
        std::vector<SeamCell> cells;
        for (int x = 0; x < width; x += kTileSize) {
            baker.seams().find({ x, std::min(x + kTileSize, width), y, std::min(y + kTileSize, height) }, cells);
            for (const SeamCell& cell : cells)
                if (cell.source_x >= 0 && cell.source_y >= 0 && cell.source_x < width && cell.source_y < height
                    && wants(row, cell.source_x, cell.source_y))
                    found[size_t(item)][cell.source_y / kTileSize * baker.tiles_across() + cell.source_x / kTileSize]
                         [size_t(cell.source_y % kTileSize)]
                        |= uint64_t(1) << cell.source_x % kTileSize;
        }
    });
    TexelSet all;
    for (const TexelSet& of_row : found)
        for (const auto& [tile, bits] : of_row)
            for (size_t y = 0; y < bits.size(); ++y)
                all[tile][y] |= bits[y];
    return all;
}

void FarTexels::add(int x, int y, const BakedTexel& baked)
{
    m_numbers.emplace(key(x, y), m_contexts.size());
    m_texels.insert(m_texels.end(), baked.texel, baked.texel + m_channels);
    m_contexts.push_back(*baked.context);
}

BakedTexel FarTexels::find(int x, int y) const
{
    const auto found = m_numbers.find(key(x, y));
    return found == m_numbers.end() ? BakedTexel()
                                    : BakedTexel { &m_texels[found->second * m_channels], &m_contexts[found->second] };
}

} // namespace vmlight
