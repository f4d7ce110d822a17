// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/pose_sequence.h>

#include <vmlight/base/fail_with.h>
#include <vmlight/base/format.h>
#include <vmlight/base/parallel.h>
#include <vmlight/mesh/same_triangles.h>
#include <vmlight/trace/moved_boxes.h>
#include <vmlight/uv/tile_progress.h>
#include <vmlight/vismap/bake_hints.h>
#include <vmlight/vismap/pose_proof.h>
#include <vmlight/vismap/texel_spacing.h>
#include <vmlight/vismap/turned_texels.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace vmlight {
namespace {

// Of the texels that trace rays, those of which nothing is known. A pose that has more is baked whole: those after it
// are more like it than like the base.
constexpr double kMostUnknown = 0.5;
// Bytes of the rays of a base that are kept.
constexpr double kMostKnown = 1 << 29;

// Triangles without area cover no texel. Which have one must not change: others would own their texels.
std::string area_fault(const Mesh& base, const Mesh& pose)
{
    for (size_t t = 0; t < base.triangles.size(); ++t)
        if ((triangle_area_normal(base, base.triangles[t]).length() > 0)
            != (triangle_area_normal(pose, pose.triangles[t]).length() > 0))
            return format("triangle {} has an area in one pose only", t);
    return "";
}

// What a base was traced to be, row by row.
struct BaseTexels
{
    const float* pixels;
    const TexelContexts& contexts;
    const std::vector<double>& errors;
};

// Puts a pose's texels together: those that are kept from the base, and those that are traced.
class Texels
{
public:
    Texels(const BaseTexels& base, const PosePair& poses, const PosePlan& plan)
        : m_base(base)
        , m_scene(*poses.pose.scene)
        , m_motion(poses.motion)
        , m_baker(poses.baker)
        , m_hints(*poses.hints)
        , m_plan(plan)
        , m_error_at(4 + (m_baker.params().has("normal") ? 3 : 0))
    {
        for (const RigidMotion& body : m_motion.motions())
            m_turns.emplace_back(m_baker.params(), body.turn);
    }

    struct Worker
    {
        VismapBaker::ScratchPointer scratch;
        std::unique_ptr<TileCover> cover = std::make_unique<TileCover>();
        std::unique_ptr<Surface> surface;
        BakeCounts counts;
    };

    void bake_tile(int tile, BakedTexels& map, Worker& worker) const
    {
        const int x = tile % m_baker.tiles_across() * kTileSize, y = tile / m_baker.tiles_across() * kTileSize;
        const auto channels = size_t(m_baker.channels());
        const size_t pitch = size_t(m_baker.width()) * channels, first = size_t(y) * pitch + size_t(x) * channels;
        const TileBits& kept = m_plan.kept(tile);
        TileBits others, covered;
        for (size_t row = 0; row < others.size(); ++row)
            others[row] = ~kept[row];
        BakeHints hints = m_hints;
        hints.only = &others;
        hints.contexts = map.contexts.texels.empty() ? nullptr : &map.contexts;
        worker.counts.add(m_baker.bake_tile(tile, *worker.scratch, map.pixels + first, pitch, covered, &hints));
        for (int row = 0; row < std::min(kTileSize, m_baker.height() - y); ++row)
            map.coverage.set_word(x, y + row, covered[size_t(row)]);
        if (std::all_of(kept.begin(), kept.end(), [](uint64_t bits) { return bits == 0; }))
            return;
        m_baker.raster().cover(tile, *worker.cover);
        TexelSpacing spacing(m_scene.mesh(), m_scene.frame(), m_baker.width(), m_baker.height());
        for (size_t i = 0; i < worker.cover->triangle.size(); ++i)
            if (kept[i / kTileSize] >> i % kTileSize & 1) {
                const uint32_t triangle = worker.cover->triangle[i];
                const size_t at = first + i / kTileSize * pitch + i % kTileSize * channels;
                const int column = x + int(i % kTileSize), row = y + int(i / kTileSize);
                copy(triangle, m_base.pixels + at, map.pixels + at);
                worker.counts.dark += map.pixels[at] < 0.01f;
                if (!m_base.errors.empty()) // each map scales it by what it measures
                    map.pixels[at + m_error_at]
                        = float(m_base.errors[size_t(row) * size_t(m_baker.width()) + size_t(column)]
                                * m_baker.error().scatter_scale);
                if (!hints.contexts)
                    continue;
                const SurfacePoint point
                    = worker.surface->at(triangle, worker.cover->weight1[i], worker.cover->weight2[i]);
                map.contexts.at(column, row)
                    = { point.near_origin, point.normal, spacing.of(triangle), m_base.contexts.at(column, row).variance,
                        m_baker.seams().island(triangle) };
            }
    }

private:
    void copy(uint32_t triangle, const float* from, float* to) const
    {
        const uint32_t body = m_motion.body(triangle);
        if (body != PoseMotion::kSoft)
            m_turns[body].copy(from, to);
        else
            TexelTurn(m_baker.params(), m_motion.turn(triangle)).copy(from, to);
    }

