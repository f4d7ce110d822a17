// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/render.h>

#include <vmlight/base/parallel.h>
#include <vmlight/frame/corner_grid.h>
#include <vmlight/frame/pixel_cover.h>
#include <vmlight/frame/sample_shader.h>
#include <vmlight/math/ray_fan.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

namespace vmlight {
namespace {

constexpr int kTile = 32; // pixels: rays of a tile run side by side
constexpr int kMostChannels = 64;
// With fewer samples there is nothing to save.
constexpr int kLeastForEdges = 4;

std::vector<const FrameLayer*> layers_of(const RenderParams& params)
{
    std::vector<const FrameLayer*> layers;
    for (const FrameLayer& layer : frame_layers())
        if (std::find(params.layers.begin(), params.layers.end(), layer.name) != params.layers.end())
            layers.push_back(&layer);
    return layers;
}

class Renderer
{
public:
    Renderer(OIIO::ImageBuf& dst, const FrameScene& scene, const Camera& camera, const RenderParams& params,
             int nthreads)
        : m_dst(dst)
        , m_background(scene.background)
        , m_camera(camera)
        , m_size(params.size)
        , m_layers(layers_of(params))
        , m_samples(pixel_samples(params.spp, params.filter))
        , m_footprint(1 / std::sqrt(double(params.spp)))
        , m_samples_edges(params.sampling == "edges" && params.spp >= kLeastForEdges)
        , m_weights(CornerGrid::weights(filter_variance(params.filter)))
        , m_shader(scene, camera,
                   std::any_of(m_layers.begin(), m_layers.end(),
                               [](const FrameLayer* layer) { return layer->needs_visibility; }))
        // At least as far as the corners that are mixed.
        , m_cover(scene, camera, params.size, std::max(filter_radius(params.filter) - 0.5, 1.0), nthreads)
    {
        // The sample nearest to the centre speaks for the layers that are not filtered.
        const auto distance = [](const PixelSample& s) { return s.x * s.x + s.y * s.y; };
        const auto nearer = [&](const PixelSample& a, const PixelSample& b) { return distance(a) < distance(b); };
        m_middle = size_t(std::min_element(m_samples.begin(), m_samples.end(), nearer) - m_samples.begin());
        m_has_unfiltered = std::any_of(m_layers.begin(), m_layers.end(),
                                       [](const FrameLayer* layer) { return !layer->is_filtered; });
    }

    int tiles_across() const { return (m_size.width + kTile - 1) / kTile; }
    int tiles_down() const { return (m_size.height + kTile - 1) / kTile; }

    bool render_tile(int64_t tile, std::string& error) const
    {
        const int left = int(tile % tiles_across()) * kTile, top = int(tile / tiles_across()) * kTile;
        const int width = std::min(kTile, m_size.width - left), height = std::min(kTile, m_size.height - top);
        if (!m_background.is_visible && m_cover.is_empty(left, top, width, height)) {
            for (int y = top; y < top + height; ++y)
                for (int x = left; x < left + width; ++x)
                    store_nothing(x, y);
            return true;
        }
        CornerGrid grid;
        if (m_samples_edges
            && !grid.fill(m_shader, m_camera, m_size, left, top, width, height, m_layers.empty(), error))
            return false;
        for (int y = top; y < top + height; ++y)
            for (int x = left; x < left + width; ++x)
                if (!render_pixel(x, y, grid, error))
                    return false;
        return true;
    }

private:
    bool render_pixel(int x, int y, const CornerGrid& grid, std::string& error) const
    {
        const bool is_empty = m_cover.is_empty(x, y);
        if (is_empty && !m_background.is_visible)
            store_nothing(x, y);
        else if (m_samples_edges && (is_empty || (!m_cover.has_strand(x, y) && grid.is_smooth(x, y))))
            return mix_corners(x, y, grid, error);
        else
            return sample_pixel(x, y, error);
        return true;
    }

    void store_nothing(int x, int y) const
    {
        store(x, y, {});
        store_unfiltered(x, y, {});
    }

    using Sums = std::array<double, kMostChannels>;

    CameraRay ray_through(int x, int y, const PixelSample& sample) const
    {
        CameraRay ray = m_camera.ray(x + 0.5 + sample.x, y + 0.5 + sample.y, m_size.width, m_size.height);
        ray.scale_differentials(m_footprint);
        return ray;
    }

