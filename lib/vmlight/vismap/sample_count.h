// SPDX-License-Identifier: Apache-2.0
/// Rays per texel for a target error or a time budget, and the error that they give.
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/uv/raster.h>
#include <vmlight/vismap/normal_map.h>
#include <vmlight/vismap/open_triangles.h>
#include <vmlight/vismap/seam_links.h>
#include <vmlight/vismap/vismap.h>

#include <cstdint>
#include <string>

namespace vmlight {

/// Rays per texel of a map, and their error.
struct SampleCount
{
    /// Rays per texel, as asked for or as chosen.
    int samples = 0;
    /// As VismapReport::error.
    double rms = 0;
    /// Texels that were baked twice to measure it; 0 if it was not measured.
    int64_t texels = 0;
    /// Factor for Visibility::error that makes its root mean square that of the rays' error; measured for the channel
    /// `error` of a map that is not reconstructed.
    double scatter_scale = 1;
    /// Of a map that is reconstructed, as in the function of this name.
    double pattern_error = 0;
    /// Of a map that is reconstructed, the factor for the standard error that is expected of its texels that makes its
    /// root mean square `rms`.
    double error_scale = 1;
    /// Expected time of the bake, if it has a time budget; time of the measurement.
    double bake_seconds = 0, pilot_seconds = 0;
};

/// Choose the rays per texel of a map, or measure the error of those that `params` asks for.
///
/// @param dst      only `samples` is set if neither a target error, a time budget nor the channel `error` is asked for
/// @param normal_map nullptr if there is none
/// @param open     the triangles whose texels trace no ray
/// @param seams    of the map, if it is reconstructed
/// @param time_budget seconds for the bake on all threads, at least one ray per texel; 0 is unlimited
/// @returns false, with the reason in `error`, if `params.target_error` is out of reach, `progress` stopped it, or the
///          channel `error` is asked for with 1 ray per texel
/// For a target error: a count that measured at most that error, where a count 4 % lower (if there is one) measured
/// more. If 64 rays show no scatter on 256 or more texels (or there are no texels), the lowest count is tried; with
/// fewer texels the count is 64. A measured error of 0 with less than 64 rays is taken as chance if 64 rays show
/// scatter. A function of scene and params alone, except for a time budget.
bool choose_samples(SampleCount& dst, const BakeScene& scene, const NormalMap* normal_map, const UvRaster& raster,
                    const OpenTriangles& open, const SeamLinks& seams, const VismapParams& params, double time_budget,
                    int nthreads, const Progress& progress, std::string& error);

} // namespace vmlight
