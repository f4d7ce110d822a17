// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/reconstruct_pilot.h>

#include <vmlight/base/parallel.h>
#include <vmlight/math/sampling.h>
#include <vmlight/vismap/ground_of.h>
#include <vmlight/vismap/texel_spacing.h>
#include <vmlight/vismap/visibility_integrator.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <numeric>
#include <utility>

namespace vmlight {
namespace {

// One window for so many covered texels, within limits; each is one of so many that are looked at.
constexpr int64_t kTexelsPerWindow = 64, kLeastWindows = 256, kMostWindows = 512, kLooks = 4;
// Rays of a texel that is looked at. Their V is off by about one ray.
constexpr int kLookRays = 16;
constexpr double kLookVariance = 1.0 / (kLookRays * kLookRays);
// Where neighbours scatter by far more than chance, reconstruction hardly helps: the error is some three times that of
// where they do not, and so many times the windows tell it best.
constexpr double kAlike = 1.5, kApart = 8, kMoreWindows = 3;

} // namespace

bool ReconstructPilot::pick(const UvRaster& raster, const OpenTriangles& open, const SeamLinks& seams)
{
    if (!choose(raster, open, seams))
        return false;
    std::vector<Texel*> texels;
    for (Window& window : m_windows) {
        const int left = window.texels[kMiddle].x - kSide / 2, top = window.texels[kMiddle].y - kSide / 2;
        for (int i = 0; i < kSide * kSide; ++i) {
            Texel& texel = window.texels[size_t(i)];
            texel.x = left + i % kSide;
            texel.y = top + i / kSide;
            texels.push_back(&texel);
        }
    }
    if (!fill(texels, raster, open, seams) || !continue_windows(raster, open, seams))
        return false;
    find_traced();
    return true;
}

void ReconstructPilot::find_traced()
{
    std::map<std::pair<int, int>, uint32_t> known; // by place in the map
    for (Window& window : m_windows)
        for (size_t i = 0; i < window.texels.size(); ++i) {
            const Texel& texel = window.texels[i];
            window.traced[i] = kNotTraced;
            if (texel.spacing == 0)
                continue;
            const auto [found, is_new] = known.try_emplace({ texel.x, texel.y }, uint32_t(m_traced.size()));
            if (is_new)
                m_traced.push_back(&texel);
            window.traced[i] = found->second;
        }
    m_middle_of.assign(m_traced.size(), kNotTraced);
    for (const Window& window : m_windows)
        if (const uint32_t middle = window.traced[kMiddle]; middle != kNotTraced && m_middle_of[middle] == kNotTraced) {
            m_middle_of[middle] = uint32_t(m_middles.size());
            m_middles.push_back(m_traced[middle]);
        }
}

// Set the middles of the windows, and for how many each counts.
bool ReconstructPilot::choose(const UvRaster& raster, const OpenTriangles& open, const SeamLinks& seams)
{
    const int64_t most = std::clamp(m_pilot.covered() / kTexelsPerWindow, kLeastWindows, kMostWindows);
    const int64_t looks = std::min(most * kLooks, m_pilot.texels());
    // The middle of each, and its farthest neighbours to eight sides.
    constexpr size_t kLookTexels = 9;
    std::vector<std::array<Texel, kLookTexels>> looked(static_cast<size_t>(looks));
    std::vector<Texel*> texels;
    for (size_t k = 0; k < looked.size(); ++k) {
        // A random one of each run: equal steps might all fall into one column of a tile.
        const double chance = texel_hash(uint32_t(k), 1, 0).u * 0x1p-32;
        const double run = double(m_pilot.texels()) / double(looks);
        const auto [x, y] = m_pilot.place(std::min(m_pilot.texels() - 1, int64_t((double(k) + chance) * run)));
        for (size_t i = 0; i < kLookTexels; ++i) {
            looked[k][i].x = x + (int(i) % 3 - 1) * NeighbourWindow::kReach;
            looked[k][i].y = y + (int(i) / 3 - 1) * NeighbourWindow::kReach;
            texels.push_back(&looked[k][i]);
        }
    }
    if (!fill(texels, raster, open, seams))
        return false;
    const SamplePattern pattern(m_params.sampler, kLookRays, false);
    std::vector<std::unique_ptr<VisibilityIntegrator>> integrators(static_cast<size_t>(worker_count(m_threads)));
    for (auto& integrator : integrators)
        integrator = std::make_unique<VisibilityIntegrator>(m_scene.occluder(), pattern, m_params,
                                                            m_scene.frame().scale, ground_of(m_scene, m_params));
    std::vector<double> windows(looked.size()); // how many windows to have there, in those of even texels
    const auto look = [&](int64_t k, int worker) {
        const Texel& middle = looked[size_t(k)][kLookTexels / 2];
        double count = 0, sum = 0, squares = 0;
        for (const Texel& texel : looked[size_t(k)]) {
            if (texel.spacing == 0 || texel.island != middle.island)
                continue;
            const Point32 shift = pattern.texel(texel.x, texel.y, uint32_t(m_params.seed));
            const double seen = integrators[size_t(worker)]->integrate(texel.point, shift, texel.open).visibility;
            ++count, sum += seen, squares += seen * seen;
        }
        const double scatter = count > 1 ? (squares - sum * sum / count) / (count - 1) / kLookVariance : kApart;
        const double uneven = std::clamp((scatter - kAlike) / (kApart - kAlike), 0.0, 1.0);
        windows[size_t(k)] = 1 + (kMoreWindows - 1) * uneven;
    };
    if (!parallel_items(looks, m_threads, look, m_progress))
        return false;
    const double all = std::accumulate(windows.begin(), windows.end(), 0.0);
    m_windows.resize(size_t(std::min(most, looks)));
    double passed = 0;
    for (size_t k = 0, at = 0; k < m_windows.size(); ++k) {
        const double chance = texel_hash(uint32_t(k), 2, 0).u * 0x1p-32;
        const double wanted = (double(k) + chance) * all / double(m_windows.size());
        while (at + 1 < looked.size() && passed + windows[at] <= wanted)
            passed += windows[at++];
        m_windows[k].texels[kMiddle] = looked[at][kLookTexels / 2];
        m_windows[k].counts = 1 / windows[at];
    }
    return true;
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
        const Texel &first = window.texels.front(), &middle = window.texels[kMiddle];
        if (middle.spacing == 0)
            continue;
        seams.find({ middle.x, middle.x + 1, middle.y, middle.y + 1 }, cells);
        for (const SeamCell& cell : cells) {
            Texel& there = window.texels[size_t(cell.y - first.y) * kSide + size_t(cell.x - first.x)];
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
