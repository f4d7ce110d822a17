// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/sun_visibility.h>

#include <vmlight/base/parallel.h>
#include <vmlight/vismap/ground_of.h>

#include <algorithm>
#include <numeric>

namespace vmlight {
namespace {

// Points that are kept between traces.
constexpr size_t kMostKept = size_t(256) << 20; // bytes

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
    return true;
}

bool SunTracer::trace(std::vector<float>& dst, OIIO::cspan<Disc> discs, int nthreads, const Progress& progress) const
{
    const MapPoints& map = *m_points;
    const VismapParams& params = map.params();
    const size_t count = size_t(discs.size());
    dst.assign(size_t(map.width()) * size_t(map.height()) * count, 0.0f);
    const std::vector<DiscSamples> samples(discs.begin(), discs.end());
    const float length = float(params.max_distance * map.scene().frame().scale);
    const GroundPlane ground = ground_of(map.scene(), params);
    struct Worker
    {
        MapPoints::ScratchPointer scratch;
        int64_t rays = 0;
    };
    std::vector<Worker> workers(size_t(worker_count(nthreads)));
    const auto trace = [&](int64_t tile, int index) {
        Worker& worker = workers[size_t(index)];
        const std::vector<MapPoint>& points = map.of_tile(int(tile), worker.scratch);
        const int left = map.left(int(tile)), top = map.top(int(tile));
        for (size_t k = 0; k < count; ++k) {
            const Disc& disc = discs[ptrdiff_t(k)];
            DiscTracer tracer(map.scene().occluder(), disc, samples[k], disc_rays(disc.half_angle), length, params.seed,
                              ground);
            // One ray each, and all where a shadow has its edge.
            Looked looked;
            std::array<uint64_t, kTileSize> whole {};
            const auto value
                = [&](const MapPoint& point) -> float& { return dst[map.texel(int(tile), point) * count + k]; };
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
    if (!parallel_items(map.tiles(), nthreads, trace, progress))
        return false;
    m_rays = std::accumulate(workers.begin(), workers.end(), int64_t(0),
                             [](int64_t sum, const Worker& worker) { return sum + worker.rays; });
    if (m_rays > 0)
        map.margin().fill(dst.data(), int(count));
    return true;
}

size_t SunTracer::bytes() const
{
    return m_points ? m_points->bytes() : 0;
}

} // namespace vmlight