    bool sample_pixel(int x, int y, std::string& error) const
    {
        Sums sum {};
        const double share = 1 / double(m_samples.size());
        std::array<CameraRay, kPacketSize> rays;
        std::array<FrameSample, kPacketSize> seen;
        for (size_t first = 0; first < m_samples.size(); first += kPacketSize) {
            const int count = int(std::min(m_samples.size() - first, size_t(kPacketSize)));
            for (int i = 0; i < count; ++i)
                rays[i] = ray_through(x, y, m_samples[first + size_t(i)]);
            if (!m_shader.shade(seen.data(), rays.data(), count, error))
                return false;
            for (int i = 0; i < count; ++i) {
                add(sum, seen[i], share);
                if (first + size_t(i) == m_middle)
                    store_unfiltered(x, y, seen[i]);
            }
        }
        store(x, y, sum);
        return true;
    }

    bool mix_corners(int x, int y, const CornerGrid& grid, std::string& error) const
    {
        Sums sum {};
        for (int j = 0; j < CornerGrid::kAround; ++j)
            for (int i = 0; i < CornerGrid::kAround; ++i)
                add(sum, grid.around(x, y, i, j), m_weights[i] * m_weights[j]);
        // Weights below 0 sharpen; they must not make light negative.
        for (int c = 0; c < 3; ++c)
            sum[c] = std::max(sum[c], 0.0);
        sum[3] = 1;
        store(x, y, sum);
        if (!m_has_unfiltered)
            return true;
        FrameSample middle;
        const CameraRay ray = ray_through(x, y, m_samples[m_middle]);
        if (!m_shader.shade(&middle, &ray, 1, error))
            return false;
        store_unfiltered(x, y, middle);
        return true;
    }

    void add(Sums& sum, const FrameSample& sample, double share) const
    {
        for (int c = 0; c < 3; ++c)
            sum[c] += double(sample.color[c]) * share;
        sum[3] += sample.alpha * share;
        if (!sample.first.surface)
            return;
        int channel = 4;
        for (const FrameLayer* layer : m_layers) {
            if (layer->is_filtered) {
                std::array<float, kMostLayerChannels> value {};
                layer->value(sample.first, value.data());
                for (size_t c = 0; c < layer->channels.size(); ++c)
                    sum[size_t(channel) + c] += double(value[c]) * sample.first.alpha * share;
            }
            channel += int(layer->channels.size());
        }
    }

    void store(int x, int y, const Sums& sum) const
    {
        auto* pixel = static_cast<float*>(m_dst.pixeladdr(x, y));
        for (int c = 0; c < 4; ++c)
            pixel[c] = float(sum[c]);
        int channel = 4;
        for (const FrameLayer* layer : m_layers)
            for (size_t c = 0; c < layer->channels.size(); ++c, ++channel)
                if (layer->is_filtered)
                    pixel[channel] = float(sum[channel]);
    }

    void store_unfiltered(int x, int y, const FrameSample& sample) const
    {
        float* pixel = static_cast<float*>(m_dst.pixeladdr(x, y)) + 4;
        for (const FrameLayer* layer : m_layers) {
            if (!layer->is_filtered) {
                std::array<float, kMostLayerChannels> value {};
                value.fill(layer->nothing);
                if (sample.first.surface)
                    layer->value(sample.first, value.data());
                std::copy_n(value.begin(), layer->channels.size(), pixel);
            }
            pixel += layer->channels.size();
        }
    }

    OIIO::ImageBuf& m_dst;
    const Background& m_background;
    const Camera& m_camera;
    const Size m_size;
    const std::vector<const FrameLayer*> m_layers;
    const std::vector<PixelSample> m_samples;
    const double m_footprint;
    const bool m_samples_edges;
    const std::array<double, CornerGrid::kAround> m_weights;
    const SampleShader m_shader;
    const PixelCover m_cover;
    size_t m_middle = 0;
    bool m_has_unfiltered = false;
};

} // namespace

bool render_frame(OIIO::ImageBuf& dst, const FrameScene& scene, const Camera& camera, const RenderParams& params,
                  int nthreads, const Progress& progress, std::string& error)
{
    OIIO::ImageSpec spec(params.size.width, params.size.height, 4, OIIO::TypeFloat);
    spec.channelnames = { "R", "G", "B", "A" };
    for (const FrameLayer* layer : layers_of(params))
        spec.channelnames.insert(spec.channelnames.end(), layer->channels.begin(), layer->channels.end());
    spec.nchannels = int(spec.channelnames.size());
    spec.alpha_channel = 3;
    dst.reset(spec);

    const Renderer renderer(dst, scene, camera, params, nthreads);
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
