// SPDX-License-Identifier: Apache-2.0
/// What a bake is going to take, from some of its texels.
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/vismap/baker.h>

#include <cstdint>
#include <vector>

namespace vmlight {

struct MapForecast
{
    int64_t covered = 0; ///< texels
    double seconds = 0; ///< of VismapBaker::bake_all() on this machine
};

/// Count the covered texels, and if `timed`, bake some of them twice at the number of rays of `baker`, which is
/// prepared with `scene`; open triangles are traced too unless `skip_open`. False if `progress` stopped it.
bool forecast_map(MapForecast& dst, const BakeScene& scene, const VismapBaker& baker, bool timed, bool skip_open,
                  int nthreads, const Progress& progress);

/// V of up to 4096 covered texels, evenly over the map, at `samples` rays: the same texels for every scene of a mesh.
/// False if `progress` stopped it.
bool sample_visibility(std::vector<double>& dst, const BakeScene& scene, const NormalMap* normal_map,
                       const VismapParams& params, int samples, int nthreads, const Progress& progress);

} // namespace vmlight
