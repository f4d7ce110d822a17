// SPDX-License-Identifier: Apache-2.0
/// How many rays a visibility map needs for the error, or the time, that was asked for; and what error that is.
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/uv/raster.h>
#include <vmlight/vismap/vismap.h>

#include <cstdint>
#include <string>

namespace vmlight {

/// Rays of a map, and what they come to.
struct SampleCount
{
    /// Rays a texel: those asked for, or those chosen.
    int samples = 0;
    /// As VismapReport::error.
    double rms = 0;
    /// Texels that were baked twice for it; 0 if it was not measured.
    int64_t texels = 0;
    /// What Visibility::error is multiplied with, so that its root mean square is `rms`.
    double lane_scale = 1;
    /// What the bake will take, if that was asked for; what this took.
    double bake_seconds = 0, pilot_seconds = 0;
};

/// Choose the samples of a map, or measure the error at those it has.
///
/// @param dst      samples alone, if neither an error, a time nor the channel `error` was asked for
/// @param time_budget seconds that the bake may take on all threads; 0 is no limit. If one ray a texel takes longer,
///                 one it is
/// @returns false, with the reason in `error`, if `params.target_error` is out of reach, `progress` stopped it, or
///          the channel `error` is asked for with 1 ray a texel
/// For a target, a count that measured at most as much, where one 4 % lower (if there is one) measured more. Where
/// 64 rays do not scatter, on 256 texels or more or on none, the least count is tried; on fewer 64 it is. A measured 0
/// of less than 64 rays counts as chance where 64 scatter. A function of scene and params, but for the samples that
/// `time_budget` chooses.
bool choose_samples(SampleCount& dst, const BakeScene& scene, const UvRaster& raster, const VismapParams& params,
                    double time_budget, int nthreads, const Progress& progress, std::string& error);

} // namespace vmlight