    const BaseTexels& m_base;
    const BakeScene& m_scene;
    const PoseMotion& m_motion;
    const VismapBaker& m_baker;
    const BakeHints& m_hints;
    const PosePlan& m_plan;
    const size_t m_error_at; // channel
    std::vector<TexelTurn> m_turns; // of the bodies
};

// False if stopped.
bool bake_changed(const BaseTexels& base, const PosePair& poses, const PosePlan& plan, const MapJob& job,
                  BakedTexels& map)
{
    const VismapBaker& baker = poses.baker;
    const Texels texels(base, poses, plan);
    std::vector<Texels::Worker> workers(static_cast<size_t>(worker_count(job.nthreads)));
    for (Texels::Worker& worker : workers) {
        worker.scratch = baker.scratch();
        worker.surface = std::make_unique<Surface>(poses.pose.scene->mesh(), poses.pose.scene->frame());
    }
    TileProgress done(baker.raster(), job.nthreads, job.progress);
    const auto work = [&](int64_t tile, int index) {
        Texels::Worker& worker = workers[size_t(index)];
        const int64_t covered = worker.counts.covered;
        texels.bake_tile(int(tile), map, worker);
        done.add(worker.counts.covered - covered);
    };
    if (done.stopped()
        || !parallel_items(int64_t(baker.tiles_across()) * baker.tiles_down(), job.nthreads, work, done.listener()))
        return false;
    for (const Texels::Worker& worker : workers)
        map.counts.add(worker.counts);
    return true;
}

PosePlan::MayKeep may_keep(const PosePair& poses)
{
    const TexelTurn::Kind kind = TexelTurn::kind(poses.baker.params());
    // Its normals do not turn with the surface.
    const bool in_object_space = poses.pose.normal_map && poses.pose.normal_map->is_object_space();
    return [=](uint32_t triangle) {
        if (poses.baker.open().is_open(triangle))
            return false; // it is traced without a ray
        if (kind == TexelTurn::Kind::any && !in_object_space)
            return true;
        return is_straight(poses.motion.turn(triangle))
            || (kind == TexelTurn::Kind::prepared && !in_object_space
                && poses.motion.body(triangle) != PoseMotion::kSoft);
    };
}

} // namespace

bool PoseSequence::bake_whole(OIIO::ImageBuf& dst, const MapJob& job, const std::string& name, VismapReport* report)
{
    Traced traced;
    const BakeTexels bake = [&](const VismapBaker& baker, const Progress& progress, BakedTexels& map) {
        return bake_base(baker, with_progress(job, progress), map, traced);
    };
    if (!make_map(dst, job, bake, report))
        return false;
    m_traced = std::move(traced);
    m_base = { job.scene, job.normal_map };
    m_base_name = name;
    m_map = dst;
    return true;
}

