// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/vismap.h>

#include <vmlight/base/available_memory.h>
#include <vmlight/base/fail_with.h>
#include <vmlight/base/format.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/uv/margin.h>
#include <vmlight/vismap/bake_hints.h>
#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/make_map.h>
#include <vmlight/vismap/reconstruct_map.h>

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
    if (!scene.occluder_hashes().empty())
        spec.attribute("vmlight:occluderHash", scene.occluder_hashes());
    return spec;
}

// Of the progress of a bake that is reconstructed: about its share of the time at 64 rays.
constexpr double kBakeShare = 0.95;

// Goes from `first` to `last` of a whole.
Progress part_of(const Progress& whole, double first, double last)
{
    if (!whole)
        return {};
    return [&whole, first, last](double done) { return whole(first + (last - first) * done); };
}

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

bool make_map(OIIO::ImageBuf& dst, const MapJob& job, const BakeTexels& bake, VismapReport* report)
{
    const auto& [scene, params, nthreads, progress, time_budget, normal_map, at_step] = job;
    VismapReport counts;
    Stopwatch timer;
    std::string error;
    if (check_params(params, error))
        error = memory_shortage(describe_vismap("", params), reconstruct_bytes(params));
    VismapBaker baker;
    begin_step(at_step, "prove");
    if (!error.empty() || !baker.prepare(scene, params, error, nthreads, progress, time_budget, normal_map))
        return fail_with(dst, error);
    const OIIO::ImageSpec spec = vismap_spec(*scene, baker);
    dst.reset(spec, OIIO::InitializePixels::Yes);
    float* pixels = static_cast<float*>(dst.localpixels());
    if (!pixels)
        return fail_with(dst, format("out of memory for {}x{} texels", spec.width, spec.height));
    counts.uv = baker.uv_report();
    counts.normals_from = scene->mesh().normals_from;
    counts.warnings = scene->warnings();
    counts.tiny = scene->tiny_triangles();
    counts.rounding = scene->rounding();
    if (report)
        baker.count_islands(counts.uv);
    counts.build_seconds = timer.lap() - baker.error().pilot_seconds;

    BakedTexels map { pixels, Coverage(spec.width, spec.height), {}, {} };
    const bool reconstructs = is_reconstructed(baker.params());
    if (reconstructs)
        map.contexts = TexelContexts(0, 0, spec.width, spec.height);
    const double share = reconstructs ? kBakeShare : 1;
    if (!bake(baker, part_of(progress, 0, share), map))
        return fail_with(dst, "interrupted");
    counts.bake_seconds = timer.lap();
    BakeCounts& baked = map.counts;
    if (reconstructs) {
        if (!reconstruct_map(baker, pixels, map.contexts, baked.dark, nthreads, part_of(progress, share, 1)))
            return fail_with(dst, "interrupted");
        counts.reconstruct_seconds = timer.lap();
    }
    if (params.margin != 0)
        begin_step(at_step, "margin");
    fill_margin(pixels, spec.nchannels, map.coverage, params.margin, baker.margin_channels());
    counts.margin_seconds = timer.lap();

    counts.texels = int64_t(spec.width) * spec.height;
    counts.covered = baked.covered;
    counts.overlapping = baked.overlapping;
    counts.dark = baked.dark;
    counts.rays = baked.rays;
    counts.open = baked.open;
    counts.samples = baker.error().samples;
    counts.error = baker.error().rms;
    counts.error_texels = baker.error().texels;
    counts.expected_seconds = baker.error().bake_seconds;
    counts.pilot_seconds = baker.error().pilot_seconds;
    if (report)
        *report = counts;
    return true;
}

} // namespace vmlight
