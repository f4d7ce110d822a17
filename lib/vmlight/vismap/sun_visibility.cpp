// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/sun_visibility.h>

#include <vmlight/base/parallel.h>
#include <vmlight/base/work_counts.h>
#include <vmlight/vismap/disc_look.h>
#include <vmlight/vismap/ground_of.h>
#include <vmlight/vismap/penumbra.h>

#include <algorithm>
#include <numeric>

namespace vmlight {
namespace {

// Points that are kept between traces.
constexpr size_t kMostKept = size_t(256) << 20; // bytes
// Texels of the map per triangle of the scene, below which shadows of triangles are so small that what blocked one ray
// seldom blocks the next.
constexpr double kTexelsPerBlocker = 64;

bool can_spare_blocked(const BakeScene& scene, double texels)
{
    size_t triangles = 0;
    for (const TracedTriangles& mesh : scene.occluder().triangles())
        triangles += mesh.count;
    return texels >= kTexelsPerBlocker * double(triangles);
}

// The tiles around one that have been looked at for disc k of `count`.
LookedAround around(const std::vector<LookedTile>& looked, const UvRaster& raster, int tile, size_t k, size_t count)
{
    const int across = raster.tiles_across(), down = raster.tiles_down();
    LookedAround tiles {};
    for (int i = 0; i < 9; ++i) {
        const int x = tile % across + i % 3 - 1, y = tile / across + i / 3 - 1;
        if (x >= 0 && x < across && y >= 0 && y < down)
            tiles[size_t(i)] = &looked[size_t(y * across + x) * count + k];
    }
    return tiles;
}

} // namespace

SunTracer::SunTracer() = default;
SunTracer::~SunTracer() = default;

bool SunTracer::prepare(BakeScenePointer scene, const VismapParams& map, std::string& error, int nthreads,
                        const Progress& progress, NormalMapPointer normal_map)
{
    m_points.reset();
    if (!check_params(map, error))
        return false;
    auto points = std::make_unique<MapPoints>(std::move(scene), map, std::move(normal_map));
    if (!points->prepare(kMostKept, nthreads, progress)) {
        error = "interrupted";
        return false;
    }
    m_points = std::move(points);
    const double texels = double(m_points->width()) * m_points->height();
    m_tries_blockers = map.skip_open && can_spare_blocked(m_points->scene(), texels);
    m_open = {};
    if (map.skip_open) // for one trace, if no more: a search that pays then pays always
        m_open.find(m_points->scene(), map.max_distance * m_points->scene().frame().scale, texels);
    return true;
}

bool SunTracer::trace(std::vector<float>& dst, OIIO::cspan<Disc> discs, int nthreads, const Progress& progress)
{
    const MapPoints& map = *m_points;
    const VismapParams& params = map.params();
    const size_t count = size_t(discs.size());
    dst.assign(size_t(map.width()) * size_t(map.height()) * count, 0.0f);
    const std::vector<DiscSamples> samples(discs.begin(), discs.end());
    const float length = float(params.max_distance * map.scene().frame().scale);
    const GroundPlane ground = ground_of(map.scene(), params);
    std::vector<LookedTile> looked(size_t(map.tiles()) * count);
    struct Worker
    {
        MapPoints::ScratchPointer scratch;
        int64_t rays = 0;
    };
    std::vector<Worker> workers(size_t(worker_count(nthreads)));
    // Call work(tile, points, k) for each tile and disc; it returns the rays that it traced.
    const auto each = [&](const auto& work, const Progress& part) {
        const auto trace_tile = [&](int64_t tile, int index) {
            Worker& worker = workers[size_t(index)];
            const std::vector<MapPoint>& points = map.of_tile(int(tile), worker.scratch);
            for (size_t k = 0; k < count && !points.empty(); ++k)
                worker.rays += work(int(tile), points, k);
        };
        return parallel_items(map.tiles(), nthreads, trace_tile, part);
    };
    const auto value
        = [&](int tile, const MapPoint& point, size_t k) -> float& { return dst[map.texel(tile, point) * count + k]; };
    const auto tracer_of = [&](size_t k) {
        const Disc& disc = discs[ptrdiff_t(k)];
        return DiscTracer(map.scene().occluder(), disc, samples[k], disc_rays(disc.half_angle), length, params.seed,
                          ground, m_tries_blockers);
    };
    // One ray each, but for texels that a horizon cuts the disc of: these need all.
    const auto look = [&](int tile, const std::vector<MapPoint>& points, size_t k) {
        DiscLook one(map.scene().occluder(), discs[ptrdiff_t(k)], samples[k], length, params.seed, ground,
                     looked[size_t(tile) * count + k], m_tries_blockers);
        DiscTracer all = tracer_of(k);
        const int left = map.left(tile), top = map.top(tile);
        for (const MapPoint& point : points)
            if (const bool is_open = m_open.is_open(point.triangle);
                one.add(point.surface, is_open, left, top, point.x, point.y, &value(tile, point, k)) == DiscHeight::cut)
                all.add(point.surface, is_open, left + point.x, top + point.y, &value(tile, point, k));
        one.flush();
        all.flush();
        return one.rays() + all.rays();
    };
    // And all where a shadow has its edge.
    const auto refine = [&](int tile, const std::vector<MapPoint>& points, size_t k) {
        const std::array<uint64_t, kTileSize> edge = penumbra(around(looked, map.raster(), tile, k, count));
        if (std::all_of(edge.begin(), edge.end(), [](uint64_t row) { return row == 0; }))
            return int64_t(0);
        DiscTracer tracer = tracer_of(k);
        for (const MapPoint& point : points)
            if (edge[point.y] >> point.x & 1)
                tracer.add(point.surface, m_open.is_open(point.triangle), map.left(tile) + point.x,
                           map.top(tile) + point.y, &value(tile, point, k));
        tracer.flush();
        return tracer.rays();
    };
    const auto part = [&](double from) {
        return progress ? Progress([&progress, from](double done) { return progress(from + 0.5 * done); }) : Progress();
    };
    if (!each(look, part(0)) || !each(refine, part(0.5)))
        return false;
    m_rays = std::accumulate(workers.begin(), workers.end(), int64_t(0),
                             [](int64_t sum, const Worker& worker) { return sum + worker.rays; });
    work_counts().sun_rays += m_rays;
    if (std::any_of(dst.begin(), dst.end(), [](float t) { return t > 0; }))
        map.margin().fill(dst.data(), int(count), nthreads);
    return true;
}

size_t SunTracer::bytes() const
{
    return m_points ? m_points->bytes() : 0;
}

} // namespace vmlight
