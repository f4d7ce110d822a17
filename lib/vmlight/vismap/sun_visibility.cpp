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
            for (const MapPoint& point : points)
                tracer.add(point.surface, left + point.x, top + point.y, &dst[map.texel(int(tile), point) * count + k]);
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
