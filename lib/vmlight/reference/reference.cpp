// SPDX-License-Identifier: Apache-2.0
#include <vmlight/reference/reference.h>

#include <vmlight/base/fail_with.h>
#include <vmlight/base/format.h>
#include <vmlight/base/parallel.h>
#include <vmlight/lightmap/environment_light.h>
#include <vmlight/math/latlong.h>
#include <vmlight/math/sampling.h>
#include <vmlight/reference/bounce_paths.h>
#include <vmlight/reference/random.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/trace/surface.h>
#include <vmlight/uv/raster.h>
#include <vmlight/uv/tile_progress.h>
#include <vmlight/vismap/ground_of.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vmlight {
namespace {

using Imath::V3d;
using Imath::V3f;
using latlong::pi;

constexpr int kChannels = 7;
constexpr int kPairs = 128; // traced at once

// Running means and squared deviations of three channels.
// Source: B. P. Welford, "Note on a Method for Calculating Corrected Sums of Squares and Products", 1962.
struct Moments
{
    V3d mean { 0 }, squares { 0 };
    int64_t count = 0;

    void add(const V3d& value)
    {
        const V3d before = value - mean;
        mean += before / double(++count);
        squares += before * (value - mean);
    }
    double standard_error(int channel) const
    {
        return std::sqrt(squares[channel] / (double(count) * double(count - 1)));
    }
};

// One per thread.
class Tracer
{
public:
    Tracer(const Occluder& occluder, const GroundPlane& ground, const EnvironmentLight& light,
           const Rotation& to_environment, float length, std::unique_ptr<BouncePaths> bounce)
        : m_occluder(occluder)
        , m_ground(ground)
        , m_light(light)
        , m_to_environment(to_environment)
        , m_to_object(to_environment.transposed())
        , m_length(length)
        , m_fan(2 * kPairs)
        , m_values(2 * kPairs)
        , m_bounce(std::move(bounce))
    {
    }

    /// @param more     for what only bounced light needs
    Moments trace(const SurfacePoint& point, ReferenceRandom random, ReferenceRandom more, int pairs)
    {
        Moments moments;
        const TangentFrame frame(point.normal);
        for (int done = 0; done < pairs; done += kPairs) {
            const int count = std::min(kPairs, pairs - done);
            std::fill(m_fan.lanes.begin(), m_fan.lanes.end(), uint8_t(0));
            for (int i = 0; i < count; ++i) {
                const double radius = std::sqrt(random.next()), angle = 2 * pi * random.next();
                const double x = radius * std::cos(angle), y = radius * std::sin(angle);
                const double z = std::sqrt(std::max(0.0, 1 - radius * radius));
                const V3d around = V3d(frame.tangent) * x + V3d(frame.bitangent) * y + V3d(frame.normal) * z;
                take(2 * i, point, around, m_light.at(rotate(m_to_environment, around)));
                const double u = random.next(), v = random.next();
                const EnvironmentSample bright = m_light.sample(u, v);
                take(2 * i + 1, point, rotate(m_to_object, bright.direction), bright);
            }
            m_ground.clear_blocked(m_fan, point);
            m_occluder.clear_blocked(m_fan, point.origin, m_length, point.is_near);
            m_bounced.assign(size_t(count), V3d(0));
            for (int i = 0; i < count && m_bounce; ++i)
                m_bounce->add(point, V3d(m_fan.x[2 * i], m_fan.y[2 * i], m_fan.z[2 * i]), m_bounced[size_t(i)], more);
            if (m_bounce)
                m_bounce->flush(point, more);
            for (int i = 0; i < count; ++i)
                moments.add(seen(2 * i) + seen(2 * i + 1) + m_bounced[size_t(i)]);
        }
        return moments;
    }

private:
    // Set the ray, and the light that it carries if nothing blocks it: by the balance heuristic, light over the sum of
    // both densities.
    void take(int ray, const SurfacePoint& point, const V3d& direction, const EnvironmentSample& light)
    {
        const double cosine = direction.dot(V3d(point.normal));
        const double above = direction.dot(V3d(point.geometric_normal));
        m_fan.x[ray] = float(direction.x);
        m_fan.y[ray] = float(direction.y);
        m_fan.z[ray] = float(direction.z);
        const bool counts = cosine > 0 && above > 0 && light.radiance != V3f(0);
        m_values[size_t(ray)] = counts ? V3d(light.radiance) * (cosine / (cosine + pi * light.density)) : V3d(0);
        m_fan.lanes[size_t(ray / kPacketSize)] |= uint8_t(counts) << ray % kPacketSize;
    }
    V3d seen(int ray) const
    {
        return m_fan.lanes[size_t(ray / kPacketSize)] >> ray % kPacketSize & 1 ? m_values[size_t(ray)] : V3d(0);
    }

