// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/light_transport.h>

#include <vmlight/base/available_memory.h>
#include <vmlight/base/format.h>
#include <vmlight/base/parallel.h>
#include <vmlight/base/work_counts.h>
#include <vmlight/vismap/bounce_rays.h>
#include <vmlight/vismap/ground_of.h>
#include <vmlight/vismap/map_patches.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>

namespace vmlight {

using Imath::V3f;

namespace {

// Of an entry: the number of what is met, and how often.
constexpr int kCountBits = 8;
constexpr uint32_t kMostNumbers = 1u << (32 - kCountBits);
constexpr int kMostRays = 248;

} // namespace

// What the rays of a tile met.
struct LightTransport::Tile
{
    struct Receiver
    {
        uint16_t texel; // in the tile
        uint16_t entries; // after those of the receivers before
        float scale; // of a ray
    };
    std::vector<Receiver> receivers;
    std::vector<uint32_t> entries; // numbers of patches and then cells, each shifted by kCountBits, and counts
};

struct LightTransport::Setup
{
    Setup(BakeScenePointer scene, const VismapParams& the_map, const TransportParams& the_params,
          NormalMapPointer normal_map)
        : map(std::move(scene), the_map, std::move(normal_map))
        , patches(map)
        , params(the_params)
        , pattern("fibonacci", params.rays, false)
        , ground(ground_of(map.scene(), the_map))
    {
    }
    MapPoints map;
    MapPatches patches;
    const TransportParams params;
    const SamplePattern pattern;
    const GroundPlane ground;
    std::vector<float> visibility; // V of the texels; empty: unknown
    LightCells cells;
    std::vector<uint32_t> first_point; // of each cell, and the end
};

struct LightTransport::Worker
{
    explicit Worker(const Setup& setup)
        : rays(setup.map, setup.patches, setup.pattern, setup.ground, setup.params.ground)
    {
    }
    BounceRays rays;
    MapPoints::ScratchPointer points;
    std::vector<Tile::Receiver> receivers;
    std::vector<uint32_t> met, numbers;
    Tile tile;
};

LightTransport::LightTransport() = default;
LightTransport::~LightTransport() = default;

// Trace the rays of a tile: what each met, one after the other.
void LightTransport::trace(int tile, Worker& worker) const
{
    const MapPoints& map = m_setup->map;
    const bool has_visibility = !m_setup->visibility.empty(), is_cosine = map.params().measure == "cosine";
    worker.rays.cells().clear();
    worker.receivers.clear();
    worker.met.clear();
    for (const MapPoint& point : map.of_tile(tile, worker.points)) {
        const size_t texel = map.texel(tile, point), before = worker.met.size();
        const double hidden = has_visibility ? std::min(1.0, 1 - double(m_setup->visibility[texel])) : 1;
        if (!(hidden > 0))
            continue;
        const BounceRays::Count count
            = worker.rays.trace(point.surface, texel, map.left(tile) + point.x, map.top(tile) + point.y, worker.met);
        const size_t met = worker.met.size() - before;
        if (met == 0)
            continue;
        // What is blocked is known better from the map.
        const double scale = has_visibility && is_cosine ? hidden / count.blocked : 1.0 / count.all;
        worker.receivers.push_back({ uint16_t(point.y * kTileSize + point.x), uint16_t(met), float(scale) });
    }
}

// Sort and count what trace() found.
void LightTransport::add(Tile& dst, Worker& worker) const
{
    const uint32_t patches = m_setup->patches.count();
    m_setup->cells.find(worker.rays.cells(), worker.numbers);
    dst.receivers = worker.receivers;
    dst.entries.clear();
    auto met = worker.met.begin();
    for (Tile::Receiver& receiver : dst.receivers) {
        const auto end = met + receiver.entries;
        for (auto number = met; number != end; ++number)
            if (*number & BounceRays::kCell)
                *number = patches + worker.numbers[*number & ~BounceRays::kCell];
        std::sort(met, end);
        const size_t before = dst.entries.size();
        for (; met != end; ++met) {
            if (dst.entries.size() > before && dst.entries.back() >> kCountBits == *met)
                ++dst.entries.back();
            else
                dst.entries.push_back(*met << kCountBits | 1);
        }
        receiver.entries = uint16_t(dst.entries.size() - before);
    }
}

bool LightTransport::prepare(BakeScenePointer scene, const VismapParams& map, OIIO::cspan<float> visibility,
                             const TransportParams& params, std::string& error, int nthreads, const Progress& progress,
                             NormalMapPointer normal_map)
{
    m_setup.reset();
    m_tiles.clear();
    m_points.clear();
    m_surfaces.clear();
    m_rays = 0;
    if (!check_params(map, error))
        return false;
    if (params.rays < 8 || params.rays > kMostRays) {
        error = format("{} rays; 8 to {} are allowed", params.rays, kMostRays);
        return false;
    }
    // Normals and patches of texels, their light, and what they get; then what is kept of rays, at most.
    const double texels = double(map.size().width) * map.size().height;
    double hidden = visibility.empty() ? texels : 0;
    for (const float v : visibility)
        hidden += std::max(0.0, 1 - double(v));
    const double needed = texels * (16 + 4 + 4 + 12 + 12),
                 kept = hidden * params.rays * 4 + texels * sizeof(Tile::Receiver);
    const auto available = double(available_memory());
    if (needed > available) {
        error = format("bounced light of {}x{} texels needs {} of memory, {} available", map.size().width,
                       map.size().height, OIIO::Strutil::memformat(int64_t(needed)),
                       OIIO::Strutil::memformat(int64_t(available)));
        return false;
    }
    m_is_kept = kept <= double(params.most_bytes) && needed + kept <= available;
    m_setup = std::make_unique<Setup>(std::move(scene), map, params, std::move(normal_map));
    Setup& setup = *m_setup;
    setup.visibility.assign(visibility.begin(), visibility.end());
    const auto halves = [&](double from) {
        return progress ? Progress([&progress, from](double done) { return progress(from + 0.5 * done); }) : Progress();
    };
    const auto stopped = [&] {
        m_setup.reset();
        m_tiles.clear();
        error = "interrupted";
        return false;
    };
    if (!setup.map.prepare(0, nthreads, halves(0),
                           [&](int tile, const std::vector<MapPoint>& points) { setup.patches.add(tile, points); }))
        return stopped();
    setup.patches.number();

    // Cells are numbered in the order of the tiles, whatever thread traces them.
    struct Traced
    {
        std::vector<Tile::Receiver> receivers;
        std::vector<uint32_t> met;
        LightCells cells;
    };
    std::vector<std::unique_ptr<Worker>> workers(size_t(worker_count(nthreads)));
    const auto worker_at = [&](int index) -> Worker& {
        auto& worker = workers[size_t(index)];
        if (!worker)
            worker = std::make_unique<Worker>(setup);
        return *worker;
    };
    std::vector<Traced> traced(size_t(setup.map.tiles()));
    const auto trace_tile = [&](int64_t tile, int index) {
        Worker& worker = worker_at(index);
        trace(int(tile), worker);
        Traced& own = traced[size_t(tile)];
        own.cells = worker.rays.cells();
        if (m_is_kept) {
            own.receivers = worker.receivers;
            own.met = worker.met;
        }
    };
    const bool done = parallel_items(setup.map.tiles(), nthreads, trace_tile, halves(0.5));
    for (const auto& worker : workers)
        m_rays += worker ? worker->rays.rays() : 0;
    work_counts().bounce_rays += m_rays;
    if (!done)
        return stopped();
    std::vector<uint32_t> ignored;
    for (const Traced& tile : traced)
        setup.cells.merge(tile.cells, ignored);
    if (setup.patches.count() + setup.cells.cells().size() >= kMostNumbers) {
        error = format("bounced light comes from {} parts of surfaces; {} are allowed: use a smaller map",
                       setup.patches.count() + setup.cells.cells().size(), kMostNumbers);
        m_setup.reset();
        return false;
    }
    number_points();
    if (!m_is_kept)
        return true;
    m_tiles.resize(traced.size());
    const auto add_tile = [&](int64_t tile, int index) {
        Worker& worker = worker_at(index);
        Traced& own = traced[size_t(tile)];
        worker.receivers = std::move(own.receivers);
        worker.met = std::move(own.met);
        worker.rays.cells() = std::move(own.cells);
        add(m_tiles[size_t(tile)], worker);
        m_tiles[size_t(tile)].entries.shrink_to_fit();
    };
    parallel_items(setup.map.tiles(), nthreads, add_tile);
    setup.visibility = {};
    return true;
}

void LightTransport::number_points()
{
    std::vector<uint32_t>& first = m_setup->first_point;
    for (const LightCells::Cell& cell : m_setup->cells.cells()) {
        first.push_back(uint32_t(m_points.size()));
        m_points.insert(m_points.end(), cell.points.begin(), cell.points.begin() + cell.count);
    }
    first.push_back(uint32_t(m_points.size()));
    for (const LightPoint& point : m_points)
        m_surfaces.push_back(point.surface);
}

bool LightTransport::gather(std::vector<float>& dst, OIIO::cspan<float> map, OIIO::cspan<float> points, int nthreads,
                            const Progress& progress) const
{
    const Setup& setup = *m_setup;
    const uint32_t patches = setup.patches.count();
    std::vector<V3f> light(patches + setup.cells.cells().size());
    setup.patches.average(light.data(), map.data(), nthreads);
    for (size_t cell = 0; cell + 1 < setup.first_point.size(); ++cell) {
        const uint32_t first = setup.first_point[cell], end = setup.first_point[cell + 1];
        V3f sum(0);
        for (uint32_t i = first; i < end; ++i)
            sum += V3f(points[3 * i], points[3 * i + 1], points[3 * i + 2]);
        light[patches + cell] = sum / float(end - first);
    }
    dst.assign(3 * size_t(setup.map.width()) * size_t(setup.map.height()), 0.0f);
    std::vector<std::unique_ptr<Worker>> workers(size_t(worker_count(nthreads)));
    const auto gather_tile = [&](int64_t tile, int index) {
        const Tile* kept = m_is_kept ? &m_tiles[size_t(tile)] : nullptr;
        if (!kept) {
            auto& worker = workers[size_t(index)];
            if (!worker)
                worker = std::make_unique<Worker>(setup);
            trace(int(tile), *worker);
            add(worker->tile, *worker);
            kept = &worker->tile;
        }
        const int left = setup.map.left(int(tile)), top = setup.map.top(int(tile));
        const uint32_t* entry = kept->entries.data();
        for (const Tile::Receiver& receiver : kept->receivers) {
            V3f sum(0);
            for (const uint32_t* end = entry + receiver.entries; entry != end; ++entry)
                sum += light[*entry >> kCountBits] * float(*entry & ((1u << kCountBits) - 1));
            const int x = left + receiver.texel % kTileSize, y = top + receiver.texel / kTileSize;
            float* rgb = &dst[3 * (size_t(y) * size_t(setup.map.width()) + size_t(x))];
            for (int c = 0; c < 3; ++c)
                rgb[c] = sum[c] * receiver.scale;
        }
    };
    const bool done = parallel_items(setup.map.tiles(), nthreads, gather_tile, progress);
    int64_t rays = 0;
    for (const auto& worker : workers)
        rays += worker ? worker->rays.rays() : 0;
    m_rays += rays;
    work_counts().bounce_rays += rays;
    ++work_counts().bounces_made;
    if (done)
        setup.map.margin().fill(dst.data(), 3);
    return done;
}

size_t LightTransport::bytes() const
{
    if (!m_setup)
        return 0;
    size_t bytes = m_setup->map.bytes() + m_setup->patches.bytes() + m_setup->cells.bytes()
        + m_points.capacity() * (sizeof(LightPoint) + sizeof(SurfacePoint))
        + m_setup->visibility.capacity() * sizeof(float);
    for (const Tile& tile : m_tiles)
        bytes += tile.receivers.capacity() * sizeof(Tile::Receiver) + tile.entries.capacity() * sizeof(uint32_t);
    return bytes;
}

} // namespace vmlight
