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
#include <map>
#include <mutex>

namespace vmlight {

using Imath::V3f;

namespace {

// Of an entry: the number of what is met, and how often.
constexpr int kCountBits = 8;
constexpr uint32_t kMostNumbers = 1u << (32 - kCountBits), kMostCount = (1u << kCountBits) - 1;
static_assert(TransportParams::kRays.max <= kMostCount);
// Of the bake, traced again for a texel: more would find nothing that matters.
constexpr int kMostBakeRays = 4096;

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

    size_t bytes() const { return receivers.capacity() * sizeof(Receiver) + entries.capacity() * sizeof(uint32_t); }
};

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

// What the rays of a tile met, one after the other: patches, and cells by their numbers in `cells`.
struct LightTransport::Traced
{
    std::vector<Tile::Receiver> receivers;
    std::vector<uint32_t> met;
    LightCells cells;

    size_t bytes() const
    {
        return receivers.capacity() * sizeof(Tile::Receiver) + met.capacity() * sizeof(uint32_t) + cells.bytes();
    }
};

struct LightTransport::Worker
{
    explicit Worker(const Setup& setup)
        : rays(setup.map, setup.patches, setup.pattern, setup.bake_pattern, setup.ground, setup.params.ground)
    {
    }
    BounceRays rays;
    MapPoints::ScratchPointer points;
    Traced traced;
    std::vector<uint32_t> numbers;
    Tile tile;
};

// Numbers the cells of tiles in the order of the tiles, whichever is traced first.
class LightTransport::CellOrder
{
public:
    explicit CellOrder(LightCells& cells)
        : m_cells(cells)
    {
    }

    struct Numbered
    {
        int64_t tile;
        Traced traced;
        std::vector<uint32_t> numbers; // of its cells
    };
    // Take a tile; returns those whose cells can be numbered now.
    std::vector<Numbered> add(int64_t tile, Traced traced)
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        m_waiting_bytes += traced.bytes();
        m_waiting.emplace(tile, std::move(traced));
        std::vector<Numbered> ready;
        for (auto first = m_waiting.begin(); first != m_waiting.end() && first->first == m_next; ++m_next) {
            Numbered& own = ready.emplace_back(Numbered { m_next, std::move(first->second), {} });
            m_waiting_bytes -= own.traced.bytes();
            m_cells.merge(own.traced.cells, own.numbers);
            own.traced.cells = {};
            first = m_waiting.erase(first);
        }
        // The points are copied in the end.
        m_bytes = m_waiting_bytes + m_cells.bytes() + m_cells.count() * (sizeof(LightPoint) + sizeof(SurfacePoint));
        m_count = m_cells.count();
        return ready;
    }
    size_t bytes() const { return m_bytes; }
    size_t count() const { return m_count; }

private:
    std::mutex m_mutex;
    LightCells& m_cells;
    std::map<int64_t, Traced> m_waiting;
    int64_t m_next = 0;
    size_t m_waiting_bytes = 0;
    std::atomic<size_t> m_bytes { 0 }, m_count { 0 };
};

LightTransport::LightTransport() = default;
LightTransport::~LightTransport() = default;

void LightTransport::trace(int tile, Worker& worker) const
{
    const MapPoints& map = m_setup->map;
    const bool has_visibility = !m_setup->visibility.empty(), is_cosine = map.params().measure == "cosine";
    Traced& traced = worker.traced;
    worker.rays.cells().clear();
    traced.receivers.clear();
    traced.met.clear();
    for (const MapPoint& point : map.of_tile(tile, worker.points)) {
        const size_t texel = map.texel(tile, point), before = traced.met.size();
        const double hidden = has_visibility ? std::min(1.0, 1 - double(m_setup->visibility[texel])) : 1;
        if (!(hidden > 0))
            continue;
        const auto cast = [&](BounceRays::Rays which) {
            return worker.rays.trace(point.surface, texel, map.left(tile) + point.x, map.top(tile) + point.y,
                                     traced.met, which);
        };
        // What is blocked is known better from the map. What these rays miss, those of the bake have met; without
        // them, small things would send too little: of hidden x mean of what hits bring, the times without a hit.
        const bool is_known = has_visibility && is_cosine;
        BounceRays::Count count = cast(BounceRays::Rays::own);
        if (is_known && count.blocked == 0)
            count = cast(BounceRays::Rays::of_bake);
        const size_t met = traced.met.size() - before;
        if (met == 0)
            continue;
        const double scale = is_known ? hidden / count.blocked : 1.0 / count.all;
        traced.receivers.push_back({ uint16_t(point.y * kTileSize + point.x), uint16_t(met), float(scale) });
    }
}

