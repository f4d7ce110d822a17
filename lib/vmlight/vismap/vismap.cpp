// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/vismap.h>

#include <vmlight/base/available_memory.h>
#include <vmlight/base/fail_with.h>
#include <vmlight/base/format.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/uv/margin.h>
#include <vmlight/vismap/bake_hints.h>
#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/band_baker.h>
#include <vmlight/vismap/make_map.h>
#include <vmlight/vismap/reconstruct_map.h>

#include <OpenImageIO/strutil.h>

#include <utility>

namespace vmlight {
namespace {

OIIO::ImageSpec vismap_spec(const BakeScene& scene, const VismapBaker& baker)
{
    OIIO::ImageSpec spec = describe_vismap(scene.mesh().name, baker.params());
    spec.attribute("vmlight:samples", std::to_string(baker.params().samples));
    if (baker.error().texels > 0)
        spec.attribute("vmlight:error", float(baker.error().rms));
    spec.attribute("vmlight:meshHash", scene.mesh_hash());
    if (!scene.mesh_shape().empty())
        spec.attribute("vmlight:meshShape", scene.mesh_shape());
    if (!scene.occluder_hashes().empty())
        spec.attribute("vmlight:occluderHash", scene.occluder_hashes());
    if (!scene.occluder_names().empty())
        spec.attribute("vmlight:occluder", scene.occluder_names());
    return spec;
}

std::string shortage_of(const MapJob& job)
{
    const OIIO::ImageSpec spec = describe_vismap("", job.params);
    if (!job.in_bands)
        return map_memory_shortage(spec, job.params);
    VismapParams params = job.params;
    if (!MarginRows::is_narrow(params.margin))
        params.margin = 0; // of a part, whose margin is filled when it is joined
    const double bytes = BandBaker::held_bytes(params, spec.nchannels, job.nthreads);
    const int64_t available = available_memory();
    return bytes <= double(available)
        ? ""
        : format("rows of {} texels of {} channels need {} of memory, {} available", spec.width, spec.nchannels,
                 OIIO::Strutil::memformat(int64_t(bytes)), OIIO::Strutil::memformat(available));
}

// Of the progress of a bake that is reconstructed: about its share of the time at 64 rays.
constexpr double kBakeShare = 0.95;

} // namespace

bool make_vismap(OIIO::ImageBuf& dst, const Mesh& mesh, const std::vector<Mesh>& occluders, const VismapParams& params,
                 VismapReport* report, int nthreads, const Progress& progress)
{
    const Stopwatch timer;
    std::string error;
    auto scene = std::make_shared<BakeScene>();
    if (!check_params(params, error)
        || !scene->build(non_owning(mesh), occluders, nthreads, error, SceneChoice::within(params.max_distance)))
        return fail_with(dst, error);
    const double build_seconds = timer();
    const bool made = make_vismap(dst, scene, params, report, nthreads, progress);
    if (made && report)
        report->build_seconds += build_seconds;
    return made;
}

bool make_vismap(OIIO::ImageBuf& dst, const BakeScenePointer& scene, const VismapParams& params, VismapReport* report,
                 int nthreads, const Progress& progress, double time_budget, NormalMapPointer normal_map,
                 const StepListener& at_step)
{
    const BakeTexels all = [&](const VismapBaker& baker, const Progress& baking, BakedTexels& map) {
        BakeHints hints;
        hints.contexts = map.contexts.texels.empty() ? nullptr : &map.contexts;
        return baker.bake_all(map.pixels, map.coverage, map.counts, nthreads, baking, &hints);
    };
    return make_map(dst, { scene, params, nthreads, progress, time_budget, std::move(normal_map), at_step }, all,
                    report);
}

bool prepare_map(VismapBaker& baker, OIIO::ImageSpec& spec, VismapReport& report, const MapJob& job, bool islands,
                 std::string& error)
{
    const Stopwatch timer;
    const BakeScene& scene = *job.scene;
    if (check_params(job.params, error))
        error = shortage_of(job);
    begin_step(job.at_step, "prove");
    if (!error.empty()
        || !baker.prepare(job.scene, job.params, error, job.nthreads, job.progress, job.time_budget, job.normal_map))
        return false;
    spec = vismap_spec(scene, baker);
    report.uv = baker.uv_report();
    report.normals_from = scene.mesh().normals_from;
    report.warnings = scene.warnings();
    report.tiny = scene.tiny_triangles();
    report.rounding = scene.rounding();
    if (islands)
        baker.count_islands(report.uv);
    report.texels = int64_t(spec.width) * spec.height;
    report.samples = baker.error().samples;
    report.error = baker.error().rms;
    report.error_texels = baker.error().texels;
    report.expected_seconds = baker.error().bake_seconds;
    report.pilot_seconds = baker.error().pilot_seconds;
    report.build_seconds = timer() - report.pilot_seconds;
    return true;
}

void count_baked(VismapReport& report, const BakeCounts& baked)
{
    report.covered += baked.covered;
    report.overlapping += baked.overlapping;
    report.dark += baked.dark;
    report.rays += baked.rays;
    report.open += baked.open;
}

bool make_map(OIIO::ImageBuf& dst, const MapJob& job, const BakeTexels& bake, VismapReport* report)
{
    VismapReport counts;
    std::string error;
    VismapBaker baker;
    OIIO::ImageSpec spec;
    if (!prepare_map(baker, spec, counts, job, report != nullptr, error))
        return fail_with(dst, error);
    Stopwatch timer;
    dst.reset(spec, OIIO::InitializePixels::Yes);
    float* pixels = static_cast<float*>(dst.localpixels());
    if (!pixels)
        return fail_with(dst, format("out of memory for {}x{} texels", spec.width, spec.height));

    BakedTexels map { pixels, Coverage(spec.width, spec.height), {}, {} };
    const bool reconstructs = is_reconstructed(baker.params());
    if (reconstructs)
        map.contexts = TexelContexts(0, 0, spec.width, spec.height);
    const double share = reconstructs ? kBakeShare : 1;
    if (!bake(baker, part_of(job.progress, 0, share), map))
        return fail_with(dst, "interrupted");
    counts.bake_seconds = timer.lap();
    if (reconstructs) {
        if (!reconstruct_map(baker, pixels, map.contexts, map.counts.dark, job.nthreads,
                             part_of(job.progress, share, 1)))
            return fail_with(dst, "interrupted");
        counts.reconstruct_seconds = timer.lap();
    }
    if (job.params.margin != 0)
        begin_step(job.at_step, "margin");
    fill_margin(pixels, spec.nchannels, map.coverage, job.params.margin, baker.margin_channels());
    counts.margin_seconds = timer.lap();
    count_baked(counts, map.counts);
    if (report)
        *report = counts;
    return true;
}

bool stream_map(const MapRows& rows, const MapJob& job, VismapReport& report, std::string& error)
{
    VismapBaker baker;
    OIIO::ImageSpec spec;
    if (!prepare_map(baker, spec, report, job, true, error) || !rows.begin(spec, error))
        return false;
    BandBaker bands(baker, job.nthreads);
    const auto take = [&](int ybegin, int yend, const float* texels) { return rows.take(ybegin, yend, texels, error); };
    if (!bands.bake(take, job.progress)) {
        if (error.empty())
            error = "interrupted";
        return false;
    }
    report.bake_seconds = bands.seconds().bake;
    report.reconstruct_seconds = bands.seconds().reconstruct;
    report.margin_seconds = bands.seconds().margin;
    count_baked(report, bands.counts());
    return true;
}

} // namespace vmlight
