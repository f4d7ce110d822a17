// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/pose_plan.h>

#include <vmlight/base/parallel.h>
#include <vmlight/uv/islands.h>
#include <vmlight/vismap/pose_grid.h>
#include <vmlight/vismap/pose_ground.h>
#include <vmlight/vismap/pose_proof.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

namespace vmlight {
namespace {

constexpr int kCoarse = 8, kFine = 4; // texels
// Of the error that is allowed: texels between probes change by more than those.
constexpr double kProbeShare = 0.5;
// A bound that holds for 99 of 100 texels is what this share of the probes is within.
constexpr double kBoundShare = 0.995;
constexpr int64_t kMeasured = 4096;

using Change = std::pair<double, double>; // of a probe, and how many texels it stands for

// Puts probes into squares of texels.
class Probing
{
public:
    Probing(const PosePair& poses, const PosePlan::MayKeep& may_keep, int nthreads, const Progress& progress)
        : m_poses(poses)
        , m_may_keep(may_keep)
        , m_threads(nthreads)
        , m_progress(progress)
        , m_part(islands_of_triangles(poses.pose.scene->mesh()))
        , m_pattern(poses.baker.params().sampler, poses.baker.params().samples,
                    poses.baker.params().measure == "uniform")
    {
        constexpr auto kSoft = uint32_t(PoseMotion::kMotions);
        for (uint32_t t = 0; t < m_part.size(); ++t)
            m_part[t] = m_part[t] * (kSoft + 1) + std::min(poses.motion.body(t), kSoft);
        for (int i = 0; i < worker_count(nthreads); ++i)
            m_workers.emplace_back(poses, m_pattern);
    }

    uint32_t part(uint32_t triangle) const { return m_part[triangle]; }
    int64_t tiles() const { return int64_t(raster().tiles_across()) * raster().tiles_down(); }
    const UvRaster& raster() const { return m_poses.baker.raster(); }

    /// visit(x, y, cover, texel, worker) for each covered texel. False if stopped.
    template <class Visit> bool each_tile(const Visit& visit)
    {
        const auto work = [&](int64_t tile, int worker) {
            Worker& own = m_workers[size_t(worker)];
            raster().cover(int(tile), *own.cover);
            if (own.cover->covered > 0)
                visit(int(tile), *own.cover, own);
        };
        return parallel_items(tiles(), m_threads, work, m_progress);
    }

    /// A probe for each part that squares of `grid` have texels of, where wants(x, y) of their first texel. `finer` is
    /// nullptr or also gets them. False if stopped.
    template <class Wants> bool probe(PoseGrid& grid, PoseGrid* finer, const Wants& wants)
    {
        return each_tile([&](int tile, const TileCover& cover, Worker& worker) {
            const int tile_x = tile % raster().tiles_across() * kTileSize;
            const int tile_y = tile / raster().tiles_across() * kTileSize;
            for (int y = 0; y < kTileSize; y += grid.side())
                for (int x = 0; x < kTileSize; x += grid.side())
                    if (wants(tile_x + x, tile_y + y))
                        probe_square(grid, finer, cover, worker, { tile_x, tile_y }, { x, y });
        });
    }

    PoseChange sum_up(double error) const
    {
        PoseChange sum;
        std::vector<Change> all;
        for (const Worker& worker : m_workers) {
            all.insert(all.end(), worker.changes.begin(), worker.changes.end());
            sum.rays += worker.probe->rays();
        }
        sum.probes = int64_t(all.size());
        if (all.empty())
            return sum;
        std::sort(all.begin(), all.end());
        double texels = 0, above = 0, at = 0;
        for (const auto& [change, weight] : all) {
            texels += weight;
            above += change > error ? weight : 0;
        }
        sum.above = above / texels;
        sum.most = all.back().first;
        for (const auto& [change, weight] : all) {
            sum.bound = change;
            if ((at += weight) >= kBoundShare * texels)
                break;
        }
        return sum;
    }

private:
    struct Worker
    {
        Worker(const PosePair& poses, const SamplePattern& pattern)
            : cover(std::make_unique<TileCover>())
            , probe(std::make_unique<PoseProbe>(poses.base, poses.pose, poses.baker.params(), pattern, poses.hints))
            , sides(std::make_unique<GroundSides>(poses.motion, poses.baker.params()))
        {
        }
        std::unique_ptr<TileCover> cover;
        std::unique_ptr<PoseProbe> probe;
        std::unique_ptr<GroundSides> sides;
        std::vector<Change> changes;
    };

    void probe_square(PoseGrid& grid, PoseGrid* finer, const TileCover& cover, Worker& worker, std::array<int, 2> tile,
                      std::array<int, 2> corner)
    {
        const int side = grid.side(), texels = side * side;
        std::vector<PoseGrid::Probe>& probes = grid.at(tile[0] + corner[0], tile[1] + corner[1]);
        // From a random one on, in an order that leaps.
        const uint32_t first
            = texel_hash(uint32_t(tile[0] + corner[0]), uint32_t(tile[1] + corner[1]), uint32_t(side)).u;
        int standing = 0;
        const size_t before = probes.size();
        for (int i = 0; i < texels; ++i) {
            const int k = int((first + uint32_t(i) * 29u) % uint32_t(texels));
            const int x = corner[0] + k % side, y = corner[1] + k / side;
            const auto texel = size_t(y * kTileSize + x);
            const uint32_t triangle = cover.triangle[texel];
            if (triangle == TileCover::kNone || !m_may_keep(triangle))
                continue;
            ++standing;
            const uint32_t part = m_part[triangle];
            const auto known = [&](const PoseGrid::Probe& probe) { return probe.part == part; };
            if (std::any_of(probes.begin(), probes.end(), known))
                continue;
            const double change = worker.probe->change(triangle, cover.weight1[texel], cover.weight2[texel],
                                                       tile[0] + x, tile[1] + y, m_poses.motion.turn(triangle));
            probes.push_back({ part, float(change) });
            if (finer)
                finer->at(tile[0] + x, tile[1] + y).push_back(probes.back());
        }
        for (size_t i = before; i < probes.size() && side == kCoarse; ++i)
            worker.changes.emplace_back(probes[i].change, double(standing) / double(probes.size() - before));
    }

