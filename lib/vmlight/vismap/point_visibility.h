// SPDX-License-Identifier: Apache-2.0
/// The visibility of single points of surfaces, as a map would have it.
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/math/disc.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/trace/surface.h>
#include <vmlight/vismap/vismap.h>

#include <OpenImageIO/span.h>

#include <string>
#include <vector>

namespace vmlight {

/// Names of the channels that bake_points() makes: V, B, the normal, and those of the basis.
std::vector<std::string> point_channels(const VismapParams& params);

/// Bake `points`, whose ray origins need not be adjusted.
///
/// @param params   of a map of the scene; resolution and channels have no effect
/// @param dst      set to the floats of point_channels(), point by point. The same bits for any number of threads
/// @returns false if `progress` stopped the work
bool bake_points(std::vector<float>& dst, const BakeScene& scene, const VismapParams& params,
                 OIIO::cspan<SurfacePoint> points, int nthreads, const Progress& progress = {});

/// Trace `discs`, which are in object space, for `points`: T of DiscTracer::add(), one float for each disc, point by
/// point. False if `progress` stopped the work.
bool trace_points(std::vector<float>& dst, const BakeScene& scene, const VismapParams& params,
                  OIIO::cspan<SurfacePoint> points, OIIO::cspan<Disc> discs, int nthreads,
                  const Progress& progress = {});

} // namespace vmlight
