// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/sun_visibility.h>

#include <vmlight/base/parallel.h>
#include <vmlight/uv/margin.h>
#include <vmlight/uv/raster.h>
#include <vmlight/uv/tile_progress.h>
#include <vmlight/vismap/ground_of.h>

#include <algorithm>
#include <numeric>

namespace vmlight {
namespace {

// Points that are kept between traces.
constexpr size_t kMostKept = size_t(256) << 20; // bytes

struct MapPoint
{
    SurfacePoint surface;
    uint16_t x, y; // in the tile
};

// Of one thread.
struct PointFinder
{
    PointFinder(const BakeScene& scene, const NormalMap* the_normal_map)
        : surface(scene.mesh(), scene.frame())
        , occluder(scene.occluder())
        , normal_map(the_normal_map)
    {
    }

    // The points of a tile, neighbours together, as rays that run side by side are faster.
    void find(std::vector<MapPoint>& dst, const UvRaster& raster, int tile)
    {
        dst.clear();
        raster.cover(tile, cover);
        std::array<SurfacePoint, kPacketSize> points;
        for (int i = 0; i < kTileSize * kTileSize / 8 && cover.covered > 0; ++i) {
            const int block = i / 8, left = block % 8 * 8, y = block / 8 * 8 + i % 8;
            const size_t before = dst.size();
            for (int x = left; x < left + 8; ++x) {
                const size_t texel = size_t(y) * kTileSize + size_t(x);
                if (cover.triangle[texel] == TileCover::kNone)
                    continue;
                dst.push_back({ surface.at(cover.triangle[texel], cover.weight1[texel], cover.weight2[texel]),
                                uint16_t(x), uint16_t(y) });
                if (normal_map)
                    normal_map->apply(dst.back().surface, cover.triangle[texel], cover.weight1[texel],
                                      cover.weight2[texel], tile % raster.tiles_across() * kTileSize + x,
                                      tile / raster.tiles_across() * kTileSize + y);
            }
            const int count = int(dst.size() - before);
            for (int k = 0; k < count; ++k)
                points[size_t(k)] = dst[before + size_t(k)].surface;
            if (count > 0)
                adjust_ray_origins(points.data(), count, occluder);
            for (int k = 0; k < count; ++k)
                dst[before + size_t(k)].surface = points[size_t(k)];
        }
    }

    Surface surface;
    const Occluder& occluder;
    const NormalMap* normal_map;
    TileCover cover;
};

// Texels of a tile whose one ray met something, or nothing, by rows.
struct Looked
{
    std::array<uint64_t, kTileSize> blocked {}, seen {};

    uint64_t looked(int y) const { return y < 0 || y >= kTileSize ? 0 : blocked[size_t(y)] | seen[size_t(y)]; }

    // Texels that have as many around them as those of a straight edge, but for one.
    uint64_t has_neighbours(int y) const
    {
        std::array<uint64_t, 5> at_least { ~uint64_t(0), 0, 0, 0, 0 }; // 0 to 4
        const auto add = [&](uint64_t one) {
            for (size_t n = 4; n > 0; --n)
                at_least[n] |= at_least[n - 1] & one;
        };
        for (int row = y - 1; row <= y + 1; ++row) {
            add(looked(row) << 1);
            add(looked(row) >> 1);
            if (row != y)
                add(looked(row));
        }
        return at_least[4];
    }

    // Texels that do not agree with one of the 24 around them, or that have too few beside them to tell.
    std::array<uint64_t, kTileSize> penumbra() const
    {
        std::array<uint64_t, kTileSize> result {};
        const auto around = [](const std::array<uint64_t, kTileSize>& rows, int y) {
            uint64_t all = 0;
            for (int row = std::max(0, y - 2); row <= std::min(kTileSize - 1, y + 2); ++row)
                for (const int side : { 0, 1, 2 })
                    all |= rows[size_t(row)] << side | rows[size_t(row)] >> side;
            return all;
        };
        for (int y = 0; y < kTileSize; ++y)
            result[size_t(y)] = (blocked[size_t(y)] & around(seen, y)) | (seen[size_t(y)] & around(blocked, y))
                | (looked(y) & ~has_neighbours(y));
        return result;
    }
};

} // namespace

struct SunTracer::Setup
{
    Setup(BakeScenePointer the_scene, const VismapParams& the_params, NormalMapPointer the_normal_map)
        : scene(std::move(the_scene))
        , normal_map(std::move(the_normal_map))
        , params(the_params)
        , width(params.size().width)
        , height(params.size().height)
        , raster(scene->mesh(), width, height, params.udim)
    {
    }
    int tiles() const { return raster.tiles_across() * raster.tiles_down(); }
    int left(int tile) const { return tile % raster.tiles_across() * kTileSize; }
    int top(int tile) const { return tile / raster.tiles_across() * kTileSize; }
    size_t texel(int tile, const MapPoint& point) const
    {
        return size_t(top(tile) + point.y) * size_t(width) + size_t(left(tile) + point.x);
    }

