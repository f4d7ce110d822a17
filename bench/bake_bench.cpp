// SPDX-License-Identifier: Apache-2.0
/// How near the bake comes to its limit: the same rays through a bare loop over the fastest Embree call.
///     bake_bench MESH [resolution samples threads]
/// The bare loop traces directions made beforehand, in the bake's own order, packets of eight; nothing else is in its
/// time. The bake's time is all of make_vismap(): building, covering, sampling, tracing, summing, margin. The two take
/// turns, so that a slow spell of the machine hits both; medians of their times are compared.
#include <vmlight/base/parallel.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/math/sampling.h>
#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/trace/embree.h>
#include <vmlight/trace/surface.h>
#include <vmlight/uv/raster.h>
#include <vmlight/vismap/vismap.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>

using namespace vmlight;

namespace {

/// The rays of some texels, as the bake would trace them.
struct Rays
{
    int packets_each = 0;
    std::vector<Imath::V3f> origins;
    std::vector<float> directions; // a packet: 8 x, 8 y, 8 z
    std::vector<uint8_t> lanes;
};

double median(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

RTCScene robust_scene(RTCDevice device, const Mesh& mesh, const SceneFrame& frame)
{
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<Imath::V3f*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, mesh.positions.size()));
    for (size_t v = 0; v < mesh.positions.size(); ++v)
        vertices[v] = frame.to_scene(mesh.positions[v]);
    void* indices
        = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.triangles.size());
    std::memcpy(indices, mesh.triangles.data(), mesh.triangles.size() * 12);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    return scene;
}

int64_t trace(const Rays& rays, RTCScene scene, int threads)
{
    constexpr int64_t kTexels = 512;
    std::vector<int64_t> open(size_t(threads) * 16);
    const int64_t chunks = (int64_t(rays.origins.size()) + kTexels - 1) / kTexels;
    parallel_items(chunks, threads, [&](int64_t chunk, int worker) {
        const embree::FlushDenormals flush;
        embree::Query query;
        int64_t count = 0;
        const size_t end = std::min(size_t(chunk + 1) * kTexels, rays.origins.size());
        for (size_t texel = size_t(chunk) * kTexels; texel < end; ++texel) {
            const Imath::V3f& origin = rays.origins[texel];
            RTCRay8 ray;
            for (int lane = 0; lane < 8; ++lane) {
                ray.org_x[lane] = origin.x, ray.org_y[lane] = origin.y, ray.org_z[lane] = origin.z;
                ray.tnear[lane] = ray.time[lane] = 0;
                ray.mask[lane] = ~0u, ray.id[lane] = ray.flags[lane] = 0;
            }
            for (int p = 0; p < rays.packets_each; ++p) {
                const size_t packet = texel * size_t(rays.packets_each) + size_t(p);
                const float* d = &rays.directions[packet * 24];
                alignas(32) int valid[8];
                for (int lane = 0; lane < 8; ++lane) {
                    valid[lane] = rays.lanes[packet] >> lane & 1 ? -1 : 0;
                    ray.tfar[lane] = std::numeric_limits<float>::infinity();
                }
                std::memcpy(ray.dir_x, d, 32), std::memcpy(ray.dir_y, d + 8, 32), std::memcpy(ray.dir_z, d + 16, 32);
                query.occluded8(valid, scene, ray);
                for (int lane = 0; lane < 8; ++lane)
                    count += valid[lane] && ray.tfar[lane] >= 0;
            }
        }
        open[size_t(worker) * 16] += count;
    });
    int64_t total = 0;
    for (int64_t count : open)
        total += count;
    return total;
}

} // namespace

