// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/reconstruct_pilot.h>

#include <vmlight/base/parallel.h>
#include <vmlight/math/sampling.h>
#include <vmlight/vismap/texel_spacing.h>

#include <algorithm>
#include <cstdint>
#include <memory>

namespace vmlight {
namespace {

// One window for so many covered texels, within limits.
constexpr int64_t kTexelsPerWindow = 128, kLeastWindows = 64, kMostWindows = 256;

} // namespace

bool ReconstructPilot::pick(const UvRaster& raster, const OpenTriangles& open, const SeamLinks& seams)
{
    const int64_t wanted = std::clamp(m_pilot.covered() / kTexelsPerWindow, kLeastWindows, kMostWindows);
    m_windows.resize(size_t(std::min(wanted, m_pilot.texels())));
    const double run = double(m_pilot.texels()) / double(std::max<size_t>(1, m_windows.size()));
    std::vector<Texel*> texels;
    for (size_t k = 0; k < m_windows.size(); ++k) {
        // A random one of each run: equal steps might all fall into one column of a tile.
        const double chance = texel_hash(uint32_t(k), 1, 0).u * 0x1p-32;
        const auto [left, top] = m_pilot.place(std::min(m_pilot.texels() - 1, int64_t((double(k) + chance) * run)));
        for (int i = 0; i < kSide * kSide; ++i) {
            Texel& texel = m_windows[k][size_t(i)];
            texel.x = left + i % kSide - kSide / 2;
            texel.y = top + i / kSide - kSide / 2;
            texels.push_back(&texel);
        }
    }
    return fill(texels, raster, open, seams) && continue_windows(raster, open, seams);
}

bool ReconstructPilot::fill(const std::vector<Texel*>& texels, const UvRaster& raster, const OpenTriangles& open,
                            const SeamLinks& seams) const
{
    const int width = m_params.size().width, height = m_params.size().height;
    std::vector<std::vector<Texel*>> tiles(size_t(raster.tiles_across()) * size_t(raster.tiles_down()));
    for (Texel* texel : texels)
        if (texel->x >= 0 && texel->y >= 0 && texel->x < width && texel->y < height)
            tiles[size_t(texel->y / kTileSize * raster.tiles_across() + texel->x / kTileSize)].push_back(texel);
    struct Worker
    {
        TileCover cover;
        std::unique_ptr<Surface> surface;
        std::unique_ptr<TexelSpacing> spacing;
    };
    std::vector<Worker> workers(static_cast<size_t>(worker_count(m_threads)));
    for (Worker& worker : workers) {
        worker.surface = std::make_unique<Surface>(m_scene.mesh(), m_scene.frame());
        worker.spacing = std::make_unique<TexelSpacing>(m_scene.mesh(), m_scene.frame(), width, height);
    }
    const auto fill_tile = [&](int64_t tile, int index) {
        auto& [cover, surface, spacing] = workers[size_t(index)];
        if (tiles[size_t(tile)].empty())
            return;
        raster.cover(int(tile), cover);
        for (Texel* texel : tiles[size_t(tile)]) {
            const size_t i = size_t(texel->y % kTileSize) * kTileSize + size_t(texel->x % kTileSize);
            const uint32_t triangle = cover.triangle[i];
            if (triangle == TileCover::kNone)
                continue;
            texel->point = surface->at(triangle, cover.weight1[i], cover.weight2[i]);
            texel->spacing = spacing->of(triangle);
            texel->open = open.is_open(triangle);
            texel->island = seams.island(triangle);
            if (!texel->open)
                adjust_ray_origins(&texel->point, 1, m_scene.occluder());
        }
    };
    return parallel_items(int64_t(tiles.size()), m_threads, fill_tile, m_progress);
}

bool ReconstructPilot::continue_windows(const UvRaster& raster, const OpenTriangles& open, const SeamLinks& seams)
{
    struct Candidate
    {
        Texel *cell, texel;
    };
    std::vector<Candidate> candidates;
    std::vector<SeamCell> cells;
    for (Window& window : m_windows) {
        const Texel &first = window.front(), &middle = window[window.size() / 2];
        if (middle.spacing == 0)
            continue;
        seams.find(
            { middle.x - kMiddle / 2, middle.x + kMiddle / 2 + 1, middle.y - kMiddle / 2, middle.y + kMiddle / 2 + 1 },
            cells);
        for (const SeamCell& cell : cells) {
            Texel& there = window[size_t(cell.y - first.y) * kSide + size_t(cell.x - first.x)];
            if (cell.island != middle.island || (there.spacing > 0 && there.island == cell.island))
                continue;
            Candidate candidate { &there, there };
            candidate.texel.spacing = 0;
            candidate.texel.x = cell.source_x;
            candidate.texel.y = cell.source_y;
            candidates.push_back(candidate);
        }
    }
    std::vector<Texel*> texels;
    for (Candidate& candidate : candidates)
        texels.push_back(&candidate.texel);
    if (!fill(texels, raster, open, seams))
        return false;
    for (const auto& [cell, texel] : candidates)
        if (texel.spacing > 0 && !cell->continues) {
            *cell = texel;
            cell->continues = true;
        }
    return true;
}

} // namespace vmlight
