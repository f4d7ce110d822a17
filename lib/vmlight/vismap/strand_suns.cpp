// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/strand_suns.h>

#include <vmlight/base/parallel.h>
#include <vmlight/math/latlong.h>
#include <vmlight/math/sampling.h>
#include <vmlight/mesh/strand_curve.h>

#include <algorithm>
#include <atomic>
#include <optional>

namespace vmlight {
namespace {

using Imath::V3d;
using Imath::V3f;

// Of rays that are independent of those of V.
constexpr uint32_t kSunSeed = 0x85ebca6bu;

double seen_of_disc(const StrandScene& scene, const CurvePoint& point, int64_t strand, const DiscSamples& samples,
                    uint32_t hash, float length, RayFan& fan)
{
    for (int ray = 0; ray < kStrandDiscRays; ++ray) {
        const V3f& w = samples.at(hash, ray, kStrandDiscRays);
        fan.x[ray] = w.x, fan.y[ray] = w.y, fan.z[ray] = w.z;
    }
    std::fill(fan.lanes.begin(), fan.lanes.end(), uint8_t(0xff));
    scene.clear_blocked(fan, scene.frame().to_scene(point.position), float(point.radius * scene.frame().scale),
                        uint32_t(strand), length);
    double sum = 0;
    for (int ray = 0; ray < kStrandDiscRays; ++ray)
        if (fan.lanes[size_t(ray / kPacketSize)] >> ray % kPacketSize & 1)
            sum += V3d(fan.x[ray], fan.y[ray], fan.z[ray]).cross(point.tangent).length();
    return sum / (kStrandDiscRays * latlong::pi);
}

} // namespace

bool trace_strand_discs(std::vector<float>& dst, const Strands& strands, const StrandScene& scene,
                        const StrandLayout& layout, OIIO::cspan<Disc> discs, const VismapParams& params, int nthreads,
                        int64_t& rays, const Progress& progress)
{
    static_assert(kStrandDiscRays % kPacketSize == 0, "all lanes of a fan are rays");
    const std::vector<DiscSamples> samples(discs.begin(), discs.end());
    const Size size = layout.size();
    const auto length = float(params.max_distance * scene.frame().scale);
    const auto count = size_t(discs.size());
    dst.assign(size_t(size.width) * size_t(size.height) * count, 0.0f);
    std::atomic<int64_t> traced { 0 };
    const auto trace_row = [&](int64_t y, int) {
        RayFan fan(kStrandDiscRays);
        std::optional<StrandCurve> curve;
        int64_t strand = -1, texels = 0;
        float* seen = &dst[size_t(y) * size_t(size.width) * count];
        for (int x = 0; x < size.width; ++x, seen += count) {
            const int64_t here = layout.strand_at(x, int(y));
            if (here == layout.strands)
                continue;
            if (here != strand)
                curve.emplace(strands, size_t(here));
            strand = here;
            ++texels;
            const CurvePoint point = curve->at(layout.share_at(x));
            const uint32_t hash = texel_hash(uint32_t(x), uint32_t(y), uint32_t(params.seed) ^ kSunSeed).u;
            for (size_t k = 0; k < count; ++k)
                seen[k] = float(seen_of_disc(scene, point, strand, samples[k], hash, length, fan));
        }
        traced += texels * int64_t(count) * kStrandDiscRays;
    };
    if (!count || !parallel_items(size.height, nthreads, trace_row, progress)) {
        rays = 0;
        return count == 0;
    }
    rays = traced;
    return true;
}

} // namespace vmlight
