// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/forecast.h>

#include <vmlight/base/stopwatch.h>
#include <vmlight/vismap/pilot.h>

#include <algorithm>

namespace vmlight {
namespace {

// Rays that are enough to time, of all the pilot's texels together.
constexpr double kTimedRays = 4e6;
// As a bake does: what the rays of one meet is in the caches when those of the next come. Of a large mesh, texels that
// lie apart take several times as long.
constexpr int64_t kNeighbours = 16;

} // namespace

bool forecast_map(MapForecast& dst, const BakeScene& scene, const VismapBaker& baker, bool timed, bool skip_open,
                  int nthreads, const Progress& progress)
{
    const VismapParams& params = baker.params();
    VismapPilot pilot(scene, nullptr, params, nthreads, progress);
    const UvRaster raster(scene.mesh(), baker.width(), baker.height(), params.udim);
    const Stopwatch timer;
    if (!pilot.pick(raster, skip_open ? baker.open() : OpenTriangles(), VismapPilot::kTexels, 1, kNeighbours))
        return false;
    const double pick_seconds = timer();
    dst = { pilot.covered(), 0 };
    if (!timed || pilot.texels() == 0)
        return true;
    PilotError first, again;
    // The first run warms up caches and pages, and is not counted.
    const int samples = std::max(1, std::min(params.samples, int(kTimedRays / double(pilot.texels()))));
    if (!pilot.measure(std::max(1, samples / 8), first, true) || !pilot.measure(samples, again, true))
        return false;
    // The bake finds the covered texels once, pick() twice; and it traces one ray more, to see what is near.
    dst.seconds = pick_seconds / 2
        + again.seconds / double(2 * pilot.texels()) * double(pilot.covered()) * (params.samples + 1) / samples;
    return true;
}

bool sample_visibility(std::vector<double>& dst, const BakeScene& scene, const NormalMap* normal_map,
                       const VismapParams& params, int samples, int nthreads, const Progress& progress)
{
    VismapPilot pilot(scene, normal_map, params, nthreads, progress);
    const UvRaster raster(scene.mesh(), params.size().width, params.size().height, params.udim);
    return pilot.pick(raster, {}) && pilot.visibility(samples, dst);
}

} // namespace vmlight
