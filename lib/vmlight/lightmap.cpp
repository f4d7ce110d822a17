// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap.h>

#include <vmlight/cfem_lookup.h>
#include <vmlight/channels.h>
#include <vmlight/lightmap_input.h>
#include <vmlight/parallel.h>
#include <vmlight/shade_kernel.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>
#include <mutex>

namespace vmlight {
namespace {

using OIIO::ImageBuf;
using OIIO::ImageSpec;
using OIIO::Strutil::fmt::format;

// One kernel a model; check_params() has seen to it that the model is one of these.
ShadeTexels kernel_of(const std::string&)
{
    return shade_paper;
}

void copy_attribute(ImageSpec& dst, const ImageSpec& src, const char* name)
{
    if (const OIIO::ParamValue* value = src.find_attribute(name))
        dst.extra_attribs.push_back(*value);
}

ImageSpec lightmap_spec(const ImageSpec& vismap, const ImageSpec& cfem, const LightmapParams& params)
{
    ImageSpec spec(vismap.width, vismap.height, 3, OIIO::TypeFloat);
    OIIO::set_roi(spec, OIIO::get_roi(vismap));
    OIIO::set_roi_full(spec, OIIO::get_roi_full(vismap));
    spec.attribute("vmlight:stage", kLightmapStage);
    spec.attribute("vmlight:version", VMLIGHT_VERSION);
    append_params(spec, params);
    for (const char* name : { "vmlight:mesh", "vmlight:meshHash" })
        copy_attribute(spec, vismap, name);
    for (const char* name : { "colorInteropID", "chromaticities" })
        copy_attribute(spec, cfem, name);
    return spec;
}

// A turntable calls for image after image of one size: memory that is there and fits is used again, since fresh pages
// cost as much as the shading.
bool has_room(const ImageBuf& dst, const ImageSpec& spec)
{
    return dst.initialized() && dst.storage() == ImageBuf::LOCALBUFFER && dst.pixeltype() == OIIO::TypeFloat
        && dst.nchannels() == 3 && dst.roi() == OIIO::get_roi(spec) && dst.spec().depth == 1;
}

// What shading reads besides the visibility map, and what it found.
struct Job
{
    ShadeTexels kernel;
    ShadeSetup setup;
    const VismapReader& vismap;
    const AlbedoReader* albedo;
    std::mutex mutex {};
    Faults bad_vismap {}, bad_albedo {}, bad_result {};
    std::string error {};
};

struct Scratch
{
    std::vector<float> vismap, albedo;
};

void shade_rows(Job& job, OIIO::ROI roi, float* rgb, Scratch& scratch)
{
    Faults bad_vismap, bad_albedo, bad_result;
    std::string error;
    const size_t texels = size_t(roi.width()) * roi.height();
    const float* vismap = job.vismap.read(roi, scratch.vismap, error);
    bool sound = vismap && job.kernel(job.setup, job.vismap.order(), vismap, texels, rgb);
    if (vismap && !sound)
        job.vismap.find_faults(roi, vismap, bad_vismap);
    if (vismap && job.albedo) {
        job.albedo->multiply(roi, rgb, scratch.albedo, bad_albedo, error);
        sound = false;
    }
    // The kernel vouches for what it made, so that only doubtful blocks, and those an albedo scaled, are read again.
    if (!sound && error.empty() && !bad_vismap.any() && !bad_albedo.any())
        find_not_finite(roi, rgb, 3, bad_result);
    if (error.empty() && !bad_vismap.any() && !bad_albedo.any() && !bad_result.any())
        return;
    std::lock_guard<std::mutex> lock(job.mutex);
    job.bad_vismap.merge(bad_vismap);
    job.bad_albedo.merge(bad_albedo);
    job.bad_result.merge(bad_result);
    if (!error.empty())
        job.error = error;
}

bool shade(ImageBuf& dst, Job& job, int nthreads, const Progress& progress, std::string& error)
{
    // Blocks of whole rows: some 16 thousand texels are long against the hand-out, and short for Ctrl-C.
    const OIIO::ROI all = dst.roi();
    const int rows = std::max(1, 16384 / all.width());
    std::vector<Scratch> scratch(worker_count(nthreads));
    float* pixels = static_cast<float*>(dst.localpixels());
    const auto work = [&](int64_t item, int worker) {
        OIIO::ROI roi = all;
        roi.ybegin = all.ybegin + int(item) * rows;
        roi.yend = std::min(roi.ybegin + rows, all.yend);
        shade_rows(job, roi, pixels + 3 * size_t(item) * rows * all.width(), scratch[worker]);
    };
    if (!parallel_items((all.height() + rows - 1) / rows, nthreads, work, progress))
        error = "interrupted";
    else if (!job.error.empty())
        error = job.error;
    else if (job.bad_vismap.any())
        error = job.vismap.named(job.bad_vismap.text("visibility map", "not finite", kVismapChannels));
    else if (job.bad_albedo.any())
        error = job.albedo->fault_text(job.bad_albedo);
    else if (job.bad_result.any())
        error = job.bad_result.text("lightmap", "too large for float", std::array { "R", "G", "B" });
    return error.empty();
}

bool make(ImageBuf& dst, const ImageBuf& vismap, const ImageBuf& cfem, const LightmapParams& params,
          const ImageBuf* albedo, int nthreads, const Progress& progress, std::string& error)
{
    Rotation rotation;
    if (!lightmap_rotation(rotation, params, error))
        return false;
    VismapReader vismap_reader;
    CfemLookup lookup;
    AlbedoReader albedo_reader;

    if (!vismap_reader.open(vismap, error) || !check_input(cfem, "cosine-filtered environment", error))
        return false;
    if (!prepare_cfem(lookup, cfem, error)) {
        error = named(cfem, error);
        return false;
    }
    if (albedo && !albedo_reader.open(*albedo, vismap.roi(), nthreads, error))
        return false;

    const ImageSpec spec = lightmap_spec(vismap.spec(), cfem.spec(), params);
    const bool is_input = &dst == &vismap || &dst == &cfem || &dst == albedo;
    ImageBuf apart;
    ImageBuf& target = is_input ? apart : dst;
    if (has_room(target, spec))
        target.specmod() = spec;
    else
        target.reset(spec, OIIO::InitializePixels::No);
    if (!target.localpixels()) {
        error = format("no memory for a lightmap of {}x{} pixels", spec.width, spec.height);
        return false;
    }

    const ShadeSetup setup { &lookup, {}, float(std::exp2(params.exposure)) };
    Job job { kernel_of(params.model), setup, vismap_reader, albedo ? &albedo_reader : nullptr };
    for (int i = 0; i < 9; ++i)
        job.setup.rotation[i] = float(rotation[i / 3][i % 3]);
    if (!shade(target, job, nthreads, progress, error))
        return false;
    if (is_input)
        dst = std::move(apart);
    return true;
}

} // namespace

bool lightmap_rotation(Rotation& dst, const LightmapParams& params, std::string& error)
{
    if (!check_params(params, error))
        return false;
    if (!params.rotate.empty() + !params.matrix.empty() + !params.quaternion.empty() > 1) {
        error = "only one of rotate, matrix and quaternion may be given";
        return false;
    }
    Rotation object, environment;
    if (!params.rotate.empty())
        object = rotation_from_angles(params.rotate[0], params.rotate[1], params.rotate[2]);
    if (!params.matrix.empty() && !rotation_from_matrix(object, params.matrix, error))
        return false;
    if (!params.quaternion.empty() && !rotation_from_quaternion(object, params.quaternion, error))
        return false;
    if (!params.env_rotate.empty())
        environment = rotation_from_angles(params.env_rotate[0], params.env_rotate[1], params.env_rotate[2]);
    // The inverse of a rotation is its transpose, to the last bit.
    dst = environment.transposed() * object;
    return true;
}

bool make_lightmap(ImageBuf& dst, const ImageBuf& vismap, const ImageBuf& cfem, const LightmapParams& params,
                   const ImageBuf* albedo, int nthreads, const Progress& progress)
{
    std::string error;
    if (make(dst, vismap, cfem, params, albedo, nthreads, progress, error))
        return true;
    dst.clear();
    dst.errorfmt("{}", error);
    return false;
}

} // namespace vmlight
