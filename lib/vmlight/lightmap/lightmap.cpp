// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/lightmap.h>

#include <vmlight/base/available_memory.h>
#include <vmlight/base/fail_with.h>
#include <vmlight/base/format.h>
#include <vmlight/base/parallel.h>
#include <vmlight/cfem/radiance.h>
#include <vmlight/image/channels.h>
#include <vmlight/lightmap/bounce_light.h>
#include <vmlight/lightmap/input.h>
#include <vmlight/lightmap/model.h>
#include <vmlight/lightmap/shader.h>

#include <algorithm>
#include <mutex>

namespace vmlight {
namespace {

using OIIO::ImageBuf;
using OIIO::ImageSpec;

// A turntable makes image after image of one size: memory that fits is reused, since fresh pages cost as much as the
// shading.
bool has_room(const ImageBuf& dst, const ImageSpec& spec)
{
    return dst.initialized() && dst.storage() == ImageBuf::LOCALBUFFER && dst.pixeltype() == OIIO::TypeFloat
        && dst.nchannels() == 3 && dst.roi() == OIIO::get_roi(spec) && dst.spec().depth == 1;
}

struct Scratch
{
    std::vector<float> vismap, albedo;
};

bool shade(ImageBuf& dst, const VismapReader& vismap, const LightmapShader& shader, int nthreads,
           const Progress& progress, std::string& error)
{
    // Blocks of whole rows, about 64 thousand floats: long enough to schedule, short enough for Ctrl-C and the cache.
    const OIIO::ROI all = dst.roi();
    const int rows = int(std::max<int64_t>(1, 65536 / (int64_t(all.width()) * vismap.channels())));
    std::vector<Scratch> scratch(worker_count(nthreads));
    float* pixels = static_cast<float*>(dst.localpixels());
    std::mutex mutex;
    ShadeFaults faults;
    const auto work = [&](int64_t item, int worker) {
        OIIO::ROI roi = all;
        roi.ybegin = all.ybegin + int(item) * rows;
        roi.yend = std::min(roi.ybegin + rows, all.yend);
        ShadeFaults found;
        if (const float* texels = vismap.read(roi, scratch[worker].vismap, found.error))
            shader.shade(roi, vismap.layout(), texels, pixels + 3 * size_t(item) * rows * all.width(),
                         scratch[worker].albedo, found);
        if (found.any()) {
            const std::lock_guard<std::mutex> lock(mutex);
            faults.merge(found);
        }
    };
    if (!parallel_items((all.height() + rows - 1) / rows, nthreads, work, progress))
        error = "interrupted";
    else if (faults.any())
        error = shader.fault_text(faults, vismap.name());
    return error.empty();
}

bool make(ImageBuf& dst, const ImageBuf& vismap, OIIO::cspan<ImageBuf> cfem, const SunLight* suns,
          const BounceLight* bounce, const LightmapParams& params, const ImageBuf* albedo, int nthreads,
          const Progress& progress, std::string& error)
{
    Rotation rotation;
    VismapReader reader;
    LightmapShader shader;
    ShadingModel model;
    if (suns)
        shader.use_suns({ std::shared_ptr<const SunLight>(), suns });
    if (bounce)
        shader.use_bounce({ std::shared_ptr<const BounceLight>(), bounce });
    if (!lightmap_rotation(rotation, params, error) || !reader.open(vismap, params, has_all_light(cfem), model, error))
        return false;
    if (const std::string fault = cfem.empty() ? "" : kernel_fault(model, vismap.spec(), cfem[0].spec());
        !fault.empty()) {
        error = named(cfem[0], fault);
        return false;
    }
    if (!shader.prepare(cfem, params, model, error))
        return false;
    if (albedo) {
        const auto opened = std::make_shared<AlbedoReader>();
        if (!opened->open(*albedo, vismap.roi(), nthreads, error))
            return false;
        shader.use_albedo(opened, params.skip_one_albedo);
    }

    ImageSpec spec = describe_lightmap(vismap.spec(), cfem[0].spec(), params, model.name);
    if (suns && !suns->suns.empty())
        spec.attribute("vmlight:model", with_suns(model.name));
    const bool is_light = std::any_of(cfem.begin(), cfem.end(), [&](const ImageBuf& level) { return &dst == &level; });
    const bool is_input = &dst == &vismap || is_light || &dst == albedo;
    ImageBuf apart;
    ImageBuf& target = is_input ? apart : dst;
    if (has_room(target, spec)) {
        target.specmod() = spec;
    } else if (error = memory_shortage(spec); !error.empty()) {
        return false;
    } else {
        target.reset(spec, OIIO::InitializePixels::No);
    }
    if (!target.localpixels()) {
        error = format("out of memory for a lightmap of {}x{} pixels", spec.width, spec.height);
        return false;
    }
    if (!shade(target, reader, shader, nthreads, progress, error))
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
    return make_lightmap(dst, vismap, OIIO::cspan<ImageBuf>(&cfem, 1), params, albedo, nthreads, progress);
}

bool make_lightmap(ImageBuf& dst, const ImageBuf& vismap, OIIO::cspan<ImageBuf> cfem, const LightmapParams& params,
                   const ImageBuf* albedo, int nthreads, const Progress& progress)
{
    return make_lightmap(dst, vismap, cfem, nullptr, nullptr, params, albedo, nthreads, progress);
}

bool make_lightmap(ImageBuf& dst, const ImageBuf& vismap, OIIO::cspan<ImageBuf> cfem, const SunLight* suns,
                   const LightmapParams& params, const ImageBuf* albedo, int nthreads, const Progress& progress)
{
    return make_lightmap(dst, vismap, cfem, suns, nullptr, params, albedo, nthreads, progress);
}

bool make_lightmap(ImageBuf& dst, const ImageBuf& vismap, OIIO::cspan<ImageBuf> cfem, const SunLight* suns,
                   const BounceLight* bounce, const LightmapParams& params, const ImageBuf* albedo, int nthreads,
                   const Progress& progress)
{
    std::string error;
    return make(dst, vismap, cfem, suns, bounce, params, albedo, nthreads, progress, error) || fail_with(dst, error);
}

} // namespace vmlight
