// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/light_transport.h>

#include <vmlight/base/available_memory.h>
#include <vmlight/base/format.h>
#include <vmlight/base/parallel.h>
#include <vmlight/base/work_counts.h>
#include <vmlight/vismap/transport_tile.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>

namespace vmlight {

using Imath::V3f;

namespace {

// A tracer for each thread that asks for one.
class Tracers
{
public:
    Tracers(const TransportMap& map, int nthreads)
        : m_map(map)
        , m_all(size_t(worker_count(nthreads)))
    {
    }
    TransportTracer& at(int worker)
    {
        auto& tracer = m_all[size_t(worker)];
        if (!tracer)
            tracer = std::make_unique<TransportTracer>(m_map);
        return *tracer;
    }
    int64_t rays() const
    {
        int64_t rays = 0;
        for (const auto& tracer : m_all)
            rays += tracer ? tracer->rays() : 0;
        return rays;
    }

private:
    const TransportMap& m_map;
    std::vector<std::unique_ptr<TransportTracer>> m_all;
};

Progress half_from(double from, const Progress& progress)
{
    return progress ? Progress([&progress, from](double done) { return progress(from + 0.5 * done); }) : Progress();
}

} // namespace

LightTransport::LightTransport() = default;
LightTransport::~LightTransport() = default;

void LightTransport::clear()
{
    m_map.reset();
    m_tiles.clear();
    m_points.clear();
    m_surfaces.clear();
    m_first_point.clear();
}

bool LightTransport::prepare(BakeScenePointer scene, const VismapParams& map, OIIO::cspan<float> visibility,
                             const TransportParams& params, std::string& error, int nthreads, const Progress& progress,
                             NormalMapPointer normal_map)
{
    clear();
    m_rays = 0;
    if (!check_params(map, error) || !check_memory(map, visibility, params, error))
        return false;
    m_map = std::make_unique<TransportMap>(std::move(scene), map, std::move(normal_map), params.rays, params.ground);
    m_map->visibility.assign(visibility.begin(), visibility.end());
    if (trace_all(error, nthreads, progress))
        return true;
    clear();
    return false;
}

// Sets m_is_kept.
bool LightTransport::check_memory(const VismapParams& map, OIIO::cspan<float> visibility, const TransportParams& params,
                                  std::string& error)
{
    if (params.rays < 8 || params.rays > TransportTile::kMostRays) {
        error = format("{} rays; 8 to {} are allowed", params.rays, TransportTile::kMostRays);
        return false;
    }
    // Normals and patches of texels, their light, and what they get; then what is kept of rays, at most.
    const double texels = double(map.size().width) * map.size().height;
    double hidden = visibility.empty() ? texels : 0;
    for (const float v : visibility)
        hidden += std::max(0.0, 1 - double(v));
    const double needed = texels * (16 + 4 + 4 + 12 + 12),
                 kept = hidden * params.rays * 4 + texels * sizeof(TransportTile::Receiver);
    const auto available = double(available_memory());
    m_is_kept = kept <= double(params.most_bytes) && needed + kept <= available;
    if (needed > available)
        error = format("bounced light of {}x{} texels needs {} of memory, {} available", map.size().width,
                       map.size().height, OIIO::Strutil::memformat(int64_t(needed)),
                       OIIO::Strutil::memformat(int64_t(available)));
    return needed <= available;
}

bool LightTransport::trace_all(std::string& error, int nthreads, const Progress& progress)
{
    TransportMap& map = *m_map;
    const auto add_patches = [&](int tile, const std::vector<MapPoint>& points) { map.patches.add(tile, points); };
    if (!map.points.prepare(0, nthreads, half_from(0, progress), add_patches)) {
        error = "interrupted";
        return false;
    }
    map.patches.number();

    // Cells are numbered in the order of the tiles, whatever thread traces them.
    Tracers tracers(map, nthreads);
    std::vector<TracedTile> traced(size_t(map.points.tiles()));
    const auto trace = [&](int64_t tile, int worker) {
        const TracedTile& own = tracers.at(worker).trace(int(tile));
        if (m_is_kept)
            traced[size_t(tile)] = own;
        else
            traced[size_t(tile)].cells = own.cells;
    };
    const bool done = parallel_items(map.points.tiles(), nthreads, trace, half_from(0.5, progress));
    m_rays += tracers.rays();
    work_counts().bounce_rays += m_rays;
    if (!done) {
        error = "interrupted";
        return false;
    }
    std::vector<uint32_t> ignored;
    for (const TracedTile& tile : traced)
        map.cells.merge(tile.cells, ignored);
    if (map.patches.count() + map.cells.cells().size() >= TransportTile::kMostNumbers) {
        error = format("bounced light comes from {} parts of surfaces; {} are allowed: use a smaller map",
                       map.patches.count() + map.cells.cells().size(), TransportTile::kMostNumbers);
        return false;
    }
    number_points();
    if (!m_is_kept)
        return true;
    m_tiles.resize(traced.size());
    parallel_items(int64_t(traced.size()), nthreads, [&](int64_t tile, int worker) {
        tracers.at(worker).count(m_tiles[size_t(tile)], traced[size_t(tile)]);
        m_tiles[size_t(tile)].entries.shrink_to_fit();
        traced[size_t(tile)] = {};
    });
    map.visibility = {};
    return true;
}

void LightTransport::number_points()
{
    for (const LightCells::Cell& cell : m_map->cells.cells()) {
        m_first_point.push_back(uint32_t(m_points.size()));
        m_points.insert(m_points.end(), cell.points.begin(), cell.points.begin() + cell.count);
    }
    m_first_point.push_back(uint32_t(m_points.size()));
    for (const LightPoint& point : m_points)
        m_surfaces.push_back(point.surface);
}

// What patches and then cells send out.
std::vector<V3f> LightTransport::light_of(OIIO::cspan<float> map, OIIO::cspan<float> points, int nthreads) const
{
    const uint32_t patches = m_map->patches.count();
    std::vector<V3f> light(patches + m_map->cells.cells().size());
    m_map->patches.average(light.data(), map.data(), nthreads);
    for (size_t cell = 0; cell + 1 < m_first_point.size(); ++cell) {
        const uint32_t first = m_first_point[cell], end = m_first_point[cell + 1];
        V3f sum(0);
        for (uint32_t i = first; i < end; ++i)
            sum += V3f(points[3 * i], points[3 * i + 1], points[3 * i + 2]);
        light[patches + cell] = sum / float(end - first);
    }
    return light;
}

bool LightTransport::gather(std::vector<float>& dst, OIIO::cspan<float> map, OIIO::cspan<float> points, int nthreads,
                            const Progress& progress) const
{
    const MapPoints& texels = m_map->points;
    const std::vector<V3f> light = light_of(map, points, nthreads);
    dst.assign(3 * size_t(texels.width()) * size_t(texels.height()), 0.0f);
    Tracers tracers(*m_map, nthreads);
    std::vector<TransportTile> again(size_t(worker_count(nthreads)));
    const auto gather_tile = [&](int64_t index, int worker) {
        const int tile = int(index);
        const TransportTile& kept = m_is_kept ? m_tiles[size_t(tile)] : again[size_t(worker)];
        if (!m_is_kept) {
            TransportTracer& tracer = tracers.at(worker);
            tracer.count(again[size_t(worker)], tracer.trace(tile));
        }
        const int left = texels.left(tile), top = texels.top(tile);
        const uint32_t* entry = kept.entries.data();
        for (const TransportTile::Receiver& receiver : kept.receivers) {
            V3f sum(0);
            for (const uint32_t* end = entry + receiver.entries; entry != end; ++entry)
                sum += light[TransportTile::number_of(*entry)] * float(TransportTile::count_of(*entry));
            const int x = left + receiver.texel % kTileSize, y = top + receiver.texel / kTileSize;
            float* rgb = &dst[3 * (size_t(y) * size_t(texels.width()) + size_t(x))];
            for (int c = 0; c < 3; ++c)
                rgb[c] = sum[c] * receiver.scale;
        }
    };
    const bool done = parallel_items(texels.tiles(), nthreads, gather_tile, progress);
    m_rays += tracers.rays();
    work_counts().bounce_rays += tracers.rays();
    ++work_counts().bounces_made;
    if (done)
        texels.margin().fill(dst.data(), 3);
    return done;
}

size_t LightTransport::bytes() const
{
    if (!m_map)
        return 0;
    size_t bytes = m_map->points.bytes() + m_map->patches.bytes() + m_map->cells.bytes()
        + m_points.capacity() * (sizeof(LightPoint) + sizeof(SurfacePoint))
        + m_map->visibility.capacity() * sizeof(float);
    for (const TransportTile& tile : m_tiles)
        bytes
            += tile.receivers.capacity() * sizeof(TransportTile::Receiver) + tile.entries.capacity() * sizeof(uint32_t);
    return bytes;
}

} // namespace vmlight