    const PosePair& m_poses;
    const PosePlan::MayKeep& m_may_keep;
    const int m_threads;
    const Progress& m_progress;
    std::vector<uint32_t> m_part;
    const SamplePattern m_pattern;
    std::vector<Worker> m_workers;
};

void keep(TileBits& bits, size_t texel)
{
    bits[texel / kTileSize] |= uint64_t(1) << texel % kTileSize;
}

} // namespace

bool PosePlan::decide(const PosePair& poses, double error, const MayKeep& may_keep, int nthreads,
                      const Progress& progress)
{
    const Progress waiting = [&](double) { return !progress || progress(0); };
    std::vector<uint8_t> same;
    if (error <= 0 || poses.motion.is_whole())
        same = prove_same_view(poses.motion, poses.baker.params(), error <= 0, nthreads);
    if (poses.pose.normal_map)
        for (uint32_t t = 0; t < same.size(); ++t)
            same[t] = same[t]
                && poses.pose.normal_map->is_turned(*poses.base.normal_map, t, poses.motion.turn(t),
                                                    poses.motion.stands_still() && poses.motion.body(t) == 0);
    const bool by_proof = error <= 0 || (!same.empty() && std::find(same.begin(), same.end(), 0) == same.end());
    same.resize(poses.pose.scene->mesh().triangles.size());
    Probing probing(poses, may_keep, nthreads, waiting);
    const double limit = kProbeShare * error;
    PoseGrid coarse(kCoarse, probing.raster()), fine(kFine, probing.raster());
    const auto is_cold = [&](int x, int y) { return !coarse.exceeds(x, y, PoseGrid::kAny, limit); };
    if (!by_proof && (!probing.probe(coarse, &fine, [](int, int) {
            return true;
        }) || !probing.probe(fine, nullptr, [&](int x, int y) { return !is_cold(x, y); })))
        return false;
    m_kept.assign(size_t(probing.tiles()), {});
    struct Counts
    {
        int64_t kept = 0, covered = 0, tracing = 0, unknown = 0;
    };
    std::vector<Counts> counts(m_kept.size());
    const bool has_known = poses.hints && poses.hints->known;
    const PoseGround ground(poses.motion, poses.baker.params(), error);
    const auto keeps_ground = [&](uint32_t triangle, const TileCover& cover, size_t texel, GroundSides& sides) {
        const PoseGround::Keeps keeps = ground.keeps(triangle);
        return keeps == PoseGround::all
            || (keeps == PoseGround::by_side && sides.are_same(triangle, cover.weight1[texel], cover.weight2[texel]));
    };
    const auto decide_tile = [&](int tile, const TileCover& cover, const auto& worker) {
        const int tile_x = tile % probing.raster().tiles_across() * kTileSize;
        const int tile_y = tile / probing.raster().tiles_across() * kTileSize;
        for (size_t texel = 0; texel < cover.triangle.size(); ++texel) {
            const uint32_t triangle = cover.triangle[texel];
            if (triangle == TileCover::kNone)
                continue;
            const bool traces = !poses.baker.open().is_open(triangle);
            counts[size_t(tile)].tracing += traces;
            const bool unknown = traces && !(has_known && (*poses.hints->still)[triangle]);
            counts[size_t(tile)].unknown += unknown;
            if (!may_keep(triangle) || !keeps_ground(triangle, cover, texel, *worker.sides))
                continue;
            const int x = tile_x + int(texel % kTileSize), y = tile_y + int(texel / kTileSize);
            if (same[triangle]
                || (!by_proof && (is_cold(x, y) || !fine.exceeds(x, y, probing.part(triangle), limit)))) {
                keep(m_kept[size_t(tile)], texel);
                ++counts[size_t(tile)].kept;
                counts[size_t(tile)].unknown -= unknown;
            }
        }
        counts[size_t(tile)].covered = cover.covered;
    };
    if (!probing.each_tile(decide_tile))
        return false;
    m_count = m_covered = m_tracing = m_unknown = 0;
    for (const Counts& tile : counts) {
        m_count += tile.kept;
        m_covered += tile.covered;
        m_tracing += tile.tracing;
        m_unknown += tile.unknown;
    }
    m_change = probing.sum_up(error);
    return true;
}

bool measure_change(PoseChange& dst, const PosePair& poses, double error, int nthreads, const Progress& progress)
{
    const PosePlan::MayKeep all = [](uint32_t) { return true; };
    const Progress waiting = [&](double) { return !progress || progress(0); };
    Probing probing(poses, all, nthreads, waiting);
    std::vector<int64_t> covered(size_t(probing.tiles()));
    if (!probing.each_tile(
            [&](int tile, const TileCover& cover, const auto&) { covered[size_t(tile)] = cover.covered; }))
        return false;
    double texels = 0;
    for (const int64_t count : covered)
        texels += double(count);
    const auto every = uint32_t(std::max(1.0, texels / (kCoarse * kCoarse) / double(kMeasured)));
    PoseGrid grid(kCoarse, probing.raster());
    if (!probing.probe(grid, nullptr, [&](int x, int y) {
            return texel_hash(uint32_t(x / kCoarse), uint32_t(y / kCoarse), 1).u % every == 0;
        }))
        return false;
    dst = probing.sum_up(error);
    return true;
}

} // namespace vmlight