int main(int argc, const char** argv)
{
    if (argc < 2) {
        std::printf("usage: bake_bench MESH [resolution samples threads]\n");
        return 2;
    }
    const int threads = argc > 4 ? std::atoi(argv[4]) : worker_count(0);
    VismapParams params;
    params.resolution.width = params.resolution.height = argc > 2 ? std::atoi(argv[2]) : 1024;
    params.samples = argc > 3 ? std::atoi(argv[3]) : 64;
    params.reconstruct = "off";
    Mesh mesh;
    std::string error;
    if (!read_mesh(mesh, argv[1], {}, error)) {
        std::printf("%s\n", error.c_str());
        return 1;
    }

    const SceneFrame frame = SceneFrame::around(mesh);
    const UvRaster raster(mesh, params.resolution.width, params.resolution.height);
    const SamplePattern pattern(params.sampler, params.samples, false);
    Surface surface(mesh, frame);
    RTCDevice device = rtcNewDevice(("threads=" + std::to_string(threads)).c_str());
    RTCScene scene = robust_scene(device, mesh, frame);

    std::vector<double> bare_seconds, bake_seconds;
    int64_t bare_rays = 0, bake_rays = 0;
    for (int round = 0; round < 5; ++round) {
        // Rays in portions of about 200 MB.
        const size_t portion = std::max<size_t>(1, (size_t(200) << 20) / (size_t(pattern.count()) * 12));
        Rays rays;
        RayFan fan(pattern.count());
        double seconds = 0;
        bare_rays = 0;
        const auto flush = [&] {
            vmlight::Stopwatch timer;
            trace(rays, scene, threads);
            seconds += timer();
            for (uint8_t lanes : rays.lanes)
                bare_rays += __builtin_popcount(lanes);
            rays = Rays();
        };
        TileCover cover;
        for (int tile = 0; tile < raster.tiles_across() * raster.tiles_down(); ++tile) {
            raster.cover(tile, cover);
            const int tile_x = tile % raster.tiles_across() * kTileSize,
                      tile_y = tile / raster.tiles_across() * kTileSize;
            for (int i = 0; i < kTileSize * kTileSize; ++i) {
                const int block = i / 64, x = block % 8 * 8 + i % 8, y = block / 8 * 8 + i / 8 % 8;
                const size_t texel = size_t(y) * kTileSize + size_t(x);
                if (cover.triangle[texel] == TileCover::kNone)
                    continue;
                const SurfacePoint p = surface.at(cover.triangle[texel], cover.weight1[texel], cover.weight2[texel]);
                const Point32 shift = pattern.texel(tile_x + x, tile_y + y, 0);
                pattern.directions(fan, TangentFrame(p.normal), p.geometric_normal, shift);
                rays.packets_each = fan.packets;
                rays.origins.push_back(p.origin);
                for (int packet = 0; packet < fan.packets; ++packet)
                    for (const float* axis : { fan.x, fan.y, fan.z })
                        rays.directions.insert(rays.directions.end(), axis + packet * 8, axis + packet * 8 + 8);
                rays.lanes.insert(rays.lanes.end(), fan.lanes.begin(), fan.lanes.end());
                if (rays.origins.size() == portion)
                    flush();
            }
        }
        flush();
        bare_seconds.push_back(seconds);

        OIIO::ImageBuf vismap;
        VismapReport report;
        vmlight::Stopwatch timer;
        make_vismap(vismap, mesh, {}, params, &report, threads);
        bake_seconds.push_back(timer());
        bake_rays = report.rays;
    }
    if (bare_rays != bake_rays)
        std::printf("the two traced different rays: %lld and %lld\n", (long long)bare_rays, (long long)bake_rays);
    const double bare = double(bare_rays) * 1e-6 / median(bare_seconds);
    const double bake = double(bake_rays) * 1e-6 / median(bake_seconds);
    std::printf("%dx%d, %d samples, %d threads: %.1f M rays; bare loop %.2f M rays/s, bake %.2f M rays/s, ratio %.3f\n",
                params.resolution.width, params.resolution.height, params.samples, threads, double(bake_rays) * 1e-6,
                bare, bake, bake / bare);
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
    return 0;
}
