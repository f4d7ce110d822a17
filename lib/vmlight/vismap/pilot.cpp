// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/pilot.h>

#include <vmlight/base/parallel.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/math/sampling.h>
#include <vmlight/vismap/ground_of.h>
#include <vmlight/vismap/visibility_integrator.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace vmlight {
namespace {

// Rays between two progress checks: few enough to stop in well under a second.
constexpr int64_t kRaysPerItem = 1 << 14;
// Of pattern_error(), in rays, in the scenes that were measured. It counts as much as so many texels.
constexpr double kUsualRays = 1.1, kUsualTexels = 16;

using Seen = std::array<Visibility, 2>;

// The pattern error that makes the mean of pattern_variance() over the texels `mean`, by bisection.
double pattern_error_of(const std::vector<Seen>& seen, double mean)
{
    if (!(mean > 0))
        return 0;
    double least = 1e-9, most = 1; // with 1, rays are as good as independent
    for (int step = 0; step < 48; ++step) {
        const double middle = std::sqrt(least * most);
        double sum = 0;
        for (const Seen& texel : seen)
            for (const Visibility& one : texel)
                sum += pattern_variance(one.error * one.error, middle) / 2;
        (sum < mean * double(seen.size()) ? least : most) = middle;
    }
    return most;
}

} // namespace

double pattern_error(const PilotError& measured, int64_t texels)
{
    const double usual = kUsualRays / std::max(1, measured.samples), found = measured.pattern;
    return std::sqrt((double(texels) * found * found + kUsualTexels * usual * usual) / (double(texels) + kUsualTexels));
}

VismapPilot::VismapPilot(const BakeScene& scene, const NormalMap* normal_map, const VismapParams& params, int nthreads,
                         const Progress& progress)
    : m_scene(scene)
    , m_normal_map(normal_map)
    , m_params(params)
    , m_ground(ground_of(scene, params))
    , m_threads(nthreads)
    , m_progress([progress](double) { return !progress || progress(0); })
{
}

bool VismapPilot::pick(const UvRaster& raster, const OpenTriangles& open, int64_t most, int64_t least_step,
                       int64_t neighbours)
{
    struct Worker
    {
        TileCover cover;
        std::unique_ptr<Surface> surface;
    };
    std::vector<Worker> workers(static_cast<size_t>(worker_count(m_threads)));
    for (Worker& worker : workers)
        worker.surface = std::make_unique<Surface>(m_scene.mesh(), m_scene.frame());
    // Covered texels before each tile.
    std::vector<int64_t> before(size_t(raster.tiles_across()) * raster.tiles_down() + 1);
    const auto count = [&](int64_t tile, int worker) {
        raster.cover(int(tile), workers[size_t(worker)].cover);
        before[size_t(tile) + 1] = workers[size_t(worker)].cover.covered;
    };
    if (!parallel_items(int64_t(before.size()) - 1, m_threads, count, m_progress))
        return false;
    for (size_t tile = 1; tile < before.size(); ++tile)
        before[tile] += before[tile - 1];
    m_covered = before.back();
    m_texels.resize(size_t(std::min((m_covered + least_step - 1) / least_step, most)));

    // A random place in each run of equal length: equal steps might all fall into one column.
    const int64_t together = texels() < m_covered ? neighbours : 1;
    m_texels.resize(size_t(texels() / together * together));
    std::vector<int64_t> ranks;
    const double run = double(m_covered) / double(std::max<int64_t>(1, texels() / together));
    for (int64_t i = 0; i < texels() / together; ++i) {
        int64_t first = int64_t((double(i) + texel_hash(uint32_t(i), 0, 0).u * 0x1p-32) * run);
        if (together > 1)
            first = std::min(first, int64_t(double(i + 1) * run) - together);
        for (int64_t k = 0; k < together; ++k)
            ranks.push_back(std::min(m_covered - 1, first + k));
    }
    const auto take = [&](int64_t tile, int worker) {
        auto rank = std::lower_bound(ranks.begin(), ranks.end(), before[size_t(tile)]);
        if (rank == ranks.end() || *rank >= before[size_t(tile) + 1])
            return;
        auto& [cover, surface] = workers[size_t(worker)];
        raster.cover(int(tile), cover);
        const int tile_x = int(tile) % raster.tiles_across() * kTileSize;
        const int tile_y = int(tile) / raster.tiles_across() * kTileSize;
        int64_t at = before[size_t(tile)];
        for (int i = 0; i < kTileSize * kTileSize; ++i) {
            if (cover.triangle[size_t(i)] == TileCover::kNone)
                continue;
            for (; rank != ranks.end() && *rank == at; ++rank) {
                Texel& texel = m_texels[size_t(rank - ranks.begin())];
                texel = { surface->at(cover.triangle[size_t(i)], cover.weight1[size_t(i)], cover.weight2[size_t(i)]),
                          tile_x + i % kTileSize, tile_y + i / kTileSize, open.is_open(cover.triangle[size_t(i)]) };
                if (m_normal_map)
                    m_normal_map->apply(texel.point, cover.triangle[size_t(i)], cover.weight1[size_t(i)],
                                        cover.weight2[size_t(i)], texel.x, texel.y);
                if (!texel.open)
                    adjust_ray_origins(&texel.point, 1, m_scene.occluder());
            }
            ++at;
        }
    };
    return parallel_items(int64_t(before.size()) - 1, m_threads, take, m_progress);
}