// Sort and count what trace() found; `numbers` are those of its cells among all.
void LightTransport::count(Tile& dst, Traced& traced, const std::vector<uint32_t>& numbers) const
{
    const uint32_t patches = m_setup->patches.count();
    dst.receivers = traced.receivers;
    dst.entries.clear();
    auto met = traced.met.begin();
    for (Tile::Receiver& receiver : dst.receivers) {
        const auto end = met + receiver.entries;
        for (auto number = met; number != end; ++number)
            if (*number & BounceRays::kCell)
                *number = patches + numbers[*number & ~BounceRays::kCell];
        std::sort(met, end);
        const size_t before = dst.entries.size();
        for (; met != end; ++met) {
            uint32_t* last = dst.entries.size() > before ? &dst.entries.back() : nullptr;
            if (last && *last >> kCountBits == *met && (*last & kMostCount) < kMostCount)
                ++*last;
            else
                dst.entries.push_back(*met << kCountBits | 1);
        }
        receiver.entries = uint16_t(dst.entries.size() - before);
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
        Traced own;
        own.cells = worker->rays.cells();
        if (m_is_kept) {
            own.receivers = worker->traced.receivers;
            own.met = worker->traced.met;
        }
        for (CellOrder::Numbered& ready : order.add(tile, std::move(own))) {
            if (!m_is_kept)
                continue;
            Tile& dst = m_tiles[size_t(ready.tile)];
            count(dst, ready.traced, ready.numbers);
            dst.entries.shrink_to_fit();
            kept += dst.bytes();
        }
    };
    const auto used = [&] { return double(order.bytes()) + double(kept); };
    const auto is_too_much = [&] { return used() > memory || setup.patches.count() + order.count() >= kMostNumbers; };
    const bool done = parallel_items(setup.map.tiles(), nthreads, trace_tile,
                                     [&](double part) { return !is_too_much() && (!progress || progress(part)); });
    for (const auto& worker : workers)
        m_rays += worker ? worker->rays.rays() : 0;
    work_counts().bounce_rays += m_rays;
    if (setup.patches.count() + order.count() >= kMostNumbers)
        error = format("bounced light comes from {} parts of surfaces; {} are allowed: use a smaller map",
                       setup.patches.count() + order.count(), kMostNumbers);
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
    const double kept = hidden * params.rays * sizeof(uint32_t) + double(texels) * sizeof(Tile::Receiver);
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
        const Tile* kept = m_is_kept ? &m_tiles[size_t(tile)] : nullptr;
        if (!kept) {
            auto& worker = workers[size_t(index)];
            if (!worker)
                worker = std::make_unique<Worker>(setup);
            trace(int(tile), *worker);
            setup.cells.find(worker->rays.cells(), worker->numbers);
            count(worker->tile, worker->traced, worker->numbers);
            kept = &worker->tile;
        }
        const int left = setup.map.left(int(tile)), top = setup.map.top(int(tile));
        const uint32_t* entry = kept->entries.data();
        for (const Tile::Receiver& receiver : kept->receivers) {
            V3f sum(0);
            for (const uint32_t* end = entry + receiver.entries; entry != end; ++entry)
                sum += light[*entry >> kCountBits] * float(*entry & kMostCount);
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
        + m_points.capacity() * sizeof(LightPoint) + m_surfaces.capacity() * sizeof(SurfacePoint)
        + m_setup->first_point.capacity() * sizeof(uint32_t) + m_setup->visibility.capacity() * sizeof(float);
    for (const Tile& tile : m_tiles)
        bytes += tile.bytes();
    return bytes;
}

} // namespace vmlight
