// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/render.h>

#include <vmlight/base/parallel.h>
#include <vmlight/frame/surface_color.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

namespace vmlight {
namespace {

using Imath::C3f;
using Imath::V3d;

constexpr int kTile = 32; // pixels: rays of a tile run side by side
constexpr int kMostLayersOfAlpha = 32;

// What one sample adds to its pixel.
struct Sample
{
    C3f color { 0, 0, 0 };
    double alpha = 0;
    SeenPoint first; // the first point that is not wholly transparent
};

class Renderer
{
public:
    Renderer(OIIO::ImageBuf& dst, const FrameScene& scene, const Camera& camera, const RenderParams& params)
        : m_dst(dst)
        , m_scene(scene)
        , m_camera(camera)
        , m_size(params.size)
        , m_samples(pixel_samples(params.spp, params.filter))
        , m_footprint(1 / std::sqrt(double(params.spp)))
    {
        for (const FrameLayer& layer : frame_layers())
            if (std::find(params.layers.begin(), params.layers.end(), layer.name) != params.layers.end()) {
                m_layers.push_back(&layer);
                m_needs_visibility |= layer.needs_visibility;
            }
        // The sample nearest to the centre speaks for the layers that are not filtered.
        const auto distance = [](const PixelSample& s) { return s.x * s.x + s.y * s.y; };
        m_middle = size_t(
            std::min_element(m_samples.begin(), m_samples.end(),
                             [&](const PixelSample& a, const PixelSample& b) { return distance(a) < distance(b); })
            - m_samples.begin());
        const double depth = (scene.centre - camera.position).dot(camera.forward);
        m_start = std::max(0.0, depth - 1.001 * scene.radius);
    }

    int tiles_across() const { return (m_size.width + kTile - 1) / kTile; }
    int tiles_down() const { return (m_size.height + kTile - 1) / kTile; }

    bool render_tile(int64_t tile, std::string& error) const
    {
        const int left = int(tile % tiles_across()) * kTile, top = int(tile / tiles_across()) * kTile;
        for (int y = top; y < std::min(top + kTile, m_size.height); ++y)
            for (int x = left; x < std::min(left + kTile, m_size.width); ++x)
                if (!render_pixel(x, y, error))
                    return false;
        return true;
    }

private:
    CameraRay ray_through(int x, int y, const PixelSample& sample) const
    {
        CameraRay ray = m_camera.ray(x + 0.5 + sample.x, y + 0.5 + sample.y, m_size.width, m_size.height);
        for (V3d CameraRay::*change :
             { &CameraRay::origin_dx, &CameraRay::origin_dy, &CameraRay::direction_dx, &CameraRay::direction_dy })
            ray.*change *= m_footprint;
        return ray;
    }

    bool render_pixel(int x, int y, std::string& error) const
    {
        constexpr int kChannels = 64;
        std::array<double, kChannels> sum {};
        auto* pixel = static_cast<float*>(m_dst.pixeladdr(x, y));
        for (size_t first = 0; first < m_samples.size(); first += kPacketSize) {
            const int count = int(std::min(m_samples.size() - first, size_t(kPacketSize)));
            std::array<CameraRay, kPacketSize> rays;
            std::array<SurfaceRay, kPacketSize> packet;
            std::array<SurfaceHit, kPacketSize> hits;
            for (int i = 0; i < count; ++i) {
                rays[i] = ray_through(x, y, m_samples[first + size_t(i)]);
                packet[i] = { rays[i].origin, rays[i].direction, m_start };
            }
            m_scene.tracer->find(packet.data(), count, hits.data());
            for (int i = 0; i < count; ++i) {
                Sample sample;
                if (!shade(sample, rays[i], hits[i], error))
                    return false;
                add(sum.data(), pixel, sample, first + size_t(i) == m_middle);
            }
        }
        const double scale = 1 / double(m_samples.size());
        for (int c = 0; c < 4; ++c)
            pixel[c] = float(sum[c] * scale);
        int channel = 4;
        for (const FrameLayer* layer : m_layers)
            for (size_t c = 0; c < layer->channels.size(); ++c, ++channel)
                if (layer->is_filtered)
                    pixel[channel] = float(sum[channel] * scale);
        return true;
    }