// Bake the texels `times` times, at most twice, with two seeds.
bool VismapPilot::bake(std::vector<std::array<Visibility, 2>>& seen, int samples, int times, bool with_basis) const
{
    const SamplePattern pattern(m_params.sampler, samples, m_params.measure == "uniform");
    const Point32 seeds = texel_hash(uint32_t(samples), 0, uint32_t(m_params.seed));
    std::array<VismapParams, 2> params { m_params, m_params };
    // No user seed has the highest bit set.
    params[0].seed = int(seeds.u | 0x80000000u);
    params[1].seed = int((seeds.v == seeds.u ? ~seeds.v : seeds.v) | 0x80000000u);

    struct Worker
    {
        std::array<std::unique_ptr<VisibilityIntegrator>, 2> integrators;
        std::vector<float> basis;
    };
    std::vector<Worker> workers(static_cast<size_t>(worker_count(m_threads)));
    for (Worker& worker : workers) {
        for (size_t k = 0; k < 2; ++k)
            worker.integrators[k] = std::make_unique<VisibilityIntegrator>(m_scene.occluder(), pattern, params[k],
                                                                           m_scene.frame().scale, m_ground);
        worker.basis.resize(basis_channels(m_params).size());
    }
    seen.resize(m_texels.size());
    const int64_t step = std::max<int64_t>(1, kRaysPerItem / samples);
    const auto bake = [&](int64_t item, int worker) {
        auto& [integrators, basis] = workers[size_t(worker)];
        for (int64_t i = item * step; i < std::min(texels(), (item + 1) * step); ++i)
            for (size_t k = 0; k < size_t(times); ++k) {
                const Texel& texel = m_texels[size_t(i)];
                // Shifts that complement each other would be as far from the other seed's in all texels.
                const Point32 hash = texel_hash(uint32_t(texel.x), uint32_t(texel.y), uint32_t(params[k].seed));
                seen[size_t(i)][k]
                    = integrators[k]->integrate(texel.point, hash, texel.open, with_basis ? basis.data() : nullptr);
            }
    };
    return parallel_items((texels() + step - 1) / step, m_threads, bake, m_progress);
}

bool VismapPilot::visibility(int samples, std::vector<double>& dst) const
{
    std::vector<std::array<Visibility, 2>> seen;
    if (!bake(seen, samples, 1, false))
        return false;
    dst.clear();
    for (const auto& texel : seen)
        dst.push_back(texel[0].visibility);
    return true;
}

bool VismapPilot::measure(int samples, PilotError& dst, bool with_basis) const
{
    const Stopwatch timer;
    std::vector<std::array<Visibility, 2>> seen;
    if (!bake(seen, samples, 2, with_basis))
        return false;
    double variance = 0, scatter_variance = 0;
    for (const auto& [one, other] : seen) {
        variance += std::pow(one.visibility - other.visibility, 2) / 2;
        scatter_variance += (std::pow(one.error, 2) + std::pow(other.error, 2)) / 2;
    }
    const double count = double(std::max<int64_t>(1, texels()));
    dst = { samples, std::sqrt(variance / count), std::sqrt(scatter_variance / count),
            pattern_error_of(seen, variance / count), timer() };
    return true;
}

} // namespace vmlight