bool PoseSequence::bake_base(const VismapBaker& baker, const MapJob& job, BakedTexels& map, Traced& traced)
{
    traced = {};
    traced.samples = baker.params().samples;
    if (double(baker.width()) * baker.height() * traced.samples / kPacketSize <= kMostKnown)
        traced.rays = RayBits(baker.width(), baker.height(), traced.samples);
    BakeHints hints;
    hints.record = traced.rays.empty() ? nullptr : &traced.rays;
    const bool reconstructs = !map.contexts.texels.empty();
    hints.contexts = reconstructs ? &map.contexts : nullptr;
    if (baker.params().has("error"))
        traced.errors.assign(size_t(baker.width()) * size_t(baker.height()), 0);
    hints.errors = traced.errors.empty() ? nullptr : traced.errors.data();
    const bool done = baker.bake_all(map.pixels, map.coverage, map.counts, job.nthreads, job.progress, &hints);
    m_last.covered = map.counts.covered;
    // Kept texels are reconstructed again, from what this and their next neighbours were traced to be.
    traced.contexts = map.contexts;
    if (reconstructs)
        traced.texels.assign(map.pixels, map.pixels + size_t(baker.width()) * baker.height() * baker.channels());
    return done;
}

bool PoseSequence::bake(OIIO::ImageBuf& dst, const MapJob& job, const std::string& name, VismapReport* report)
{
    m_last = {};
    if (!m_base.scene)
        return bake_whole(dst, job, name, report);
    const Mesh &before = m_base.scene->mesh(), &after = job.scene->mesh();
    m_last.why = triangles_fault(before, after);
    if (m_last.why.empty())
        m_last.why = area_fault(before, after);
    if (m_last.why.empty() && !have_same_normals(m_base.normal_map, job.normal_map))
        m_last.why = "its normal map is another";
    std::optional<PoseMotion> motion;
    if (m_last.why.empty())
        m_last.why = motion.emplace(*m_base.scene, *job.scene).fault();
    // As many rays as the base has.
    MapJob next = job;
    next.params.samples = m_traced.samples;
    next.params.target_error = 0;
    next.time_budget = 0;
    if (!m_last.why.empty())
        return bake_whole(dst, next, name, report);

    Traced traced;
    const PosedMap pose { job.scene, job.normal_map };
    // A map does not know of less than a ray. A sun may be in few rays.
    const double error
        = m_error > 0 && next.params.sun_directions.empty() ? std::max(m_error, 1.0 / double(m_traced.samples)) : 0;
    const BakeTexels bake = [&](const VismapBaker& baker, const Progress& progress, BakedTexels& map) {
        const MovedBoxes moved(*motion);
        const std::vector<uint8_t> still = find_still(*motion, next.params);
        BakeHints hints;
        if (!m_traced.rays.empty() && !m_base.normal_map && !pose.normal_map) { // tangents are of neighbours too
            hints.known = &m_traced.rays;
            hints.moved = &moved;
            hints.still = &still;
        }
        const PosePair poses { m_base, pose, *motion, baker, &hints };
        PosePlan plan;
        if (!plan.decide(poses, error, may_keep(poses), job.nthreads, progress))
            return false;
        m_last.is_rigid = motion->is_whole();
        m_last.change = plan.change();
        m_last.kept = plan.kept();
        m_last.covered = plan.covered();
        map.counts.rays += plan.change().rays;
        if (double(plan.unknown()) > kMostUnknown * double(plan.tracing())) {
            m_last.why
                = plan.kept() == 0 && plan.change().probes == 0 ? "nothing of it can be kept" : "most of it changes";
            m_last.kept = 0;
            return bake_base(baker, with_progress(next, progress), map, traced);
        }
        const BaseTexels base { m_traced.texels.empty() ? static_cast<const float*>(m_map.localpixels())
                                                        : m_traced.texels.data(),
                                m_traced.contexts, m_traced.errors };
        return bake_changed(base, poses, plan, with_progress(job, progress), map);
    };
    if (!make_map(dst, next, bake, report))
        return false;
    OIIO::ImageSpec& spec = dst.specmod();
    if (!m_last.why.empty()) {
        m_traced = std::move(traced);
        m_base = pose;
        m_base_name = name;
        m_map = dst;
        return true;
    }
    m_last.base = m_base_name;
    if (m_last.kept == 0)
        return true;
    spec.attribute("vmlight:pose_base", m_base_name);
    spec.attribute("vmlight:pose_error", format("{:.6g}", error));
    return true;
}

} // namespace vmlight
