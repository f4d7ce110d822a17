// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/baker.h>

#include <vmlight/base/format.h>
#include <vmlight/base/parallel.h>
#include <vmlight/math/sampling.h>
#include <vmlight/trace/surface.h>
#include <vmlight/uv/islands.h>
#include <vmlight/uv/tile_progress.h>
#include <vmlight/vismap/ground_of.h>
#include <vmlight/vismap/sun_visibility.h>
#include <vmlight/vismap/visibility_integrator.h>

#include <algorithm>
#include <array>

namespace vmlight {
namespace {

int width_of(const VismapParams& params)
{
    return params.size().width;
}

int height_of(const VismapParams& params)
{
    return params.size().height;
}

// Rays that a map may take: for a target error or a time budget their number is not known yet.
double most_rays(const VismapParams& params)
{
    return double(width_of(params)) * height_of(params) * params.samples;
}

} // namespace

void BakeCounts::add(const BakeCounts& other)
{
    covered += other.covered;
    overlapping += other.overlapping;
    dark += other.dark;
    rays += other.rays;
    open += other.open;
    tiles += other.tiles;
}

struct VismapBaker::Setup
{
    Setup(BakeScenePointer the_scene, UvRaster&& the_raster, OpenTriangles&& the_open, const VismapParams& the_params,
          const SampleCount& the_error, NormalMapPointer the_normal_map, const std::vector<Disc>& the_suns)
        : scene(std::move(the_scene))
        , normal_map(std::move(the_normal_map))
        , raster(std::move(the_raster))
        , open(std::move(the_open))
        , params(the_params)
        , error(the_error)
        , has_normal(params.has("normal"))
        , has_error(params.has("error"))
        , has_coverage(params.has("coverage"))
        , basis_count(int(basis_channels(params).size()))
        , suns(the_suns)
        , sun_samples(suns.begin(), suns.end())
        , ground(ground_of(*scene, params))
        , pattern(params.sampler, params.samples, params.measure == "uniform")
    {
    }
    const BakeScenePointer scene;
    const NormalMapPointer normal_map;
    const UvRaster raster;
    const OpenTriangles open;
    const VismapParams params;
    const SampleCount error;
    const bool has_normal, has_error, has_coverage;
    const int basis_count;
    const std::vector<Disc> suns;
    const std::vector<DiscSamples> sun_samples;
    const GroundPlane ground;
    const SamplePattern pattern;
};

class VismapBaker::Scratch
{
public:
    explicit Scratch(const Setup& setup)
        : integrator(setup.scene->occluder(), setup.pattern, setup.params, setup.scene->frame().scale, setup.ground)
        , surface(setup.scene->mesh(), setup.scene->frame())
    {
    }
    TileCover cover;
    VisibilityIntegrator integrator;
    Surface surface;
};

VismapBaker::VismapBaker() = default;
VismapBaker::~VismapBaker() = default;

void VismapBaker::FreeScratch::operator()(Scratch* scratch) const
{
    delete scratch;
}

bool VismapBaker::prepare(BakeScenePointer scene, const VismapParams& params, std::string& error, int nthreads,
                          const Progress& progress, double time_budget, NormalMapPointer normal_map)
{
    if (!check_params(params, error))
        return false;
    if (find_basis(params.basis).accumulator && params.measure != "cosine") {
        error = "basis: " + params.basis + " needs the measure cosine, not " + params.measure;
        return false;
    }
    std::vector<Disc> suns;
    if (!parse_sun_directions(suns, params.sun_directions, error))
        return false;
    if (params.max_distance > scene->choice().reach) {
        error = format("max_distance: {:.6g} is more than the {:.6g} that the scene was built for", params.max_distance,
                       scene->choice().reach);
        return false;
    }
    UvRaster raster(scene->mesh(), width_of(params), height_of(params), params.udim);
    OpenTriangles open;
    if (params.skip_open)
        open.find(*scene, params.max_distance * scene->frame().scale, most_rays(params));
    SampleCount chosen;
    if (!choose_samples(chosen, *scene, normal_map.get(), raster, open, params, time_budget, nthreads, progress, error))
        return false;
    VismapParams settled = params;
    settled.samples = chosen.samples;
    m_setup = std::make_unique<Setup>(std::move(scene), std::move(raster), std::move(open), settled, chosen,
                                      std::move(normal_map), suns);
    return true;
}

bool VismapBaker::prepare(const Mesh& mesh, const std::vector<Mesh>& occluders, const VismapParams& params,
                          int nthreads, std::string& error)
{
    auto scene = std::make_shared<BakeScene>();
    return check_params(params, error)
        && scene->build(non_owning(mesh), occluders, nthreads, error, SceneChoice::within(params.max_distance))
        && prepare(std::move(scene), params, error, nthreads);
}

int VismapBaker::width() const
{
    return width_of(m_setup->params);
}

int VismapBaker::height() const
{
    return height_of(m_setup->params);
}

int VismapBaker::channels() const
{
    return before_basis() + m_setup->basis_count + (m_setup->has_coverage ? 1 : 0);
}

int VismapBaker::before_basis() const
{
    return 4 + (m_setup->has_normal ? 3 : 0) + (m_setup->has_error ? 1 : 0) + int(m_setup->suns.size());
}

MarginChannels VismapBaker::margin_channels() const
{
    return find_basis(m_setup->params.basis).whole_numbers
        ? MarginChannels { before_basis(), m_setup->basis_count }
        : MarginChannels { before_basis() + m_setup->basis_count, 0 };
}

int VismapBaker::tiles_across() const
{
    return m_setup->raster.tiles_across();
}

int VismapBaker::tiles_down() const
{
    return m_setup->raster.tiles_down();
}

const UvReport& VismapBaker::uv_report() const
{
    return m_setup->raster.report();
}

void VismapBaker::count_islands(UvReport& report) const
{
    vmlight::count_islands(report, m_setup->scene->mesh(), m_setup->raster);
}

const VismapParams& VismapBaker::params() const
{
    return m_setup->params;
}

const SampleCount& VismapBaker::error() const
{
    return m_setup->error;
}

const OpenTriangles& VismapBaker::open() const
{
    return m_setup->open;
}

VismapBaker::ScratchPointer VismapBaker::scratch() const
{
    return ScratchPointer(new Scratch(*m_setup));
}

void VismapBaker::cover_tile(int tile, Scratch& scratch, TileBits& covered) const
{
    m_setup->raster.cover(tile, scratch.cover);
    covered.fill(0);
    for (int i = 0; i < kTileSize * kTileSize && scratch.cover.covered; ++i)
        covered[size_t(i / kTileSize)] |= uint64_t(scratch.cover.triangle[size_t(i)] != TileCover::kNone)
            << i % kTileSize;
}

BakeCounts VismapBaker::bake_tile(int tile, Scratch& scratch, float* texels, size_t pitch, TileBits& covered) const
{
    const TileCover& cover = scratch.cover;
    cover_tile(tile, scratch, covered);
    BakeCounts counts;
    counts.covered = cover.covered;
    counts.overlapping = cover.overlapping;
    counts.tiles = cover.covered > 0;
    if (!cover.covered)
        return counts;
    const int tile_x = tile % tiles_across() * kTileSize, tile_y = tile / tiles_across() * kTileSize;
    const int channel_count = channels(), basis_at = before_basis(), suns_at = basis_at - int(m_setup->suns.size());
    std::vector<DiscTracer> suns;
    for (size_t k = 0; k < m_setup->suns.size(); ++k)
        suns.emplace_back(m_setup->scene->occluder(), m_setup->suns[k], m_setup->sun_samples[k],
                          disc_rays(m_setup->suns[k].half_angle),
                          float(m_setup->params.max_distance * m_setup->scene->frame().scale), m_setup->params.seed,
                          m_setup->ground);
    const int64_t rays_before = scratch.integrator.rays();
    // Texels in blocks of 8 x 8: rays of neighbours visit the same part of the scene (measured: 1.2 times).
    for (int i = 0; i < kTileSize * kTileSize / 8; ++i) {
        const int block = i / 8, left = block % 8 * 8, y = block / 8 * 8 + i % 8;
        std::array<SurfacePoint, kPacketSize> points;
        std::array<int, kPacketSize> columns;
        std::array<bool, kPacketSize> open;
        int count = 0, traced = 0;
        for (int x = left; x < left + 8; ++x) {
            const size_t texel = size_t(y) * kTileSize + x;
            if (cover.triangle[texel] == TileCover::kNone)
                continue;
            SurfacePoint& point = points[size_t(count)];
            point = scratch.surface.at(cover.triangle[texel], cover.weight1[texel], cover.weight2[texel]);
            if (m_setup->normal_map)
                m_setup->normal_map->apply(point, cover.triangle[texel], cover.weight1[texel], cover.weight2[texel],
                                           tile_x + x, tile_y + y);
            open[size_t(count)] = m_setup->open.is_open(cover.triangle[texel]);
            traced += !open[size_t(count)];
            columns[size_t(count++)] = x;
        }
        if (traced > 0)
            adjust_ray_origins(points.data(), count, m_setup->scene->occluder());
        counts.open += count - traced;
        for (int k = 0; k < count; ++k) {
            const int x = columns[size_t(k)];
            float* out = texels + size_t(y) * pitch + size_t(x) * channel_count;
            const Visibility seen = scratch.integrator.integrate(points[size_t(k)], tile_x + x, tile_y + y,
                                                                 open[size_t(k)], out + basis_at);
            counts.dark += seen.visibility < 0.01;
            out[0] = float(seen.visibility);
            for (int c = 0; c < 3; ++c)
                out[1 + c] = float(seen.direction[c]);
            for (int c = 0; c < 3 && m_setup->has_normal; ++c)
                out[4 + c] = points[size_t(k)].normal[c];
            if (m_setup->has_error)
                out[suns_at - 1] = float(seen.error * m_setup->error.lane_scale);
            if (m_setup->has_coverage)
                out[channel_count - 1] = 1;
            for (size_t sun = 0; sun < suns.size(); ++sun)
                suns[sun].add(points[size_t(k)], tile_x + x, tile_y + y, out + suns_at + sun);
        }
    }
    counts.rays = scratch.integrator.rays() - rays_before;
    for (DiscTracer& sun : suns) {
        sun.flush();
        counts.rays += sun.rays();
    }
    return counts;
}

bool VismapBaker::bake_all(float* texels, Coverage& covered, BakeCounts& counts, int nthreads,
                           const Progress& progress) const
{
    struct Worker
    {
        ScratchPointer scratch;
        BakeCounts counts;
    };
    std::vector<Worker> workers(static_cast<size_t>(worker_count(nthreads)));
    for (Worker& worker : workers)
        worker.scratch = scratch();
    const size_t pitch = size_t(width()) * channels();
    TileProgress done(m_setup->raster, nthreads, progress);
    if (done.stopped())
        return false;
    const auto bake = [&](int64_t tile, int index) {
        Worker& worker = workers[size_t(index)];
        const int x = int(tile % tiles_across()) * kTileSize, y = int(tile / tiles_across()) * kTileSize;
        TileBits bits;
        float* first = texels + size_t(y) * pitch + size_t(x) * channels();
        const BakeCounts baked = bake_tile(int(tile), *worker.scratch, first, pitch, bits);
        done.add(baked.covered);
        worker.counts.add(baked);
        for (int row = 0; row < std::min(kTileSize, height() - y); ++row)
            covered.set_word(x, y + row, bits[size_t(row)]);
    };
    if (!parallel_items(int64_t(tiles_across()) * tiles_down(), nthreads, bake, done.listener()))
        return false;
    for (const Worker& worker : workers)
        counts.add(worker.counts);
    return true;
}

} // namespace vmlight