    const Occluder& m_occluder;
    const GroundPlane m_ground;
    const EnvironmentLight& m_light;
    const Rotation m_to_environment, m_to_object;
    const float m_length;
    RayFan m_fan;
    std::vector<V3d> m_values, m_bounced;
    std::unique_ptr<BouncePaths> m_bounce; // nullptr without
};

OIIO::ImageSpec reference_spec(const VismapParams& map, const LightmapParams& light, const ReferenceParams& params)
{
    OIIO::ImageSpec spec(map.size().width, map.size().height, kChannels, OIIO::TypeFloat);
    spec.channelnames = { "R", "G", "B", "error.R", "error.G", "error.B", "coverage" };
    append_params(spec, params);
    append_params(spec, light);
    spec.erase_attribute("vmlight:model");
    return spec;
}

} // namespace

bool make_reference(OIIO::ImageBuf& dst, const Mesh& mesh, const std::vector<Mesh>& occluders,
                    const OIIO::ImageBuf& env, const VismapParams& map, const LightmapParams& light,
                    const ReferenceParams& params, int nthreads, const Progress& progress)
{
    std::string error;
    BakeScene scene;
    SceneChoice choice = SceneChoice::within(map.max_distance);
    choice.cull = params.bounce_albedo == 0; // else rays start from occluders too
    return scene.build(non_owning(mesh), occluders, nthreads, error, choice)
        ? make_reference(dst, scene, env, map, light, params, nthreads, progress)
        : fail_with(dst, error);
}

bool make_reference(OIIO::ImageBuf& dst, const BakeScene& scene, const OIIO::ImageBuf& env, const VismapParams& map,
                    const LightmapParams& light, const ReferenceParams& params, int nthreads, const Progress& progress)
{
    std::string error;
    Rotation rotation;
    EnvironmentLight sky;
    if (!check_params(map, error) || !check_params(params, error) || !lightmap_rotation(rotation, light, error)
        || !sky.build(env, params.sanitize, error))
        return fail_with(dst, error);

    dst.reset(reference_spec(map, light, params), OIIO::InitializePixels::Yes);
    float* pixels = static_cast<float*>(dst.localpixels());
    const int width = dst.spec().width, height = dst.spec().height;
    if (!pixels)
        return fail_with(dst, format("out of memory for {}x{} texels", width, height));
    const float length = float(map.max_distance * scene.frame().scale);
    const double gain = std::exp2(light.exposure);
    const UvRaster raster(scene.mesh(), width, height, map.udim);
    struct Worker
    {
        Tracer tracer;
        Surface surface;
        TileCover cover;
    };
    std::vector<std::unique_ptr<Worker>> workers(size_t(worker_count(nthreads)));
    const auto bounce = [&] {
        return params.bounce_albedo > 0
            ? std::make_unique<BouncePaths>(scene, ground_of(scene, map), sky, rotation, length, params.bounce_albedo)
            : nullptr;
    };
    for (auto& worker : workers)
        worker.reset(new Worker { { scene.occluder(), ground_of(scene, map), sky, rotation, length, bounce() },
                                  { scene.mesh(), scene.frame() },
                                  {} });
    TileProgress done(raster, nthreads, progress);
    if (done.stopped())
        return fail_with(dst, "interrupted");
    const auto trace = [&](int64_t tile, int index) {
        Worker& worker = *workers[size_t(index)];
        raster.cover(int(tile), worker.cover);
        const int left = int(tile % raster.tiles_across()) * kTileSize,
                  top = int(tile / raster.tiles_across()) * kTileSize;
        for (int i = 0; i < kTileSize * kTileSize; ++i) {
            if (worker.cover.triangle[size_t(i)] == TileCover::kNone)
                continue;
            const int x = left + i % kTileSize, y = top + i / kTileSize;
            SurfacePoint point = worker.surface.at(worker.cover.triangle[size_t(i)], worker.cover.weight1[size_t(i)],
                                                   worker.cover.weight2[size_t(i)]);
            adjust_ray_origins(&point, 1, scene.occluder());
            const Moments moments = worker.tracer.trace(point, ReferenceRandom(x, y, params.seed),
                                                        ReferenceRandom(x, y, ~params.seed), params.samples);
            const double above = 0.5 * (1 + double(point.normal.dot(point.geometric_normal)));
            float* texel = pixels + (size_t(y) * size_t(width) + size_t(x)) * kChannels;
            for (int c = 0; c < 3; ++c) {
                texel[c] = float(moments.mean[c] * gain / above);
                texel[3 + c] = float(moments.standard_error(c) * gain / above);
            }
            texel[6] = 1;
        }
        done.add(worker.cover.covered);
    };
    const int64_t tiles = int64_t(raster.tiles_across()) * raster.tiles_down();
    return parallel_items(tiles, nthreads, trace, done.listener()) || fail_with(dst, "interrupted");
}

} // namespace vmlight
