// SPDX-License-Identifier: Apache-2.0
#include "light_jobs.h"

#include <vmlight/base/oiio_compat.h>
#include <vmlight/reference/reference.h>

#include <utility>

namespace vmlight::view {
namespace {

// Pairs of rays of the reference, from step to step.
constexpr int kFirstPairs = 4, kMostPairs = 4096;

} // namespace

ImageJob::Work relight_work(MapPointer map, LightPointer light, const LightmapParams& params, int threads)
{
    return [=](const ImageJob::Post& post, const Progress& go_on) {
        JobResult<OIIO::ImageBuf> result;
        result.is_last = true;
        if (!make_lightmap(result.value, map->image, light->filtered(), params, nullptr, threads, go_on))
            result.error = oiio::error_line(result.value);
        post(std::move(result));
    };
}

ImageJob::Work reference_work(MeshPointer mesh, MapPointer map, LightPointer light, const LightmapParams& params,
                              int threads)
{
    return [=](const ImageJob::Post& post, const Progress& go_on) {
        VismapParams size = mesh->recipe.vismap_params;
        size.width = map->image.spec().width;
        size.height = map->image.spec().height;
        LightmapParams turned = params;
        turned.model = "auto";
        for (int pairs = kFirstPairs; pairs <= kMostPairs; pairs *= 4) {
            JobResult<OIIO::ImageBuf> result;
            ReferenceParams reference;
            reference.samples = pairs;
            result.is_last = pairs == kMostPairs;
            if (!make_reference(result.value, *mesh->scene, light->light.environment, size, turned, reference, threads,
                                go_on)) {
                result.error = oiio::error_line(result.value);
                result.is_last = true;
            }
            const bool is_last = result.is_last;
            post(std::move(result));
            if (is_last)
                return;
        }
    };
}

} // namespace vmlight::view