    void add(double* sum, float* pixel, const Sample& sample, bool is_middle) const
    {
        for (int c = 0; c < 3; ++c)
            sum[c] += double(sample.color[c]);
        sum[3] += sample.alpha;
        int channel = 4;
        for (const FrameLayer* layer : m_layers) {
            std::array<float, kMostLayerChannels> value {};
            value.fill(layer->nothing);
            if (sample.first.surface)
                layer->value(sample.first, value.data());
            for (size_t c = 0; c < layer->channels.size(); ++c, ++channel) {
                if (!layer->is_filtered) {
                    if (is_middle)
                        pixel[channel] = value[c];
                } else if (sample.first.surface) {
                    sum[channel] += double(value[c]) * sample.first.alpha;
                }
            }
        }
    }

    // From front to back, as far as there is something to see through.
    bool shade(Sample& dst, const CameraRay& ray, SurfaceHit hit, std::string& error) const
    {
        double open = 1, start = m_start;
        for (int depth = 0; hit.exists() && depth < kMostLayersOfAlpha && open > 0; ++depth) {
            SeenPoint seen;
            seen.surface = &m_scene.surfaces[hit.mesh];
            seen.triangle = hit.triangle;
            const bool is_point = intersect_plane(seen.point, ray, *seen.surface->mesh, hit.triangle);
            if (is_point) {
                look_up_material(seen);
                if (seen.alpha > 0 && !add_surface(dst, seen, open, error))
                    return false;
                if (!(open > 0))
                    break;
                start = std::max(start, seen.point.depth);
            }
            // Behind the surface that was met, by more than its position is rounded.
            start += 4e-7 * (std::abs(start) + m_scene.radius);
            const SurfaceRay onward { ray.origin, ray.direction, start };
            m_scene.tracer->find(&onward, 1, &hit);
        }
        if (m_scene.background.is_visible && open > 0) {
            dst.color += m_scene.background.look(ray) * float(open);
            open = 0;
        }
        dst.alpha = 1 - open;
        return true;
    }

    bool add_surface(Sample& dst, SeenPoint& seen, double& open, std::string& error) const
    {
        if (!look_up_light(seen, m_needs_visibility && !dst.first.surface, error))
            return false;
        C3f color = seen.light * seen.albedo;
        if (seen.surface->catches_shadows) {
            const float lit = (seen.light.x + seen.light.y + seen.light.z) / 3;
            const float share = seen.surface->unshadowed > 0 ? lit / seen.surface->unshadowed : 1;
            seen.alpha *= double(std::clamp(1 - share, 0.0f, 1.0f));
            color = C3f(0, 0, 0);
        }
        dst.color += color * float(seen.alpha * open);
        open *= 1 - seen.alpha;
        if (!dst.first.surface)
            dst.first = seen;
        return true;
    }

    OIIO::ImageBuf& m_dst;
    const FrameScene& m_scene;
    const Camera& m_camera;
    const Size m_size;
    const std::vector<PixelSample> m_samples;
    const double m_footprint;
    std::vector<const FrameLayer*> m_layers;
    bool m_needs_visibility = false;
    size_t m_middle = 0;
    double m_start = 0;
};

} // namespace

bool render_frame(OIIO::ImageBuf& dst, const FrameScene& scene, const Camera& camera, const RenderParams& params,
                  int nthreads, const Progress& progress, std::string& error)
{
    OIIO::ImageSpec spec(params.size.width, params.size.height, 4, OIIO::TypeFloat);
    spec.channelnames = { "R", "G", "B", "A" };
    for (const FrameLayer& layer : frame_layers())
        if (std::find(params.layers.begin(), params.layers.end(), layer.name) != params.layers.end())
            spec.channelnames.insert(spec.channelnames.end(), layer.channels.begin(), layer.channels.end());
    spec.nchannels = int(spec.channelnames.size());
    spec.alpha_channel = 3;
    dst.reset(spec);

    const Renderer renderer(dst, scene, camera, params);
    std::mutex mutex;
    std::string reason;
    const auto work = [&](int64_t tile, int) {
        std::string fault;
        if (renderer.render_tile(tile, fault))
            return;
        const std::lock_guard<std::mutex> lock(mutex);
        reason = fault;
    };
    const bool finished
        = parallel_items(int64_t(renderer.tiles_across()) * renderer.tiles_down(), nthreads, work, progress);
    error = !reason.empty() ? reason : finished ? "" : "interrupted";
    return error.empty();
}

} // namespace vmlight
