// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/point_visibility.h>

#include <vmlight/base/parallel.h>
#include <vmlight/image/channels.h>
#include <vmlight/math/sampling.h>
#include <vmlight/vismap/basis.h>
#include <vmlight/vismap/ground_of.h>
#include <vmlight/vismap/sun_visibility.h>
#include <vmlight/vismap/visibility_integrator.h>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>

namespace vmlight {
namespace {

using Points = OIIO::cspan<SurfacePoint>;

// Visit the points, as many at a time as rays run side by side, with their ray origins adjusted.
bool for_points(Points points, const BakeScene& scene, int nthreads, const Progress& progress,
                const std::function<void(size_t index, const SurfacePoint& point, int worker)>& visit)
{
    const size_t count = size_t(points.size());
    const auto work = [&](int64_t item, int worker) {
        std::array<SurfacePoint, kPacketSize> some;
        const size_t first = size_t(item) * kPacketSize, size = std::min<size_t>(kPacketSize, count - first);
        std::copy_n(points.data() + first, size, some.begin());
        adjust_ray_origins(some.data(), int(size), scene.occluder());
        for (size_t i = 0; i < size; ++i)
            visit(first + i, some[i], worker);
    };
    return parallel_items(int64_t((count + kPacketSize - 1) / kPacketSize), nthreads, work, progress);
}

} // namespace

std::vector<std::string> point_channels(const VismapParams& params)
{
    std::vector<std::string> names(kVismapChannels.begin(), kVismapChannels.end());
    names.insert(names.end(), kNormalChannels.begin(), kNormalChannels.end());
    const std::vector<std::string> basis = basis_channels(params);
    names.insert(names.end(), basis.begin(), basis.end());
    return names;
}

bool bake_points(std::vector<float>& dst, const BakeScene& scene, const VismapParams& params, Points points,
                 int nthreads, const Progress& progress)
{
    const size_t channels = point_channels(params).size();
    const SamplePattern pattern(params.sampler, params.samples, params.measure == "uniform");
    const GroundPlane ground = ground_of(scene, params);
    std::vector<std::unique_ptr<VisibilityIntegrator>> workers(size_t(worker_count(nthreads)));
    dst.resize(size_t(points.size()) * channels);
    return for_points(points, scene, nthreads, progress, [&](size_t index, const SurfacePoint& point, int worker) {
        auto& integrator = workers[size_t(worker)];
        if (!integrator)
            integrator = std::make_unique<VisibilityIntegrator>(scene.occluder(), pattern, params, scene.frame().scale,
                                                                ground);
        float* out = &dst[index * channels];
        const Point32 hash = texel_hash(uint32_t(index), 0, uint32_t(params.seed));
        const Visibility seen = integrator->integrate(point, hash, false, out + 7);
        out[0] = float(seen.visibility);
        for (int c = 0; c < 3; ++c) {
            out[1 + c] = float(seen.direction[c]);
            out[4 + c] = point.normal[c];
        }
    });
}

bool trace_points(std::vector<float>& dst, const BakeScene& scene, const VismapParams& params, Points points,
                  OIIO::cspan<Disc> discs, int nthreads, const Progress& progress)
{
    const size_t count = size_t(discs.size());
    const std::vector<DiscSamples> samples(discs.begin(), discs.end());
    const float length = float(params.max_distance * scene.frame().scale);
    const GroundPlane ground = ground_of(scene, params);
    dst.assign(size_t(points.size()) * count, 0.0f);
    return for_points(points, scene, nthreads, progress, [&](size_t index, const SurfacePoint& point, int) {
        for (size_t k = 0; k < count; ++k) {
            const Disc& disc = discs[ptrdiff_t(k)];
            DiscTracer tracer(scene.occluder(), disc, samples[k], disc_rays(disc.half_angle), length, params.seed,
                              ground, false);
            tracer.add(point, false, int(index), 0, &dst[index * count + k]);
            tracer.flush();
        }
    });
}

} // namespace vmlight
