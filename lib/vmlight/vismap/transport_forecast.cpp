// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/transport_forecast.h>

#include <vmlight/base/parallel.h>
#include <vmlight/vismap/bounce_rays.h>
#include <vmlight/vismap/ground_of.h>
#include <vmlight/vismap/map_patches.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>
#include <vector>

namespace vmlight {
namespace {

constexpr int64_t kMostTexels = 16384;

class TransportSample
{
public:
    TransportSample(const BakeScenePointer& scene, const VismapParams& map, OIIO::cspan<float> visibility,
                    const TransportParams& params, const NormalMapPointer& normal_map)
        : m_map(scene, map, normal_map)
        , m_patches(m_map)
        , m_pattern("fibonacci", params.rays, false)
        , m_ground(ground_of(*scene, map))
        , m_ground_reflects(params.ground)
        , m_visibility(visibility)
    {
    }

    bool prepare(int nthreads, const Progress& progress)
    {
        std::atomic<int64_t> texels { 0 };
        const bool done = m_map.prepare(0, nthreads, progress, [&](int tile, const std::vector<MapPoint>& points) {
            m_patches.add(tile, points);
            texels += std::count_if(points.begin(), points.end(),
                                    [&](const MapPoint& point) { return is_blocked(tile, point); });
        });
        m_patches.number();
        // Two samples, each of every so many texels.
        m_stride = std::max<int64_t>(2, 2 * ((texels + kMostTexels - 1) / kMostTexels));
        return done;
    }

    /// Trace every m_stride-th texel, from number `first` of each tile on.
    bool trace(int64_t first, int nthreads, const Progress& progress)
    {
        struct Worker
        {
            std::unique_ptr<BounceRays> rays;
            MapPoints::ScratchPointer points;
            std::vector<uint32_t> met, numbers;
        };
        std::vector<Worker> workers(size_t(worker_count(nthreads)));
        std::mutex mutex;
        const auto trace_tile = [&](int64_t tile, int index) {
            Worker& worker = workers[size_t(index)];
            if (!worker.rays)
                worker.rays
                    = std::make_unique<BounceRays>(m_map, m_patches, m_pattern, m_pattern, m_ground, m_ground_reflects);
            worker.rays->cells().clear();
            worker.met.clear();
            int64_t number = 0;
            for (const MapPoint& point : m_map.of_tile(int(tile), worker.points))
                if (is_blocked(int(tile), point) && number++ % m_stride == first)
                    worker.rays->trace(point.surface, m_map.texel(int(tile), point), m_map.left(int(tile)) + point.x,
                                       m_map.top(int(tile)) + point.y, worker.met);
            const std::lock_guard lock(mutex);
            m_cells.merge(worker.rays->cells(), worker.numbers);
        };
        const bool done = parallel_items(m_map.tiles(), nthreads, trace_tile, progress);
        for (const Worker& worker : workers)
            m_rays += worker.rays ? double(worker.rays->rays()) : 0;
        return done;
    }

    int64_t stride() const { return m_stride; }
    double rays() const { return m_rays; }
    double points() const { return double(m_cells.point_count()); }

private:
    bool is_blocked(int tile, const MapPoint& point) const
    {
        return m_visibility.empty() || m_visibility[ptrdiff_t(m_map.texel(tile, point))] < 1;
    }

    MapPoints m_map;
    MapPatches m_patches;
    const SamplePattern m_pattern;
    const GroundPlane m_ground;
    const bool m_ground_reflects;
    const OIIO::cspan<float> m_visibility;
    LightCells m_cells;
    int64_t m_stride = 2;
    double m_rays = 0;
};

// How many points `times` as many texels have as the sample, which has `all`, and half of it `half`. Points repeat ever
// more: growth by the same power from doubling to doubling is too much, growth that saturates as if all cells were
// equally likely is too little.
double extrapolated(double half, double all, double times)
{
    if (!(half > 0) || !(all > half))
        return all;
    const double power = all * std::pow(times, std::log2(all / half));
    // all(m) = most m / (m + m0), through both
    const double ratio = std::min(all / half, 2 - 1e-9), m0 = (ratio - 1) / (2 - ratio);
    const double saturated = all * times * (1 + m0) / (times + m0);
    return std::sqrt(power * saturated);
}

} // namespace

bool forecast_transport(TransportForecast& dst, const BakeScenePointer& scene, const VismapParams& map,
                        OIIO::cspan<float> visibility, const TransportParams& params, int nthreads,
                        const Progress& progress, const NormalMapPointer& normal_map)
{
    TransportSample sample(scene, map, visibility, params, normal_map);
    if (!sample.prepare(nthreads, progress) || !sample.trace(0, nthreads, progress))
        return false;
    const double half = sample.points();
    if (!sample.trace(sample.stride() / 2, nthreads, progress))
        return false;
    const double times = double(sample.stride()) / 2;
    dst.rays = sample.rays() * times;
    dst.points = extrapolated(half, sample.points(), times);
    return true;
}

} // namespace vmlight
