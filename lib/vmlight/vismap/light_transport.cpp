// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/light_transport.h>

#include <vmlight/base/available_memory.h>
#include <vmlight/base/format.h>
#include <vmlight/base/parallel.h>
#include <vmlight/base/work_counts.h>
#include <vmlight/vismap/bounce_rays.h>
#include <vmlight/vismap/ground_of.h>
#include <vmlight/vismap/map_patches.h>
#include <vmlight/vismap/transport_tile.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>

namespace vmlight {

using Imath::V3f;

namespace {

static_assert(TransportParams::kRays.max <= TransportTile::kMostCount);
// Of the bake, traced again for a texel: more would find nothing that matters.
constexpr int kMostBakeRays = 4096;
// Of rays for a texel, until one meets something.
constexpr int kMostRounds = 16;

} // namespace

struct LightTransport::Setup
{
    Setup(BakeScenePointer scene, const VismapParams& the_map, const TransportParams& the_params,
          NormalMapPointer normal_map)
        : map(std::move(scene), the_map, std::move(normal_map))
        , patches(map)
        , params(the_params)
        , pattern("fibonacci", params.rays, false)
        , bake_pattern(the_map.sampler, std::min(the_map.samples, kMostBakeRays), false)
        , ground(ground_of(map.scene(), the_map))
    {
    }
    MapPoints map;
    MapPatches patches;
    const TransportParams params;
    const SamplePattern pattern, bake_pattern;
    const GroundPlane ground;
    std::vector<float> visibility; // V of the texels; empty: unknown
    LightCells cells;
    std::vector<uint32_t> first_point; // of each cell, and the end
};

struct LightTransport::Worker
{
    explicit Worker(const Setup& setup)
        : rays(setup.map, setup.patches, setup.pattern, setup.bake_pattern, setup.ground, setup.params.ground)
    {
    }
    BounceRays rays;
    MapPoints::ScratchPointer points;
    TracedTile traced;
    std::vector<uint32_t> numbers;
    TransportTile tile;
};

LightTransport::LightTransport() = default;
LightTransport::~LightTransport() = default;

void LightTransport::trace(int tile, Worker& worker) const
{
    const MapPoints& map = m_setup->map;
    const bool has_visibility = !m_setup->visibility.empty(), is_cosine = map.params().measure == "cosine";
    TracedTile& traced = worker.traced;
    worker.rays.cells().clear();
    traced.receivers.clear();
    traced.met.clear();
    for (const MapPoint& point : map.of_tile(tile, worker.points)) {
        const size_t texel = map.texel(tile, point), before = traced.met.size();
        const double hidden = has_visibility ? std::min(1.0, 1 - double(m_setup->visibility[texel])) : 1;
        if (!(hidden > 0))
            continue;
        const auto cast = [&](int round) {
            return worker.rays.trace(point.surface, texel, map.left(tile) + point.x, map.top(tile) + point.y,
                                     traced.met, round);
        };
        // What is blocked is known better from the map. What these rays miss, those of the bake have met, or in a map
        // that is reconstructed those of neighbours: then more rays are traced. Without a hit, small things would
        // send too little: of hidden x mean of what hits bring, the times without one.
        const bool is_known = has_visibility && is_cosine;
        BounceRays::Count count = cast(BounceRays::kOwnRays);
        for (int round = BounceRays::kRaysOfBake; is_known && count.blocked == 0 && round <= kMostRounds; ++round)
            count = cast(round);
        const size_t met = traced.met.size() - before;
        if (met == 0)
            continue;
        const double scale = is_known ? hidden / count.blocked : 1.0 / count.all;
        traced.receivers.push_back({ uint16_t(point.y * kTileSize + point.x), uint16_t(met), float(scale) });
    }
}

bool LightTransport::trace_all(double memory, std::string& error, int nthreads, const Progress& progress)
{
    Setup& setup = *m_setup;
    CellOrder order(setup.cells);
    std::vector<std::unique_ptr<Worker>> workers(size_t(worker_count(nthreads)));
    m_tiles.resize(m_is_kept ? size_t(setup.map.tiles()) : 0);
    std::atomic<size_t> kept { 0 };
    const auto trace_tile = [&](int64_t tile, int index) {
        auto& worker = workers[size_t(index)];
        if (!worker)
            worker = std::make_unique<Worker>(setup);
        trace(int(tile), *worker);
        TracedTile own;
        own.cells = worker->rays.cells();
        if (m_is_kept) {
            own.receivers = worker->traced.receivers;
            own.met = worker->traced.met;
        }
        for (CellOrder::Numbered& ready : order.add(tile, std::move(own))) {
            if (!m_is_kept)
                continue;
            TransportTile& dst = m_tiles[size_t(ready.tile)];
            ready.traced.count(dst, ready.numbers, setup.patches.count());
            dst.entries.shrink_to_fit();
            kept += dst.bytes();
        }
    };
    const auto used = [&] { return double(order.bytes()) + double(kept); };
    const auto is_too_much
        = [&] { return used() > memory || setup.patches.count() + order.count() >= TransportTile::kMostNumbers; };
    const bool done = parallel_items(setup.map.tiles(), nthreads, trace_tile,
                                     [&](double part) { return !is_too_much() && (!progress || progress(part)); });
    for (const auto& worker : workers)
        m_rays += worker ? worker->rays.rays() : 0;
    work_counts().bounce_rays += m_rays;
    if (setup.patches.count() + order.count() >= TransportTile::kMostNumbers)
        error = format("bounced light comes from {} parts of surfaces; {} are allowed: use a smaller map",
                       setup.patches.count() + order.count(), TransportTile::kMostNumbers);
    else if (used() > memory)
        error = format("bounced light of {}x{} texels needs more than {} of memory, {} available; use a smaller map, "
                       "or fewer bounce_rays",
                       setup.map.width(), setup.map.height(), OIIO::Strutil::memformat(int64_t(used())),
                       OIIO::Strutil::memformat(int64_t(memory)));
    else if (!done)
        error = "interrupted";
    return error.empty();
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
    error.clear();
    if (!check_params(map, error) || !check_params(params, error))
        return false;
    const size_t texels = size_t(map.size().width) * size_t(map.size().height);
    if (!visibility.empty() && size_t(visibility.size()) != texels) {
        error = format("{} values of visibility for {}x{} texels", visibility.size(), map.size().width,
                       map.size().height);
        return false;
    }
    if (const CasterReach* culled = scene->culled_occluder()) {
        error = format("\"{}\" is not in the scene, and may shade what sends light; build it without culling",
                       culled->name);
        return false;
    }
    if (scene->occluder().has_instances()) {
        error
            = "an occluder has instances, whose light is not traced: list their meshes one by one with --occluder, or "
              "light without a bounce";
        return false;
    }
    // Normals and patches of texels, their light, and what they get; then what is kept of rays, at most.
    const double needed = double(texels) * (16 + 4 + 4 + 12 + 12);
    const double available = std::min(double(available_memory()), double(params.memory));
    if (needed > available) {
        error = format("bounced light of {}x{} texels needs {} of memory, {} available", map.size().width,
                       map.size().height, OIIO::Strutil::memformat(int64_t(needed)),
                       OIIO::Strutil::memformat(int64_t(available)));
        return false;
    }
    m_setup = std::make_unique<Setup>(std::move(scene), map, params, std::move(normal_map));
    Setup& setup = *m_setup;
    setup.visibility.assign(visibility.begin(), visibility.end());
    const auto halves = [&](double from) {
        return progress ? Progress([&progress, from](double done) { return progress(from + 0.5 * done); }) : Progress();
    };
    const auto failed = [&] {
        m_setup.reset();
        m_tiles.clear();
        error = error.empty() ? "interrupted" : error;
        return false;
    };
    if (!setup.map.prepare(0, nthreads, halves(0),
                           [&](int tile, const std::vector<MapPoint>& points) { setup.patches.add(tile, points); }))
        return failed();
    setup.patches.number();
    double hidden = 0;
    for (size_t i = 0; i < texels; ++i)
        if (is_covered(i))
            hidden += visibility.empty() ? 1 : std::max(0.0, 1 - double(setup.visibility[i]));
    const double kept = hidden * params.rays * sizeof(uint32_t) + double(texels) * sizeof(TransportTile::Receiver);
    m_is_kept = kept <= double(params.most_bytes) && needed + kept <= available;
    if (!trace_all(available - needed, error, nthreads, halves(0.5)))
        return failed();
    setup.cells.take_points(m_points, m_surfaces, setup.first_point);
    if (m_is_kept) {
        setup.cells = {};
        setup.visibility = {};
    }
    return true;
}

bool LightTransport::is_covered(size_t texel) const
{
    return m_setup->patches.of_texel(texel) != MapPatches::kNone;
}

bool LightTransport::gather(std::vector<float>& dst, OIIO::cspan<float> map, OIIO::cspan<float> points, int nthreads,
                            const Progress& progress) const
{
    dst.clear();
    if (!m_setup || 3 * m_points.size() != size_t(points.size())
        || 3 * size_t(m_setup->map.width()) * size_t(m_setup->map.height()) != size_t(map.size()))
        return false;
    const Setup& setup = *m_setup;
    const uint32_t patches = setup.patches.count();
    std::vector<V3f> light(patches + setup.first_point.size() - 1);
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
        const TransportTile* kept = m_is_kept ? &m_tiles[size_t(tile)] : nullptr;
        if (!kept) {
            auto& worker = workers[size_t(index)];
            if (!worker)
                worker = std::make_unique<Worker>(setup);
            trace(int(tile), *worker);
            setup.cells.find(worker->rays.cells(), worker->numbers);
            worker->traced.count(worker->tile, worker->numbers, setup.patches.count());
            kept = &worker->tile;
        }
        const int left = setup.map.left(int(tile)), top = setup.map.top(int(tile));
        const uint32_t* entry = kept->entries.data();
        for (const TransportTile::Receiver& receiver : kept->receivers) {
            V3f sum(0);
            for (const uint32_t* end = entry + receiver.entries; entry != end; ++entry)
                sum += light[TransportTile::number_of(*entry)] * float(TransportTile::count_of(*entry));
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
        setup.map.margin().fill(dst.data(), 3, nthreads);
    return done;
}

size_t LightTransport::bytes() const
{
    if (!m_setup)
        return 0;
    size_t bytes = m_setup->map.bytes() + m_setup->patches.bytes() + m_setup->cells.bytes()
        + m_points.capacity() * sizeof(LightPoint) + m_surfaces.capacity() * sizeof(SurfacePoint)
        + m_setup->first_point.capacity() * sizeof(uint32_t) + m_setup->visibility.capacity() * sizeof(float);
    for (const TransportTile& tile : m_tiles)
        bytes += tile.bytes();
    return bytes;
}

} // namespace vmlight