    const BakeScenePointer scene;
    const NormalMapPointer normal_map;
    const VismapParams params;
    const int width, height;
    const UvRaster raster;
    std::vector<std::vector<MapPoint>> points; // of each tile, or empty
    MarginPlan margin;
};

SunTracer::SunTracer() = default;
SunTracer::~SunTracer() = default;

bool SunTracer::prepare(BakeScenePointer scene, const VismapParams& map, std::string& error, int nthreads,
                        const Progress& progress, NormalMapPointer normal_map)
{
    m_setup.reset();
    if (!check_params(map, error))
        return false;
    auto setup = std::make_unique<Setup>(std::move(scene), map, std::move(normal_map));
    const size_t texels = size_t(setup->width) * size_t(setup->height);
    const bool keeps_points = texels * sizeof(MapPoint) <= kMostKept;
    if (keeps_points)
        setup->points.resize(size_t(setup->tiles()));
    // A normal where V and B of a visibility map are: what the margin goes by.
    std::vector<float> normals(4 * texels);
    Coverage covered(setup->width, setup->height);
    struct Worker
    {
        std::unique_ptr<PointFinder> finder;
        std::vector<MapPoint> points;
    };
    std::vector<Worker> workers(size_t(worker_count(nthreads)));
    const auto find = [&](int64_t tile, int index) {
        Worker& worker = workers[size_t(index)];
        if (!worker.finder)
            worker.finder = std::make_unique<PointFinder>(*setup->scene, setup->normal_map.get());
        worker.finder->find(worker.points, setup->raster, int(tile));
        std::array<uint64_t, kTileSize> bits {};
        for (const MapPoint& point : worker.points) {
            bits[point.y] |= uint64_t(1) << point.x;
            for (int c = 0; c < 3; ++c)
                normals[4 * setup->texel(int(tile), point) + 1 + size_t(c)] = point.surface.normal[c];
        }
        const int left = setup->left(int(tile)), top = setup->top(int(tile));
        for (int row = 0; row < std::min(kTileSize, setup->height - top); ++row)
            covered.set_word(left, top + row, bits[size_t(row)]);
        if (keeps_points)
            setup->points[size_t(tile)] = worker.points;
    };
    if (!parallel_items(setup->tiles(), nthreads, find, progress)) {
        error = "interrupted";
        return false;
    }
    fill_margin(normals.data(), 4, covered, map.margin, {}, &setup->margin);
    m_setup = std::move(setup);
    return true;
}

bool SunTracer::trace(std::vector<float>& dst, OIIO::cspan<Disc> discs, int nthreads, const Progress& progress) const
{
    const Setup& setup = *m_setup;
    const size_t count = size_t(discs.size());
    dst.assign(size_t(setup.width) * size_t(setup.height) * count, 0.0f);
    const std::vector<DiscSamples> samples(discs.begin(), discs.end());
    const float length = float(setup.params.max_distance * setup.scene->frame().scale);
    const GroundPlane ground = ground_of(*setup.scene, setup.params);
    struct Worker
    {
        std::unique_ptr<PointFinder> finder;
        std::vector<MapPoint> points;
        int64_t rays = 0;
    };
    std::vector<Worker> workers(size_t(worker_count(nthreads)));
    const auto trace = [&](int64_t tile, int index) {
        Worker& worker = workers[size_t(index)];
        if (setup.points.empty()) {
            if (!worker.finder)
                worker.finder = std::make_unique<PointFinder>(*setup.scene, setup.normal_map.get());
            worker.finder->find(worker.points, setup.raster, int(tile));
        }
        const std::vector<MapPoint>& points = setup.points.empty() ? worker.points : setup.points[size_t(tile)];
        const int left = setup.left(int(tile)), top = setup.top(int(tile));
        for (size_t k = 0; k < count; ++k) {
            const Disc& disc = discs[ptrdiff_t(k)];
            DiscTracer tracer(setup.scene->occluder(), disc, samples[k], disc_rays(disc.half_angle), length,
                              setup.params.seed, ground);
            // One ray each, and all where a shadow has its edge.
            Looked looked;
            std::array<uint64_t, kTileSize> whole {};
            const auto value
                = [&](const MapPoint& point) -> float& { return dst[setup.texel(int(tile), point) * count + k]; };
            for (const MapPoint& point : points)
                if (tracer.add_one(point.surface, left + point.x, top + point.y, &value(point)))
                    whole[point.y] |= uint64_t(1) << point.x;
                else
                    tracer.add(point.surface, left + point.x, top + point.y, &value(point));
            tracer.flush();
            for (const MapPoint& point : points)
                if (const uint64_t bit = uint64_t(1) << point.x; whole[point.y] & bit)
                    (value(point) > 0 ? looked.seen : looked.blocked)[point.y] |= bit;
            const std::array<uint64_t, kTileSize> penumbra = looked.penumbra();
            for (const MapPoint& point : points)
                if (penumbra[point.y] >> point.x & 1)
                    tracer.add(point.surface, left + point.x, top + point.y, &value(point));
            tracer.flush();
            worker.rays += tracer.rays();
        }
    };
    if (!parallel_items(setup.tiles(), nthreads, trace, progress))
        return false;
    m_rays = std::accumulate(workers.begin(), workers.end(), int64_t(0),
                             [](int64_t sum, const Worker& worker) { return sum + worker.rays; });
    if (m_rays > 0)
        setup.margin.fill(dst.data(), int(count));
    return true;
}

size_t SunTracer::bytes() const
{
    size_t bytes = m_setup ? m_setup->margin.bytes() : 0;
    if (m_setup)
        for (const auto& points : m_setup->points)
            bytes += points.capacity() * sizeof(MapPoint);
    return bytes;
}

} // namespace vmlight
