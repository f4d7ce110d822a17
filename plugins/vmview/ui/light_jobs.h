// SPDX-License-Identifier: Apache-2.0
/// Light of whole textures from the processor, for a Job: what shaders do not look up.
#pragma once

#include "../scene/assets.h"
#include "../scene/job.h"

#include <vmlight/lightmap/lightmap.h>

#include <OpenImageIO/imagebuf.h>

namespace vmlight::view {

using ImageJob = Job<OIIO::ImageBuf>;

/// One result: the lightmap of `params`.
ImageJob::Work relight_work(MapPointer map, LightPointer light, const LightmapParams& params, int threads);

/// Results of 4, 16, ... 4096 pairs of rays a texel: the traced reference, in the size of the map. `light` has its
/// environment.
ImageJob::Work reference_work(MeshPointer mesh, MapPointer map, LightPointer light, const LightmapParams& params,
                              int threads);

} // namespace vmlight::view
