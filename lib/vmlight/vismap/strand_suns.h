// SPDX-License-Identifier: Apache-2.0
/// How much of a disc of the sky, such as a sun, each texel of a map of strands sees, traced.
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/math/disc.h>
#include <vmlight/vismap/strand_map.h>

#include <OpenImageIO/span.h>

#include <cstdint>
#include <vector>

namespace vmlight {

/// Rays for each texel and disc: strands are full of edges, so that nothing is gained by looking for them.
constexpr int kStrandDiscRays = 32;

/// Trace `discs`, which are in object space, for the texels of a map.
///
/// @param dst      set to one float for each disc, texel by texel, T = (1/pi) mean over the disc of vis(w) sin(t, w):
///                 what SunLight adds up, since (1/pi^2) Int L sin dw is the irradiance / pi of the disc times T. 0
///                 where there is no strand. The same bits for any number of threads
/// @param scene    of these strands
/// @param params   `max_distance` and `seed` count
/// @param rays     set to the number of rays traced
/// @returns false if `progress` stopped the work
bool trace_strand_discs(std::vector<float>& dst, const Strands& strands, const StrandScene& scene,
                        const StrandLayout& layout, OIIO::cspan<Disc> discs, const VismapParams& params, int nthreads,
                        int64_t& rays, const Progress& progress = {});

} // namespace vmlight
