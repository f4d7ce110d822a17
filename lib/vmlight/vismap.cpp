// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap.h>

#include <vmlight/fail.h>
#include <vmlight/margin.h>
#include <vmlight/vismap_baker.h>

#include <OpenImageIO/strutil.h>
#include <OpenImageIO/timer.h>

namespace vmlight {
namespace {

OIIO::ImageSpec vismap_spec(const Mesh& mesh, const std::vector<Mesh>& occluders, const VismapParams& params)
{
    OIIO::ImageSpec spec = describe_vismap(mesh.name, params);
    spec.attribute("vmlight:meshHash", mesh_hash(mesh));
    std::string hashes;
    for (const Mesh& occluder : occluders)
        hashes += (hashes.empty() ? "" : ",") + mesh_hash(occluder);
    if (!hashes.empty())
        spec.attribute("vmlight:occluderHash", hashes);
    return spec;
}

} // namespace

bool make_vismap(OIIO::ImageBuf& dst, const Mesh& mesh, const std::vector<Mesh>& occluders, const VismapParams& params,
                 VismapReport* report, int nthreads, const Progress& progress)
{
    VismapReport counts;
    OIIO::Timer timer;
    std::string error;
    VismapBaker baker;
    if (!baker.prepare(mesh, occluders, params, nthreads, error))
        return fail(dst, error);
    const OIIO::ImageSpec spec = vismap_spec(mesh, occluders, params);
    dst.reset(spec, OIIO::InitializePixels::Yes);
    float* pixels = static_cast<float*>(dst.localpixels());
    if (!pixels)
        return fail(dst, OIIO::Strutil::fmt::format("no memory for {} x {} texels", spec.width, spec.height));
    counts.uv = baker.uv_report();
    counts.build_seconds = timer.lap();

    Coverage coverage(spec.width, spec.height);
    BakeCounts baked;
    if (!baker.bake_all(pixels, coverage, baked, nthreads, progress))
        return fail(dst, "interrupted");
    counts.bake_seconds = timer.lap();
    fill_margin(pixels, spec.nchannels, coverage, params.margin);
    counts.margin_seconds = timer.lap();

    counts.texels = int64_t(spec.width) * spec.height;
    counts.covered = baked.covered;
    counts.overlapping = baked.overlapping;
    counts.dark = baked.dark;
    counts.rays = baked.rays;
    if (report)
        *report = counts;
    return true;
}

} // namespace vmlight
